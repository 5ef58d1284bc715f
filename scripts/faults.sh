#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
#
# Makes calls to the system fail, kills and interrupts every command that writes files, and looks at
# what is left: see docs/reliability.md. Files go to /dev/shm, where no disk is worn.
#
#   scripts/faults.sh [--seconds N] [--seed S] [NAME ..]     600 s over all commands, or those named
#
# It ends with counts of what was tried, and with every promise that was broken: exit code 1.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
# shellcheck source=scripts/packages.sh
source scripts/packages.sh

if [[ "${1:-}" == -h || "${1:-}" == --help ]]; then
  sed -n '/^# Makes/,/^set /{/^#/s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"
  exit 0
fi
install_packages test
cmake --log-level=WARNING --preset dev >/dev/null
cmake --build --preset dev --target tofsmith fault_shim
if [[ -w /dev/shm ]]; then export TMPDIR=/dev/shm; fi
exec /usr/bin/python3 -B tests/apps/faults.py build-dev/apps/tofsmith build-dev/tests/libfault_shim.so "$@"

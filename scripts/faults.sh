#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
#
# Makes system calls of all commands that write files fail, kills and interrupts these commands, and
# checks the remaining files: see docs/reliability.md. Files are in /dev/shm, to protect the disk.
#
#   scripts/faults.sh [--seconds N] [--seed S] [NAME ...]   600 s for all commands or the named ones
#
# Prints the number of tests and all violations; exits with 1 if there are any.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
# shellcheck source=scripts/packages.sh
source scripts/packages.sh

if [[ "${1:-}" == -h || "${1:-}" == --help ]]; then
  print_help && exit
fi
install_packages test
cmake --log-level=WARNING --preset dev >/dev/null
cmake --build --preset dev --target tofsmith fault_shim
if [[ -w /dev/shm ]]; then export TMPDIR=/dev/shm; fi
exec /usr/bin/python3 -B tests/apps/faults.py build-dev/apps/tofsmith build-dev/tests/libfault_shim.so "$@"

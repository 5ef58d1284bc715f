#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
#
# Compares the decoder's bins with brute force in NumPy, on random codes and raw values. Progress is
# stored in build-dev/differential.json, and the next run continues from there.
#
#   scripts/differential.sh [--pixels N] [--seed S]     1e7 more pixels of seed 1, about a minute
#
# NumPy is six times faster if libopenblas0-serial is installed.
#
# Stops at a wrong bin, prints its code and pixel, and exits with 1.
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
cmake --build --preset dev --target tofsmith_python
PYTHONPATH=build-dev/python exec /usr/bin/python3 tests/python/decode_bins.py \
  --tally build-dev/differential.json "$@"

#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
#
# Installs a wheel into a fresh virtual environment without system site packages and uses it:
# scripts/wheel/smoke.py in Python, then the command. NumPy, and matplotlib where it is installed,
# are the system's. Needs nothing of this repository, so that it can run anywhere.
#
#   scripts/wheel/try.sh FILE.whl
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
wheel=$(realpath "${1:?needs a wheel}")
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cd "$place"

/usr/bin/python3 -m venv env
echo /usr/lib/python3/dist-packages >"$(echo env/lib/python3*/site-packages)/system.pth"
env/bin/pip install -q --no-index "$wheel"
env/bin/python3 "$here/smoke.py"

PATH="$place/env/bin:$PATH"
tofsmith --version
tofsmith simulate table-top --code hamiltonian-k4 --signal 1e5 --width 64 --height 48 --seed 1 -o captured.npz
tofsmith decode captured.npz --code hamiltonian-k4 -o decoded.exr
tofsmith design paper-10f0 --effort 0 -o designed >design.log
[[ -s decoded.exr && -s designed/report.html ]]
tofsmith lab -o lab.html 2>lab.log || grep -q 'built without the lab page' lab.log
env/bin/pip uninstall -q -y tofsmith
! compgen -G 'env/lib/python3*/site-packages/tofsmith*' || { echo "pip uninstall left files" >&2 && exit 1; }
echo "Installed, used and uninstalled $(basename "$wheel")"

#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
#
# Installs missing packages (Debian's emscripten), compiles core and design to WebAssembly and packs
# them with the page into one self-contained file, which `tofsmith lab` then copies. The build is
# reproducible.
#
#   scripts/lab.sh [-o lab.html]     also copy build-lab/lab.html there
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/packages.sh
source "$root/scripts/packages.sh"

output=''
while (($#)); do
  case "$1" in
    -h | --help)
      print_help && exit
      ;;
    -o | --output) output=$(realpath -m "${2:?-o needs a file}") && shift ;;
    *) tofsmith_die "unknown option $1; see --help" ;;
  esac
  shift
done

install_packages lab
use_debian_tools
cd "$root"

echo "Compiling the engine in $root/build-lab"
cmake --log-level=WARNING --preset lab
cmake --build --preset lab

page="$root/build-lab/lab.html"
licences=() # of everything compiled in: headers, and emscripten's C and C++ libraries
for package in emscripten libeigen3-dev libhwy-dev libfmt-dev librandom123-dev libtomlplusplus-dev nlohmann-json3-dev; do
  licences+=(--licence "/usr/share/doc/$package/copyright")
done
viewer/pack.py --page apps/lab/page/index.html --worker build-lab/lab/engine.js --worker apps/lab/engine/worker.js \
  --wasm build-lab/lab/engine.wasm "${licences[@]}" -o "$page"
bytes=$(stat -c %s "$page")
((bytes <= 8000000)) || tofsmith_die "$page has $bytes bytes; expected at most 8000000"
[[ -z "$output" ]] || cp "$page" "$output"
printf 'Done. The lab is %s (%s bytes): open it in a browser\n' "${output:-$page}" "$bytes"

#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
#
# Installs missing packages, builds tofsmith, makes the documentation and checks its links. Warnings
# are errors. The last line is the path of the first page.
#
#   scripts/docs.sh [--build DIR] [--with-lab]
#
#   --build DIR   use tofsmith and its Python package from this build instead of build-docs
#   --with-lab    also compile the lab page (scripts/lab.sh) and add it to the site
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/packages.sh
source "$root/scripts/packages.sh"

output="$root/build-docs"
build=
lab=''
while (($#)); do
  case "$1" in
    -h | --help)
      print_help && exit
      ;;
    --with-lab) lab="$root/build-lab/lab.html" && shift ;;
    --build) build=$(realpath "${2:?a directory}") && shift 2 ;;
    *) tofsmith_die "unknown option '$1'; see --help" ;;
  esac
done

install_packages docs
use_debian_tools
cd "$root"

if [[ -z "$build" ]]; then
  build=$output
  echo "Building tofsmith in $build"
  cmake --log-level=WARNING -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DTOFSMITH_BUILD_APPS=ON -DTOFSMITH_BUILD_PYTHON=ON -DTOFSMITH_BUILD_TESTS=OFF \
    -DTOFSMITH_UNITY=ON
  cmake --build "$build" --target tofsmith_cli tofsmith_python
fi
[[ -x "$build/apps/tofsmith" ]] || tofsmith_die "there is no $build/apps/tofsmith"
[[ -d "$build/python/tofsmith" ]] || tofsmith_die "there is no $build/python/tofsmith"

[[ -z "$lab" ]] || scripts/lab.sh

echo "Making the documentation in $output/html"
rm -rf "$output/html" docs/generated
mkdir -p "$output/html/cpp"
TOFSMITH_CPP_PAGES="$output/html/cpp" doxygen docs/Doxyfile
PYTHONDONTWRITEBYTECODE=1 PYTHONPATH="$build/python" python3 -m sphinx -b html -n -W --keep-going \
  -E -q -d "$output/doctrees" -D tofsmith_tool="$build/apps/tofsmith" -D tofsmith_lab="$lab" \
  docs "$output/html"
python3 -B scripts/check_links.py "$output/html"

echo "Done. The first page is $output/html/index.html"

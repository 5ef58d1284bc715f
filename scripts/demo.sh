#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
#
# Installs missing packages, builds `tofsmith demo` and runs it, which designs codes for a camera,
# captures and decodes a scene, and writes a report.
#
#   scripts/demo.sh [-o DIR] [--camera FILE] [--depth FILE --image FILE] [OPTIONS of tofsmith demo]
#
# Results are written to ./tofsmith-demo, or to the directory of -o.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build="$root/build-demo"
# shellcheck source=scripts/packages.sh
source "$root/scripts/packages.sh"

if [[ " $* " == *" -h "* || " $* " == *" --help "* ]]; then
  print_help && exit
fi

install_packages demo
use_debian_tools

echo "Building tofsmith in $build"
# The command line with `tofsmith demo` alone, and what it links.
cmake --log-level=WARNING -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DTOFSMITH_COMPONENTS=report -DTOFSMITH_BUILD_APPS=ON -DTOFSMITH_BUILD_TESTS=OFF -DTOFSMITH_UNITY=ON \
  -DTOFSMITH_OPTIMIZE_KERNELS_ONLY=ON -DTOFSMITH_TARGETS="$(own_target)"
cmake --build "$build" --target tofsmith_demo

"$build/apps/demo/tofsmith" demo "$@"
cat <<'END'
This build contains the demo only. To install the command line, Python package and library:
    scripts/package.sh && apt install ./build-package/*.deb
END

#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
#
# Installs what is missing, builds tofsmith as shared libraries and makes Debian packages of it:
# libtofsmith-core0.1 and libtofsmith-core-dev, so for design, io, lab, report and sweep;
# libtofsmith-dev for all of them, tofsmith and python3-tofsmith. The same commit makes the same bytes,
# in whatever directory it is built.
#
#   scripts/package.sh [DIR]      build there instead of in build-package
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/packages.sh
source "$root/scripts/packages.sh"

case "${1:-}" in
  -h | --help)
    sed -n '/^# Installs/,/^set /{/^#/s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"
    exit 0
    ;;
  -*) tofsmith_die "unknown option $1; see --help" ;;
esac
build=$(realpath -m "${1:-$root/build-package}")

install_packages package
use_debian_tools

echo "Building tofsmith in $build"
# From nothing but the sources: settings of an earlier build there do not count.
rm -f "$build/CMakeCache.txt"
cmake --log-level=WARNING -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_INSTALL_PREFIX=/usr -DCMAKE_SKIP_INSTALL_RPATH=ON -DBUILD_SHARED_LIBS=ON \
  -DTOFSMITH_BUILD_APPS=ON -DTOFSMITH_BUILD_PYTHON=REQUIRED -DTOFSMITH_BUILD_TESTS=OFF \
  -DTOFSMITH_UNITY=ON -DTOFSMITH_COMPONENTS=
cmake --build "$build"

rm -f "$build"/*.deb
(cd "$build" && cpack --config CPackConfig.cmake)
mapfile -t packages < <(compgen -G "$build/*.deb")
((${#packages[@]})) || tofsmith_die "cpack made no packages in $build"
printf 'Done. The packages, with their SHA-256 sums, are\n'
sha256sum "${packages[@]}"
printf 'Install them with\napt install %s/*.deb\n' "$build"

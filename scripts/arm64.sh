#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
#
# Builds the component core for 64-bit Arm with Debian's cross compiler and runs its tests of the
# decoder's bins with qemu-user: the NEON kernels must find the same bins as on x86. Libraries for Arm
# are unpacked into the build folder; the system is not changed.
#
#   scripts/arm64.sh [--floors NAME,NAME,...] [DIR]    build in DIR instead of build-arm64
#
#   --floors NAMES   all tests of these folders of core: core, code, camera, scene, decode, simulate;
#                    at least fifteen times slower than on x86
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/packages.sh
source "$root/scripts/packages.sh"

floors='' directory=''
while (($#)); do
  case "$1" in
    -h | --help)
      print_help && exit
      ;;
    --floors) floors=${2:?--floors needs names} && shift ;;
    -*) tofsmith_die "unknown option $1; see --help" ;;
    *) directory=$1 ;;
  esac
  shift
done
filter='DecoderOfRandomCodes.*:BinMatcher.*:ArcSearch.*:TileProjection.*'
[[ -z "$floors" ]] || filter='*'
IFS=, read -r -a names <<<"${floors:-decode}"
for name in "${names[@]}"; do
  [[ " core code camera scene decode simulate " == *" $name "* ]] ||
    tofsmith_die "--floors: core has no folder '$name'; there are core, code, camera, scene, decode and simulate"
done
build=$(realpath -m "${directory:-$root/build-arm64}")
libraries=$build/root
release=$(this_or_newest_release)

install_packages arm64
use_debian_tools

if [[ ! -e $libraries/complete ]]; then
  echo "Fetching libraries for arm64 into $libraries"
  rm -rf "$build/apt" "$libraries"
  mkdir -p "$libraries"
  private_apt "$build/apt" arm64 "$release" update
  mapfile -t packages < <(packages_of arm64_libraries)
  private_apt "$build/apt" arm64 "$release" install --download-only --no-install-recommends "${packages[@]}"
  for package in "$build"/apt/archives/*.deb; do dpkg-deb -x "$package" "$libraries"; done
  touch "$libraries/complete"
fi

cmake --log-level=WARNING -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_TOOLCHAIN_FILE="$root/cmake/arm64.toolchain.cmake" -DTOFSMITH_ARM64_ROOT="$libraries" \
  -DTOFSMITH_COMPONENTS=core -DTOFSMITH_BUILD_APPS=OFF -DTOFSMITH_BUILD_PYTHON=OFF \
  -DTOFSMITH_BUILD_TESTS=ON -DTOFSMITH_UNITY=ON -DTOFSMITH_WERROR=ON
cmake --build "$build" --target tofsmith_core "${names[@]/#/test_}"
for name in "${names[@]}"; do
  echo "== $name"
  qemu-aarch64-static -L "$libraries" "$build/tests/test_$name" --gtest_filter="$filter"
done

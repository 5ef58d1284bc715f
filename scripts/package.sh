#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
#
# Installs missing packages, builds tofsmith as shared libraries and makes Debian packages:
# libtofsmith-core0.1 and libtofsmith-core-dev, the same for gpu, design, io, lab, report and sweep;
# libtofsmith-dev for all of them, tofsmith and python3-tofsmith. The build is reproducible in any
# directory (scripts/reproduce_build.sh). All binaries must be hardened (scripts/check_elf.py).
#
#   scripts/package.sh [--component NAME | --arch arm64] [--without-lab] [DIR]
#                                                     build in DIR instead of build-package
#
#   --component NAME   only this one and its dependencies, without command line and Python
#   --arch arm64       core for 64-bit Arm, with Debian's cross compiler and libraries; adds arm64 to the
#                      architectures of dpkg if necessary
#   --without-lab      omit the page of `tofsmith lab`, which needs emscripten
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/packages.sh
source "$root/scripts/packages.sh"

component='' directory='' lab=yes arch=''
while (($#)); do
  case "$1" in
    -h | --help)
      print_help && exit
      ;;
    --component) component=${2:?--component needs a name} && shift ;;
    --arch)
      arch=${2:?--arch needs a name} && shift
      [[ "$arch" == arm64 ]] || tofsmith_die "--arch: found '$arch'; expected arm64, or no option for this computer's own"
      ;;
    --without-lab) lab='' ;;
    -*) tofsmith_die "unknown option $1; see --help" ;;
    *) directory=$1 ;;
  esac
  shift
done
build=$(realpath -m "${directory:-$root/build-package}")
if [[ -n "$arch" ]]; then
  [[ "${component:-core}" == core ]] || tofsmith_die "--arch $arch: found --component $component; only core has been built for it"
  component=core
fi
programs=(-DTOFSMITH_BUILD_APPS=ON -DTOFSMITH_BUILD_PYTHON=REQUIRED)
if [[ -n "$component" ]]; then
  programs=(-DTOFSMITH_BUILD_APPS=OFF -DTOFSMITH_BUILD_PYTHON=OFF)
elif [[ -n "$lab" ]]; then
  programs+=(-DTOFSMITH_LAB_PAGE="$build/lab.html")
fi

[[ -z "$arch" ]] || programs+=(-DCMAKE_TOOLCHAIN_FILE="$root/cmake/$arch.toolchain.cmake" -DCMAKE_INSTALL_LIBDIR=lib/aarch64-linux-gnu)
install_packages "package${arch:+_$arch}"
use_debian_tools

mkdir -p "$build"
[[ -n "$component" || -z "$lab" ]] || "$root/scripts/lab.sh" -o "$build/lab.html"
echo "Building tofsmith in $build"
# Discard the settings of an earlier build.
rm -f "$build/CMakeCache.txt"
cmake --log-level=WARNING -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_INSTALL_PREFIX=/usr -DCMAKE_SKIP_INSTALL_RPATH=ON -DBUILD_SHARED_LIBS=ON \
  "${programs[@]}" -DTOFSMITH_BUILD_TESTS=OFF -DTOFSMITH_UNITY=ON -DTOFSMITH_COMPONENTS="$component"
cmake --build "$build"

rm -f "$build"/*.deb
# Packages contain the permissions of their files.
(umask 022 && cd "$build" && cpack --config CPackConfig.cmake)
mapfile -t packages < <(compgen -G "$build/*.deb")
((${#packages[@]})) || tofsmith_die "cpack made no packages in $build"
unpacked=$(mktemp -d)
trap 'rm -rf "$unpacked"' EXIT
for package in "${packages[@]}"; do dpkg-deb -x "$package" "$unpacked"; done
mapfile -t elf_files < <(find "$unpacked" -type f \( -name '*.so' -o -name '*.so.*' -o -path '*/usr/bin/*' \) | sort)
"$root/scripts/check_elf.py" "${elf_files[@]}" || tofsmith_die "what is packed is not hardened"
printf 'Done. The packages, with their SHA-256 sums, are\n'
sha256sum "${packages[@]}"
printf 'Install them with\napt install %s/*.deb\n' "$build"

#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
#
# Configures, builds, tests and consumes core, and core with design, with only the required packages
# installed: in a new Debian root made by debootstrap, which requires root permissions.
#
#   scripts/test_components.sh [--here] [COMPONENT ...]   (core design)
#
# With --here, or without debootstrap or root permissions, it builds on this system, where CMake is
# prevented from finding other packages, and skips the unit tests, which other checks run.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/packages.sh
source "$root/scripts/packages.sh"

case "${1:-}" in
  -h | --help)
    print_help && exit
    ;;
esac
here=
if [[ "${1:-}" == --here ]]; then here=yes && shift; fi
components=("$@")
((${#components[@]})) || components=(core design)
mirror=${TOFSMITH_DEBIAN_MIRROR:-http://deb.debian.org/debian}
release=$(this_or_newest_release)

# Builds, tests and installs a component and uses it in a separate project. $1: sources, $2: build
# folder, $3: component, $4: label of the tests to run, or all.
# shellcheck disable=SC2016  # $1 belongs to the inner shell
steps='set -euo pipefail
cmake --log-level=WARNING -S "$1" -B "$2" -G Ninja -DCMAKE_BUILD_TYPE=Release -DTOFSMITH_UNITY=ON \
  -DTOFSMITH_COMPONENTS="$3" -DTOFSMITH_BUILD_APPS=OFF -DTOFSMITH_BUILD_PYTHON=OFF \
  -DTOFSMITH_BUILD_TESTS=ON "${@:5}"
start=$SECONDS
cmake --build "$2" --target "tofsmith_$3"
echo "$3 alone was built in $((SECONDS - start)) s"
if [[ "$4" == all ]]; then cmake --build "$2"; fi
ctest --test-dir "$2" --output-on-failure --no-tests=error --parallel "$(nproc)" -L "${4/#all/.}"'

# Packages that a component must not use.
forbidden=(tomlplusplus OpenEXR PNG embree OpenCL SQLite3 CLI11 pybind11)

for component in "${components[@]}"; do
  mapfile -t packages < <(packages_of "$component")
  packages+=(libgtest-dev libgmock-dev nlohmann-json3-dev) # for the tests
  if [[ -z "$here" ]] && ((EUID == 0)) && command -v debootstrap >/dev/null; then
    place=$(mktemp -d)
    trap 'umount "$place/proc" 2>/dev/null || true; rm -rf --one-file-system "$place"' EXIT
    echo "Making a Debian root for $component in $place"
    debootstrap --variant=minbase "$release" "$place" "$mirror" >/dev/null
    mount --bind /proc "$place/proc"
    chroot "$place" env DEBIAN_FRONTEND=noninteractive \
      apt-get -q -y install --no-install-recommends "${packages[@]}" >/dev/null
    mkdir "$place/tofsmith"
    tar -C "$root" --exclude='./build*' --exclude=./.git -cf - . | tar -C "$place/tofsmith" -xf -
    chroot "$place" bash -c "$steps" steps /tofsmith /build "$component" all
    umount "$place/proc"
    rm -rf --one-file-system "$place"
    trap - EXIT
  else
    install_packages "$component"
    use_debian_tools
    # Without optimization, because the unit tests are not run.
    settings=(-DTOFSMITH_TARGETS="$(own_target)" -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0)
    for package in "${forbidden[@]}"; do settings+=("-DCMAKE_DISABLE_FIND_PACKAGE_$package=ON"); done
    # One build folder for all components, so that a component reuses the objects of its dependencies.
    bash -c "$steps" steps "$root" "$root/build-components" "$component" install "${settings[@]}"
  fi
done

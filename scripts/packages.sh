#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
#
# The Debian packages of the project, in one place. Sourced by the other scripts; run by hand it
# installs what is missing of the groups named:
#
#   scripts/packages.sh core|gpu|design|demo|build|python|lab|package|test|docs|benchmark|check|fuzz|arm64 ..
#                                                     install what is missing
#   scripts/packages.sh --list GROUP                  print the names, one a line

# The component core alone: codes, cameras, decoding and simulation.
packages_core=(
  g++ cmake ninja-build pkgconf
  libeigen3-dev       # linear algebra, FFT
  libtbb-dev          # threads; can be left out
  libhwy-dev          # SIMD
  libfmt-dev
  librandom123-dev    # random streams
)
packages_opencl=(ocl-icd-opencl-dev opencl-c-headers)  # its loader; can be left out
# core and gpu.
packages_gpu=("${packages_core[@]}" "${packages_opencl[@]}")
# core and design: nothing more.
packages_design=("${packages_core[@]}")
# The component report and `tofsmith demo`.
packages_demo=(
  "${packages_core[@]}"
  libtomlplusplus-dev nlohmann-json3-dev libcli11-dev
  libzip-dev libhdf5-dev libopenexr-dev libpng-dev
  libyaml-cpp-dev     # calibrations of lenses
  libembree-dev       # ray casting
  python3-plotly      # its plotly.js goes into the reports
  esbuild             # minifies it
  zlib1g-dev          # packs it and the pictures
)
# All components and the command line.
packages_build=(
  "${packages_demo[@]}" "${packages_opencl[@]}"
  libsqlite3-dev      # sweep store
  libboost-dev        # Asio: generators in the network
)
# The Python package, on top of the library.
packages_python=(
  "${packages_build[@]}"
  pybind11-dev python3-dev python3-numpy
  python3-matplotlib                          # tofsmith.plot
  python3-setuptools python3-wheel python3-pip python3-venv  # pip install
)
# The lab's page: core and design for browsers.
packages_lab=(
  cmake ninja-build python3
  emscripten          # core and design for browsers
  libeigen3-dev libhwy-dev libfmt-dev librandom123-dev libtomlplusplus-dev nlohmann-json3-dev
)
# Debian packages of all of it, with every optional feature.
packages_package=(
  "${packages_python[@]}"
  libopenmpi-dev             # sweeps of several ranks
  liblxi-dev libtirpc-dev    # generators by VXI-11
  dpkg-dev file              # what a package depends on
)
packages_test=(
  "${packages_python[@]}"
  libgtest-dev libgmock-dev
  libopenmpi-dev openmpi-bin                 # sweeps of several ranks
  pocl-opencl-icd                            # OpenCL on the processor
  python3-pytest mypy                        # the Python package
  python3-h5py                               # writes what .h5 readers must read
  python3-opencv                             # distorts as lenses must
  python3-cvxopt                             # an independent solver of the sub-problem
  chromium chromium-driver python3-selenium  # the report, in a browser
)
# The documentation.
packages_docs=(
  "${packages_python[@]}"
  python3-sphinx python3-myst-parser python3-numpydoc python3-sphinx-rtd-theme
  libjs-katex  # formulas
  doxygen      # the C++ reference
)
packages_benchmark=(
  "${packages_build[@]}"
  libnanoflann-dev  # a peer of the decoder
  python3-opencv    # filters of depth beside ours
)
# Format and lint, on top of the tests: what .ci/run needs.
packages_check=(
  "${packages_test[@]}"
  clang-format clang-tidy shellcheck
)

# scripts/fuzz.sh.
packages_fuzz=(
  "${packages_build[@]}"
  clang libclang-rt-14-dev
)

# scripts/arm64.sh: what compiles and runs for Arm here; and, from Debian for arm64, what core and its
# tests use.
packages_arm64=(
  crossbuild-essential-arm64 qemu-user-static cmake ninja-build dpkg-dev
)
# scripts/package.sh --arch arm64.
packages_package_arm64=(
  crossbuild-essential-arm64 cmake ninja-build pkgconf dpkg-dev file python3 libeigen3-dev
  librandom123-dev libtbb-dev:arm64 libhwy-dev:arm64 libfmt-dev:arm64
)
packages_arm64_libraries=(
  libc6-dev libstdc++-12-dev libeigen3-dev libtbb-dev libhwy-dev libfmt-dev librandom123-dev
  libgtest-dev libgmock-dev nlohmann-json3-dev
)

tofsmith_die() {
  printf '%s: %s\n' "$(basename "$0")" "$*" >&2
  exit 1
}

# The packages of one group, one a line.
packages_of() {
  case "$1" in
    core) printf '%s\n' "${packages_core[@]}" ;;
    gpu) printf '%s\n' "${packages_gpu[@]}" ;;
    design) printf '%s\n' "${packages_design[@]}" ;;
    demo) printf '%s\n' "${packages_demo[@]}" ;;
    build) printf '%s\n' "${packages_build[@]}" ;;
    python) printf '%s\n' "${packages_python[@]}" ;;
    lab) printf '%s\n' "${packages_lab[@]}" ;;
    package) printf '%s\n' "${packages_package[@]}" ;;
    test) printf '%s\n' "${packages_test[@]}" ;;
    docs) printf '%s\n' "${packages_docs[@]}" ;;
    benchmark) printf '%s\n' "${packages_benchmark[@]}" ;;
    check) printf '%s\n' "${packages_check[@]}" ;;
    fuzz) printf '%s\n' "${packages_fuzz[@]}" ;;
    arm64) printf '%s\n' "${packages_arm64[@]}" ;;
    package_arm64) printf '%s\n' "${packages_package_arm64[@]}" ;;
    arm64_libraries) printf '%s\n' "${packages_arm64_libraries[@]}" ;;
    *) tofsmith_die "no package group '$1'; there are core, gpu, design, demo, build, python, lab, package, test, docs, benchmark, check, fuzz and arm64" ;;
  esac
}

# Those of the packages named on standard input that are not installed.
missing_packages() {
  local package
  while read -r package; do
    [[ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" == installed* ]] ||
      printf '%s\n' "$package"
  done
}

# Installs what is missing of a group. Asks nothing, and does not touch apt when nothing is missing.
install_packages() {
  local group=$1 list
  list=$(packages_of "$group")
  command -v dpkg-query >/dev/null ||
    tofsmith_die "installs packages on Debian only; elsewhere, install the counterparts of:
$(paste -sd' ' <<<"$list")"

  local -a missing
  mapfile -t missing < <(missing_packages <<<"$list")
  ((${#missing[@]})) || return 0

  local -a as_root=(env DEBIAN_FRONTEND=noninteractive)
  if ((EUID != 0)); then
    command -v sudo >/dev/null ||
      tofsmith_die "must install packages but is neither root nor finds sudo. As root, run:
apt-get install --no-install-recommends ${missing[*]}"
    sudo true </dev/null || tofsmith_die "must install packages and sudo does not let it: ${missing[*]}"
    as_root=(sudo "${as_root[@]}")
  fi
  # A machine just started may be updating itself: wait for its lock.
  local -a apt=("${as_root[@]}" apt-get -q -y -o DPkg::Lock::Timeout=600)

  # Packages of another architecture are found once dpkg knows of it.
  [[ " ${missing[*]}" != *:arm64* ]] || "${as_root[@]}" dpkg --add-architecture arm64
  printf 'Installing %d Debian packages: %s\n' "${#missing[@]}" "${missing[*]}"
  # One broken third-party source fails the update but need not hide our packages.
  "${apt[@]}" update </dev/null ||
    printf 'apt-get update failed; trying with the package lists as they are\n' >&2
  "${apt[@]}" install --no-install-recommends "${missing[@]}" </dev/null ||
    tofsmith_die "apt-get could not install: ${missing[*]}
See its messages above; tofsmith is built on Debian 12 (bookworm)."
}

# A python3, a cmake or libraries of another origin (pyenv, conda) may come first on PATH, and CMake
# searches beside what it finds there. What we installed is what we use.
use_debian_tools() {
  export PATH="/usr/bin:/bin:$PATH"
}

if [[ "${BASH_SOURCE[0]}" == "$0" ]]; then
  set -euo pipefail
  (($#)) || tofsmith_die "which group? core, gpu, design, demo, build, python, lab, package, test, docs, benchmark or check"
  if [[ "$1" == --list ]]; then
    packages_of "${2:?which group? core, gpu, design, demo, build, python, lab, package, test, docs, benchmark or check}"
  else
    for group in "$@"; do
      install_packages "$group"
    done
  fi
fi

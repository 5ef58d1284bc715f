#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
#
# The Debian packages of the project. Sourced by the other scripts; when run directly, it installs
# the missing packages of the named groups:
#
#   scripts/packages.sh GROUP ...       install missing packages
#   scripts/packages.sh --list GROUP    print the names, one per line
#
# A group is an array packages_GROUP below.
# shellcheck disable=SC2034  # groups are looked up by name

# Debian releases on which tofsmith is tested, newest last.
tofsmith_releases='bookworm trixie'
# Packages whose names differ between them. The lists below use the names of the first column.
packages_by_release='
name           bookworm           trixie
libclang-rt    libclang-rt-14-dev libclang-rt-19-dev
libstdc++      libstdc++-12-dev   libstdc++-14-dev
'

# Only the component core: codes, cameras, decoding and simulation.
packages_core=(
  g++ cmake ninja-build pkgconf
  libeigen3-dev       # linear algebra, FFT
  libtbb-dev          # threads; optional
  libhwy-dev          # SIMD
  libfmt-dev
  librandom123-dev    # random streams
)
packages_opencl=(ocl-icd-opencl-dev opencl-c-headers)  # OpenCL loader; optional
# core and gpu.
packages_gpu=("${packages_core[@]}" "${packages_opencl[@]}")
# core and design; no further packages.
packages_design=("${packages_core[@]}")
# The component report and `tofsmith demo`.
packages_demo=(
  "${packages_core[@]}"
  libtomlplusplus-dev nlohmann-json3-dev libcli11-dev
  libzip-dev libhdf5-dev libopenexr-dev libpng-dev
  libyaml-cpp-dev     # lens calibrations
  libembree-dev       # ray casting
  python3             # packs the report viewer
  zlib1g-dev          # decompresses TIFF images, compresses images in reports
)
# All components and the command line.
packages_build=(
  "${packages_demo[@]}" "${packages_opencl[@]}"
  libsqlite3-dev      # sweep store
  libmd-dev           # SHA-256 of exported files
)
# The Python package, on top of the library.
packages_python=(
  "${packages_build[@]}"
  pybind11-dev python3-dev python3-numpy
  python3-matplotlib                          # tofsmith.plot
  python3-setuptools python3-wheel python3-pip python3-venv  # pip install
)
# The lab page: core and design for browsers.
packages_lab=(
  cmake ninja-build python3
  emscripten          # core and design for browsers
  libeigen3-dev libhwy-dev libfmt-dev librandom123-dev libtomlplusplus-dev nlohmann-json3-dev
)
# Debian packages of all components, with every optional feature.
packages_package=(
  "${packages_python[@]}"
  dpkg-dev file              # dependencies of packages
)
# scripts/wheel.sh: a wheel without OpenCL.
packages_wheel=(
  "${packages_python[@]}"
  patchelf
)
packages_test=(
  "${packages_python[@]}"
  libgtest-dev libgmock-dev
  pocl-opencl-icd                            # OpenCL on the processor
  python3-pytest mypy                        # the Python package
  python3-pyvisa python3-pyvisa-py           # uploads to generators
  patchelf                                   # wheels
  python3-h5py                               # writes test input for .h5 readers
  python3-opencv                             # reference for lens distortion
  chromium chromium-driver python3-selenium  # the report, in a browser
  locales                                    # with a decimal comma
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
  python3-opencv    # depth filters for comparison
)
# Requirements of .ci/run: the tests, format and lint.
packages_check=(
  "${packages_test[@]}"
  clang-format clang-tidy shellcheck
)

# scripts/test_executors.sh.
packages_executors=(
  python3-distributed python3-mpi4py openmpi-bin
  slurmctld slurmd slurm-client munge
)
# scripts/fuzz.sh.
packages_fuzz=(
  "${packages_build[@]}"
  clang libclang-rt
)

# scripts/arm64.sh: cross compiler and emulator; and, from Debian for arm64, the dependencies of core
# and its tests.
packages_arm64=(
  crossbuild-essential-arm64 qemu-user-static cmake ninja-build dpkg-dev
)
# scripts/package.sh --arch arm64.
packages_package_arm64=(
  crossbuild-essential-arm64 cmake ninja-build pkgconf dpkg-dev file python3 libeigen3-dev
  librandom123-dev libtbb-dev:arm64 libhwy-dev:arm64 libfmt-dev:arm64
)
packages_arm64_libraries=(
  libc6-dev libstdc++ libeigen3-dev libtbb-dev libhwy-dev libfmt-dev librandom123-dev
  libgtest-dev libgmock-dev nlohmann-json3-dev
)

tofsmith_die() {
  printf '%s: %s\n' "$(basename "$0")" "$*" >&2
  exit 1
}

# Prints the comment at the beginning of the script that was started.
print_help() { sed -n '5,/^[^#]/{/^#/s/^# \{0,1\}//p}' "${root:?}/scripts/${0##*/}"; }

# Prints the path of the Debian root of a release for scripts/test_release.sh.
release_root() { printf '%s' "${TOFSMITH_ROOTS:-${XDG_CACHE_HOME:-$HOME/.cache}/tofsmith-roots}/$1"; }

# Prints the code name of this system if tofsmith is tested on it, otherwise nothing.
debian_release() (
  # shellcheck source=/dev/null
  source /etc/os-release 2>/dev/null || return 0
  [[ "${ID:-}" == debian && " $tofsmith_releases " == *" ${VERSION_CODENAME:-} "* ]] || return 0
  printf '%s' "$VERSION_CODENAME"
)

# Translates package names on standard input to the names in a release.
named_in_release() {
  awk -v release="$1" -v table="$packages_by_release" '
    BEGIN { rows = split(table, row, "\n")
            for (r = 1; r <= rows; ++r) {
              columns = split(row[r], cell, " ")
              if (cell[1] == "name") for (c = 1; c <= columns; ++c) if (cell[c] == release) wanted = c
              if (columns) name[cell[1]] = cell[wanted] } }
    { print ($1 in name) ? name[$1] : $1 }'
}

# Prints the widest vector instructions of this machine, a value of TOFSMITH_TARGETS.
own_target() {
  local flags target=SSE4
  flags=" $(grep -m 1 '^flags' /proc/cpuinfo || true) "
  if [[ "$flags" == *" avx512bw "* && "$flags" == *" avx512vl "* ]]; then
    target=AVX3
  elif [[ "$flags" == *" avx2 "* && "$flags" == *" fma "* ]]; then
    target=AVX2
  elif [[ "$(uname -m)" == aarch64 ]]; then
    target=NEON
  fi
  printf '%s' "$target"
}

# Prints the Debian release of this machine, or else the newest release with tests.
this_or_newest_release() {
  local release
  release=$(debian_release)
  printf '%s' "${release:-${tofsmith_releases##* }}"
}

# Prints the packages of a group by their names in that release, one per line.
packages_of() { list_group "$1" | named_in_release "$(this_or_newest_release)"; }
list_group() {
  [[ " $(package_groups) " == *" $1 "* ]] ||
    tofsmith_die "found package group '$1'; expected one of: $(package_groups)"
  local -n group="packages_$1"
  printf '%s\n' "${group[@]}"
}
# Prints the names of all package groups.
package_groups() {
  compgen -A variable packages_ | sed 's/^packages_//; /^by_release$/d' | paste -sd' '
}

# Reads package names from standard input and prints those that are not installed.
missing_packages() {
  local package
  while read -r package; do
    [[ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" == installed* ]] ||
      printf '%s\n' "$package"
  done
}

# Installs the missing packages of a group without questions. Runs apt only if any are missing.
install_packages() {
  local group=$1 list
  list=$(packages_of "$group")
  if [[ -z "$(debian_release)" ]]; then
    echo "tofsmith is tested on Debian ($tofsmith_releases), not on this system. Required packages, by their Debian names:
$(paste -sd' ' <<<"$list")" >&2
    if ! command -v dpkg-query >/dev/null; then
      echo "Without dpkg, they cannot be checked here. Continuing: CMake reports what is missing." >&2
      return 0
    fi
  fi

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
  # A new machine may be running automatic updates: wait for their lock.
  local -a apt=("${as_root[@]}" apt-get -q -y -o DPkg::Lock::Timeout=600)

  # apt finds packages of another architecture only after it is added to dpkg.
  [[ " ${missing[*]}" != *:arm64* ]] || "${as_root[@]}" dpkg --add-architecture arm64
  printf 'Installing %d Debian packages: %s\n' "${#missing[@]}" "${missing[*]}"
  # A broken third-party source makes the update fail, but our packages may still be found.
  "${apt[@]}" update </dev/null ||
    printf 'apt-get update failed; trying with the package lists as they are\n' >&2
  "${apt[@]}" install --no-install-recommends "${missing[@]}" </dev/null ||
    tofsmith_die "apt-get could not install: ${missing[*]}
See its messages above; tofsmith is tested on Debian ($tofsmith_releases)."
}

# Runs apt-get with separate lists, cache and package status in a folder, to download packages of
# another architecture or release without changing the system.
private_apt() { # FOLDER ARCHITECTURE RELEASE ARGUMENTS ...
  local folder=$1 architecture=$2 release=$3
  shift 3
  mkdir -p "$folder"/{lists,archives}/partial
  [[ -e $folder/status ]] || : >"$folder/status"
  echo "deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] ${TOFSMITH_DEBIAN_MIRROR:-http://deb.debian.org/debian} $release main" \
    >"$folder/sources.list"
  apt-get -q -y -o APT::Architecture="$architecture" -o APT::Architectures="$architecture" \
    -o Dir::Etc::sourcelist="$folder/sources.list" -o Dir::Etc::sourceparts=/dev/null \
    -o Dir::State="$folder" -o Dir::State::status="$folder/status" -o Dir::Cache="$folder" \
    -o Debug::NoLocking=1 -o APT::Sandbox::User=root "$@" </dev/null
}

# Puts Debian's programs first on PATH. Otherwise a python3 or cmake of pyenv or conda may be used,
# and CMake also searches for libraries near the programs on PATH.
use_debian_tools() {
  export PATH="/usr/bin:/bin:$PATH"
}

if [[ "${BASH_SOURCE[0]}" == "$0" ]]; then
  set -euo pipefail
  (($#)) || tofsmith_die "no package group is given; expected some of: $(package_groups)"
  if [[ "$1" == --list ]]; then
    packages_of "${2:-}"
  else
    for group in "$@"; do
      install_packages "$group"
    done
  fi
fi

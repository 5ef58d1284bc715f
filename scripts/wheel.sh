#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
#
# Installs missing packages, then builds and checks wheels of the Python package and the command line
# that need only the GNU C library and NumPy: all other shared libraries are inside. Builds one wheel
# per Debian release from this one on, for its Python version. The same commit makes the same bytes.
#
#   scripts/wheel.sh [--python VERSION] [DIR]     build in DIR instead of build-wheel
#
#   --python VERSION   only the wheel for this Python, such as 3.13
#
# Wheels do not contain OpenCL, whose libraries belong to the system that they run on. The page of
# `tofsmith lab` is included if scripts/lab.sh has built it.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/packages.sh
source "$root/scripts/packages.sh"

# Debian releases and the versions of their Python.
releases=(bookworm:3.11 trixie:3.13)

wanted='' directory=''
while (($#)); do
  case "$1" in
    -h | --help)
      print_help && exit
      ;;
    --python) wanted=${2:?--python needs a version} && shift ;;
    -*) tofsmith_die "unknown option $1; see --help" ;;
    *) directory=$1 ;;
  esac
  shift
done
build=$(realpath -m "${directory:-$root/build-wheel}")
versions=("${releases[@]#*:}")
[[ -z "$wanted" || " ${versions[*]} " == *" $wanted "* ]] ||
  tofsmith_die "--python: found '$wanted'; expected one of ${versions[*]}"

install_packages wheel
command -v dpkg-query >/dev/null || tofsmith_die "needs Debian's dpkg, which finds the licences of bundled libraries"
use_debian_tools
own=$(python3 -c 'import sys; print("%d.%d" % sys.version_info[:2])')
SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git -C "$root" log -1 --format=%ct)}
export SOURCE_DATE_EPOCH

# Unpacks the headers of a release's Python and of its pybind11 into a folder.
fetch_headers() { # RELEASE VERSION FOLDER
  local release=$1 version=$2 folder=$3
  [[ ! -e $folder/complete ]] || return 0
  echo "Fetching the headers of Python $version from Debian $release"
  rm -rf "$folder"
  mkdir -p "$folder"
  private_apt "$folder.apt" "$(dpkg --print-architecture)" "$release" update
  (cd "$folder" && private_apt "$folder.apt" "$(dpkg --print-architecture)" "$release" \
    download "libpython$version-dev" pybind11-dev)
  for package in "$folder"/*.deb; do dpkg-deb -x "$package" "$folder"; done
  touch "$folder/complete"
}

mkdir -p "$build"
rm -f "$build"/*.whl
for entry in "${releases[@]}"; do
  version=${entry#*:}
  [[ -z "$wanted" || "$wanted" == "$version" ]] || continue
  dpkg --compare-versions "$version" ge "$own" || continue
  echo "Building the wheel for Python $version in $build"
  options=(-DTOFSMITH_WERROR=ON -DBUILD_SHARED_LIBS=ON -DTOFSMITH_USE_OPENCL=OFF)
  bundle=()
  if [[ "$version" != "$own" ]]; then
    headers=$build/python$version
    fetch_headers "${entry%:*}" "$version" "$headers"
    options+=("-DTOFSMITH_PYTHON_ROOT=$headers")
    bundle=(--python-root "$headers")
  fi
  # Discard settings and files of an earlier build.
  rm -rf "$build"/{CMakeCache.txt,python/tofsmith,setuptools,plain}
  (cd "$root" && TOFSMITH_CMAKE_BUILD="$build" TOFSMITH_CMAKE_OPTIONS="${options[*]@Q}" \
    python3 -B setup.py -q egg_info --egg-base "$build" build --build-base "$build/setuptools" \
    bdist_wheel --dist-dir "$build/plain" >"$build/build.log" 2>&1) ||
    tofsmith_die "the build failed; see $build/build.log"
  python3 -B "$root/scripts/wheel/bundle.py" --build "$build" "${bundle[@]}" -o "$build" "$build"/plain/*.whl
done
mapfile -t wheels < <(compgen -G "$build/*.whl")
((${#wheels[@]})) || tofsmith_die "this system's Python $own is newer than $wanted; build that wheel on the release that has it"
python3 -B "$root/scripts/wheel/check.py" --source "$root" --build "$build" "${wheels[@]}"

for wheel in "${wheels[@]}"; do
  if [[ "$wheel" == *-cp"${own/./}"-* ]]; then
    "$root/scripts/wheel/try.sh" "$wheel"
  else
    echo "Not tried, because this system has Python $own: $(basename "$wheel")"
  fi
done
printf 'Done. The wheels, with their SHA-256 sums, are\n'
sha256sum "${wheels[@]}"

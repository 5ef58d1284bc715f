#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
#
# Builds the Debian packages of the last commit twice, with different folders, dates of the sources,
# times, time zones, locales, homes, permissions of new files, numbers of jobs and, as root, users. No
# compiler cache is used. Both builds must give identical packages.
#
#   scripts/reproduce_build.sh [--component NAME] [--keep DIR] [--quick]    about 20 minutes on two cores
#
#   --component NAME   as for scripts/package.sh; core takes 6 minutes
#   --keep DIR         keep both builds in DIR
#   --quick            the first build may use ccache
#
# Prints the packages and files that differ, if any, and then exits with 1.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/packages.sh
source "$root/scripts/packages.sh"

place='' quick='' what=()
while (($#)); do
  case "$1" in
    -h | --help)
      print_help && exit
      ;;
    --keep) place=$(realpath -m "${2:?--keep needs a directory}") && mkdir -p "$place" && shift ;;
    --quick) quick=yes ;;
    --component) what=(--component "${2:?--component needs a name}") && shift ;;
    *) tofsmith_die "unknown option $1; see --help" ;;
  esac
  shift
done
if [[ -z "$place" ]]; then
  place=$(mktemp -d)
  trap 'rm -rf "$place"' EXIT
fi
install_packages package
chmod 755 "$place"

# The first build is like in a clone, where ccache has entries; the second is outside the sources.
first=$place/one second=$place/another/folder/of/a-longer-name
rm -rf "$first" "$second"
mkdir -p "$first" "$second/source" "$second/home"
for folder in "$first" "$second/source"; do git -C "$root" archive HEAD | tar -xf - -C "$folder"; done
find "$second/source" -exec touch --date=2001-02-03 {} +

echo "First build, in $first"
uncached=(CCACHE_DISABLE=1)
[[ -z "$quick" ]] || uncached=()
env "${uncached[@]}" LC_ALL=C.UTF-8 TZ=UTC CMAKE_BUILD_PARALLEL_LEVEL="$(nproc)" \
  "$first/scripts/package.sh" "${what[@]}" >"$first/build.log" 2>&1 ||
  tofsmith_die "the first build failed; see $first/build.log"

echo "Second build, in $second"
other=()
if ((EUID == 0)); then
  chown -R nobody "$place/another"
  other=(setpriv --reuid=nobody --regid=nogroup --clear-groups)
fi
# shellcheck disable=SC2016  # $1 belongs to the inner shell
"${other[@]}" env CCACHE_DISABLE=1 HOME="$second/home" LC_ALL=POSIX LANGUAGE=de TZ=Asia/Kathmandu \
  CMAKE_BUILD_PARALLEL_LEVEL=1 bash -c 'umask 027; cd /; "$1/source/scripts/package.sh" "${@:2}" "$1/build"' \
  build "$second" "${what[@]}" >"$second/log" 2>&1 || tofsmith_die "the second build failed; see $second/log"

failed=0 count=0
for package in "$first"/build-package/*.deb; do
  twin=$second/build/$(basename "$package")
  count=$((count + 1))
  cmp -s "$package" "$twin" && continue
  failed=1
  echo "differs: $(basename "$package")"
  [[ -e "$twin" ]] || continue
  for side in "$package" "$twin"; do
    rm -rf "$side.unpacked"
    dpkg-deb -R "$side" "$side.unpacked"
  done
  diff -rq "$package.unpacked" "$twin.unpacked" || true
  # Compare names, owners, permissions and dates in the archives.
  diff <(dpkg-deb -c "$package") <(dpkg-deb -c "$twin") || true
done
((failed == 0)) || tofsmith_die "the two builds differ"
echo "$count packages, the same bytes in both builds"

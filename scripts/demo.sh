#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
#
# Installs what is missing, builds tofsmith, runs its main job and says where the report is.
#
#   scripts/demo.sh [-o DIR] [--depth FILE --image FILE] [options of `tofsmith demo`]
#
# The output goes to ./demo-output unless -o names another directory.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build="$root/build-demo"
# shellcheck source=scripts/packages.sh
source "$root/scripts/packages.sh"

# Where `tofsmith demo` will write, as its own options say it.
output_directory() {
  local output=
  while (($#)); do
    case "$1" in
      -o | --output) output=${2:-} ;;
      --output=*) output=${1#*=} ;;
      -o?*) output=${1#-o} ;;
    esac
    shift
  done
  printf '%s' "$output"
}

if [[ " $* " == *" -h "* || " $* " == *" --help "* ]]; then
  sed -n '/^# Installs/,/^# The output/s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"
  exit 0
fi
output=$(output_directory "$@")
if [[ -z "$output" ]]; then
  output="$PWD/demo-output"
  set -- -o "$output" "$@"
fi

install_packages demo
use_debian_tools

echo "Building tofsmith in $build"
# The command line with `tofsmith demo` alone, and what it links.
cmake --log-level=WARNING -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DTOFSMITH_COMPONENTS=report -DTOFSMITH_BUILD_APPS=ON -DTOFSMITH_BUILD_TESTS=OFF -DTOFSMITH_UNITY=ON \
  -DTOFSMITH_OPTIMIZE_KERNELS_ONLY=ON -DTOFSMITH_TARGETS="$(own_target)"
cmake --build "$build" --target tofsmith_demo

tofsmith="$build/apps/demo/tofsmith"
[[ -x "$tofsmith" ]] || tofsmith_die "the build made no $tofsmith"
"$tofsmith" demo "$@"

report="$(realpath -m "$output")/report.html"
[[ -s "$report" ]] || tofsmith_die "the demo finished but left no report at $report"
echo "Done. The report is $report"

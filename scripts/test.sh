#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
#
# Installs missing packages, builds tofsmith and runs its tests. The last line is
# `N passed, N failed, N skipped`; the exit code is 0 if at least one test ran and none failed.
#
#   scripts/test.sh [--preset NAME] [--floors core,io,..] [--locale NAME] [options of ctest]
#
#   --preset NAME   a preset of CMakePresets.json: dev (default), asan, tsan
#   --floors LIST   build and run only the unit tests of these folders
#   --locale NAME   run all tests in the locale de_DE.UTF-8, set in tests and in Python as by a host
#                   program
#
# With the presets asan and tsan, the environment variable GTEST_FILTER selects tests.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/packages.sh
source "$root/scripts/packages.sh"

preset=dev
floors=()
locale=
while (($#)); do
  case "$1" in
    -h | --help)
      print_help && exit
      ;;
    --preset) preset=${2:?a preset} && shift 2 ;;
    --locale) locale=${2:?a locale} && shift 2 ;;
    --floors) IFS=, read -ra floors <<<"${2:?a list of folders}" && shift 2 ;;
    *) break ;;
  esac
done

install_packages test
use_debian_tools
cd "$root" # location of the presets
build="$root/build-$preset"
results="$build/test-results.xml"

targets=(all)
components=
if ((${#floors[@]})); then
  targets=()
  # The components that these tests need; empty: all.
  components='sweep;lab'
  [[ ! " ${floors[*]} " =~ \ (gpu|report|house)\  ]] || components=
  [[ ! "${floors[*]}" =~ ^((core|code|camera|scene|decode|simulate)\ ?)+$ ]] || components=core
  for floor in "${floors[@]}"; do
    compgen -G "tests/$floor/*.cpp" >/dev/null || tofsmith_die "there are no tests in tests/$floor"
    targets+=("test_$floor")
  done
  set -- -L "^($(IFS='|' && echo "${floors[*]}"))\$" "$@"
fi
echo "Building tofsmith and its tests in $build"
settings=(-DTOFSMITH_COMPONENTS="$components")
# All targets would take too long.
[[ "$preset" == dev ]] || settings+=(-DTOFSMITH_TARGETS="$(own_target)")
[[ -z "$components" ]] || settings+=(-DTOFSMITH_BUILD_APPS=OFF -DTOFSMITH_BUILD_PYTHON=OFF)
cmake --log-level=WARNING --preset "$preset" "${settings[@]}"
cmake --build "$build" --target "${targets[@]}"

in_locale=()
if [[ -n "$locale" ]]; then
  [[ -e "$build/locale/$locale/LC_NUMERIC" ]] ||
    tofsmith_die "found no locale $locale in $build/locale; expected de_DE.UTF-8, from the package" \
      "locales"
  cmake --build "$build" --target locale_shim
  in_locale=(env LOCPATH="$build/locale" TOFSMITH_TEST_LOCALE_OF_HOSTS="$locale"
    LD_PRELOAD="$build/tests/liblocale_shim.so")
fi

# A program whose tests are all excluded passes, so that a misspelled filter would pass. The target
# `all` builds every test_*.
if [[ -n "${GTEST_FILTER:-}" && "$preset" != dev ]]; then
  matches=
  for target in "${targets[@]/#all/test_*}"; do
    for program in "$build/tests/"$target; do
      [[ -f "$program" && -x "$program" ]] || continue
      ! grep -q '^  ' <<<"$("$program" --gtest_list_tests)" || matches=yes
    done
  done
  [[ -n "$matches" ]] ||
    tofsmith_die "GTEST_FILTER: found '$GTEST_FILTER', which matches no test; expected a filter" \
      "such as 'Decoder.*'"
fi

# One test per line, including tests that could not run.
failures="$build/Testing/Temporary/LastTestsFailed.log"
rm -f "$results" "$failures"
status=0
# One more than there are cores: some tests wait for a browser or an instrument.
"${in_locale[@]}" ctest --preset "$preset" --parallel "$(($(nproc) + 1))" --output-on-failure \
  --output-junit "$results" "$@" </dev/null || status=$?

[[ -s "$results" ]] || tofsmith_die "ctest wrote no results"
total=$(grep -c '<testcase ' "$results" || true)
passed=$(grep -c '<testcase .* status="run"' "$results" || true)
failed=0
[[ ! -f "$failures" ]] || failed=$(grep -c . "$failures" || true)
skipped=$((total - passed - failed))
((passed + failed)) || tofsmith_die "no test ran"
echo "$passed passed, $failed failed, $skipped skipped"
((status == 0 && failed == 0))

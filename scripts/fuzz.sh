#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
#
# Runs libFuzzer (clang, with address and undefined-behaviour sanitizers) on the readers of files.
# Seeds are made by the library; what is found new stays in build-fuzz/corpus and is where the next
# run goes on.
#
#   scripts/fuzz.sh [--seconds N] [READER ..]     10 s of each reader, unless named
#   scripts/fuzz.sh --list                        their names
#
# It ends with a table of executions and coverage. An input that crashes, hangs (10 s) or takes more
# than 1 GB is kept in build-fuzz/found: exit code 1.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
# shellcheck source=scripts/packages.sh
source scripts/packages.sh

seconds=10
readers=()
while (($#)); do
  case "$1" in
    -h | --help)
      sed -n '/^# Runs/,/^set /{/^#/s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"
      exit 0
      ;;
    --seconds) seconds=${2:?--seconds needs a number} && shift ;;
    --list) readers=(list) ;;
    *) readers+=("$1") ;;
  esac
  shift
done
install_packages fuzz

cmake --log-level=WARNING --preset fuzz >/dev/null
cmake --build --preset fuzz
fuzzer=build-fuzz/tests/fuzz/readers
if [[ "${readers[*]:-}" == list ]]; then exec "$fuzzer" --reader=list; fi
if ((${#readers[@]} == 0)); then mapfile -t readers < <("$fuzzer" --reader=list); fi

export ASAN_OPTIONS=allocator_may_return_null=1:detect_leaks=0
mkdir -p build-fuzz/found
failed=0
table=$(printf '%-12s %12s %10s %9s' reader executions per-second coverage)
for reader in "${readers[@]}"; do
  corpus=build-fuzz/corpus/$reader log=build-fuzz/$reader.log
  mkdir -p "$corpus"
  "$fuzzer" "--reader=$reader" "--seeds=$corpus"
  if ! "$fuzzer" "--reader=$reader" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=1500 \
    -malloc_limit_mb=1000 -max_len=65536 -use_value_profile=1 -print_final_stats=1 \
    -dict=tests/fuzz/words.dict -artifact_prefix="build-fuzz/found/$reader-" "$corpus" \
    >"$log" 2>&1; then
    failed=1
    echo "$reader: an input fails; see $log and build-fuzz/found" >&2
  fi
  executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  rate=$(sed -n 's/^stat::average_exec_per_sec: *//p' "$log")
  coverage=$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$log" | tail -1)
  table+=$(printf '\n%-12s %12s %10s %9s' "$reader" "${executions:-?}" "${rate:-?}" "${coverage:-?}")
done
echo "$table"
exit "$failed"

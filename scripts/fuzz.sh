#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
#
# Runs libFuzzer (clang, with address and undefined-behaviour sanitizers) on the readers of files.
# The library makes the seeds. New inputs are stored in build-fuzz/corpus, where the next run
# continues, and the number of executions in build-fuzz/tally.
#
#   scripts/fuzz.sh [--seconds N] [READER ...]    10 s for each reader, or the named ones
#   scripts/fuzz.sh --total 1e8                   in rounds, until all runs together have this
#                                                 number of executions; can be stopped and restarted
#   scripts/fuzz.sh --list                        print the names of the readers
#   scripts/fuzz.sh --tally                       print the totals of all runs
#
# Prints a table of this run, or of all. Inputs that crash, hang (10 s) or need more than 1 GB are
# stored in build-fuzz/found; the exit code is then 1.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
# shellcheck source=scripts/packages.sh
source scripts/packages.sh

tally=build-fuzz/tally # one line per run of a reader: name, executions, seconds, coverage

# Sums the lines of standard input by reader, in the order of first occurrence.
table() {
  awk '{ if (!($1 in runs)) names[++count] = $1; ++runs[$1]; done[$1] += $2; took[$1] += $3; all += $2; time += $3
         if ($4 > coverage[$1]) coverage[$1] = $4 }
       END { printf "%-17s %12s %10s %9s\n", "reader", "executions", "per-second", "coverage"
             for (i = 1; i <= count; ++i) { n = names[i]
               printf "%-17s %12d %10d %9d\n", n, done[n], done[n] / (took[n] > 0 ? took[n] : 1), coverage[n] }
             printf "%-17s %12d %10d\n", "all", all, all / (time > 0 ? time : 1) }'
}

executions_so_far() { awk '{ all += $2 } END { printf "%d\n", all }' "$tally"; }

seconds=10 total=0
readers=()
while (($#)); do
  case "$1" in
    -h | --help)
      print_help && exit
      ;;
    --seconds) seconds=${2:?--seconds needs a number} && shift ;;
    --total) total=$(printf '%.0f' "${2:?--total needs a number}") && shift ;;
    --tally)
      [[ -s "$tally" ]] || tofsmith_die "nothing was run yet; see --help"
      table <"$tally"
      exit
      ;;
    --list) readers=(list) ;;
    -*) tofsmith_die "unknown option $1; see --help" ;;
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

# Files for readers are in memory, not on a disk. Backtraces of allocations would cost a third of the
# time; run a failing input again by hand to get one.
scratch=$(mktemp -d "$([[ -w /dev/shm ]] && echo /dev/shm || echo /tmp)/tofsmith-fuzz-XXXXXX")
trap 'rm -rf "$scratch"' EXIT
export TMPDIR=$scratch
export ASAN_OPTIONS=allocator_may_return_null=1:detect_leaks=0:malloc_context_size=0:quarantine_size_mb=32
mkdir -p build-fuzz/found
touch "$tally"

# Runs one reader for some seconds, starting from its corpus, and adds a line to the tally.
run_reader() {
  local reader=$1 corpus=build-fuzz/corpus/$1 log=build-fuzz/$1.log status=0
  mkdir -p "$corpus"
  "$fuzzer" "--reader=$reader" "--seeds=$corpus"
  "$fuzzer" "--reader=$reader" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=1500 \
    -malloc_limit_mb=1000 -max_len=65536 -use_value_profile=1 -print_final_stats=1 \
    -dict=tests/fuzz/words.dict -artifact_prefix="build-fuzz/found/$reader-" "$corpus" \
    >"$log" 2>&1 || status=$?
  ((status == 0)) || echo "$reader: an input fails; see $log and build-fuzz/found" >&2
  awk -v reader="$reader" '
    /^stat::number_of_executed_units/ { executions = $2 }
    /^Done .* runs in .* second/ { seconds = $5 }
    { for (i = 1; i < NF; ++i) if ($i == "cov:") coverage = $(i + 1) }
    END { print reader, executions + 0, seconds + 0, coverage + 0 }' "$log" | tee -a "$tally"
  return "$status"
}

failed=0
while :; do
  lines=
  for reader in "${readers[@]}"; do
    line=$(run_reader "$reader") || failed=1
    lines+=$line$'\n'
    ((total == 0 || $(executions_so_far) < total)) || break
  done
  ((failed == 0 && total > 0 && $(executions_so_far) < total)) || break
done
if ((total > 0)); then table <"$tally"; else table < <(printf '%s' "$lines"); fi
exit "$failed"

#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
#
# Makes the atlas of best codes, src/design/atlas/atlas.txt: designs a code for each of its cameras
# by sweeps (scripts/atlas/*.toml). Finished items are stored, so it can be stopped and run again at
# any time. Existing entries are only replaced by better ones; run it with another --seed to improve
# them.
#
#   scripts/atlas.sh [--shard 3/8] [--seed 2] [STORES]       a folder (build-atlas)
#   scripts/atlas.sh --collect [STORES]                      write the finished items, compute nothing
#
# Each shard has a separate store; `tofsmith sweep merge` combines them.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/packages.sh
source "$root/scripts/packages.sh"
read -ra tofsmith <<<"${TOFSMITH:-$root/build-dev/apps/tofsmith}"

shard='' seed=1 collect=false stores="$root/build-atlas"
while (($#)); do
  case "$1" in
    -h | --help)
      print_help && exit
      ;;
    --shard) shard=${2:?--shard needs i/n} && shift ;;
    --seed) seed=${2:?--seed needs a number} && shift ;;
    --collect) collect=true ;;
    -*) tofsmith_die "unknown option $1; see --help" ;;
    *) stores=$1 ;;
  esac
  shift
done
mkdir -p "$stores"

exports=()
for sweep in "$root"/scripts/atlas/*.toml; do
  name=$(basename "$sweep" .toml)-$seed
  store="$stores/$name${shard:+-${shard/\//-of-}}.sqlite"
  # A sweep has one seed, so each seed has its own store.
  sed "1,/^trials/s/^trials.*/&\nseed = $seed/" "$sweep" >"$stores/$name.toml"
  how=()
  [[ -z "$shard" ]] || how+=(--shard "$shard")
  ! $collect || how+=(--status)
  "${tofsmith[@]}" sweep "$stores/$name.toml" --store "$store" "${how[@]}" \
    --export "$stores/$name.json" --force
  exports+=("$stores/$name.json")
done
[[ -z "$shard" ]] || exit 0 # the atlas needs all shards
"$root/scripts/atlas/collect.py" "$root/src/design/atlas/atlas.txt" "${exports[@]}"

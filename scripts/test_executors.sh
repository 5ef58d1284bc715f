#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
#
# Runs the examples of docs/scaling.md on real engines and compares their results with a sweep in
# one process: a process pool, Dask with four workers (one of them is killed), mpi4py.futures, and
# Slurm on this machine only. Installs the engines; requires a build with the command line and the
# Python package.
#
#   scripts/test_executors.sh [BUILD]       a folder (build-dev)
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/packages.sh
source "$root/scripts/packages.sh"
case "${1:-}" in
  -h | --help)
    print_help && exit
    ;;
esac
build=$(cd "${1:-$root/build-dev}" && pwd)
install_packages executors

export PYTHONPATH="$build/python" PATH="$build/apps:/usr/sbin:/usr/bin:/bin"
work=$(mktemp -d)
started=()
stop_all() {
  ((${#started[@]} == 0)) || kill "${started[@]}" 2>/dev/null || true
  wait
  rm -rf "$work"
}
trap stop_all EXIT
cd "$work"

# Writes the code blocks of the page whose first line is a file name.
python3 - "$root/docs/scaling.md" <<'PYTHON'
import re, sys
page = open(sys.argv[1], encoding="utf-8").read()
for block in re.findall(r"```\w+\n(.*?)```", page, re.S):
    name = re.search(r"^# (\w+\.\w+)", block, re.M)
    if name:
        open(name[1], "w", encoding="utf-8").write(block)
PYTHON

# Waits up to 60 seconds for a command to succeed.
wait_for() {
  local attempt
  for ((attempt = 0; attempt < 300; ++attempt)); do
    if "$@" >/dev/null 2>&1; then return 0; fi
    sleep 0.2
  done
  tofsmith_die "no success within 60 s: $*$(tail -n 5 ./*.log)"
}
# Prints the number of finished items in a store.
finished() { tofsmith sweep sweep.toml --store "$1" --status --json | sed -n 's/.*"finished": *\([0-9]*\).*/\1/p'; }
# Fails unless the export of a store is identical to that of the sweep in one process.
compare() {
  tofsmith sweep sweep.toml --store "$1" --status --quiet --export "$1.json" >/dev/null
  cmp expected.sqlite.json "$1.json"
  echo "ok: $2"
}

compute_expected() {
  rm -f expected.sqlite*
  tofsmith sweep sweep.toml --store expected.sqlite --quiet --export expected.sqlite.json >/dev/null
}
compute_expected

test_pool() {
  python3 pool.py
  compare pool.sqlite 'process pool'
}

test_dask() {
  dask-scheduler --host 127.0.0.1 --port 0 --no-dashboard --scheduler-file scheduler.json \
    &>scheduler.log &
  started+=($!)
  wait_for test -s scheduler.json
  local worker workers=()
  for worker in 1 2 3 4; do
    dask-worker --scheduler-file scheduler.json --nthreads 1 --no-nanny --no-dashboard \
      --local-directory "$work" &>"worker-$worker.log" &
    workers+=($!)
  done
  started+=("${workers[@]}")
  for worker in 1 2 3 4; do wait_for grep -q Registered "worker-$worker.log"; done

  # More trials, so that the worker is killed while it is busy.
  sed -i 's/^trials = .*/trials = 40000/' sweep.toml
  compute_expected
  python3 dask_client.py "$(sed -n 's/.*"address": "\(.*\)".*/\1/p' scheduler.json)" &
  local client=$!
  wait_for test -s dask.sqlite
  until (($(finished dask.sqlite) >= 20)); do sleep 0.1; done
  kill -KILL "${workers[0]}"
  local at
  at=$(finished dask.sqlite)
  wait "$client"
  ((at < 200)) || tofsmith_die "the worker was killed after the end of the sweep"
  compare dask.sqlite "Dask, one of four workers killed at $at of 200 items"
}

test_mpi() {
  local options=(-n 3)
  ((EUID != 0)) || options+=(--allow-run-as-root)
  mpirun "${options[@]}" --oversubscribe python3 -m mpi4py.futures mpi.py
  compare mpi.sqlite 'mpi4py.futures, two workers'
}

# Starts munged, slurmctld and slurmd with files in this folder. They reject other users' folders.
start_slurm() {
  local host user
  host=$(hostname -s) user=$(id -un)
  chmod 755 "$work"
  mkdir -m 755 slurm
  dd if=/dev/urandom of=slurm/munge.key bs=1024 count=1 status=none
  chmod 400 slurm/munge.key
  munged --foreground --force --key-file="$work/slurm/munge.key" --socket="$work/slurm/munge.socket" \
    --pid-file="$work/slurm/munged.pid" --seed-file="$work/slurm/munge.seed" &>munged.log &
  started+=($!)
  wait_for test -S slurm/munge.socket
  cat >slurm/slurm.conf <<CONF
ClusterName=tofsmith
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=16817
SlurmdPort=16818
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
AuthInfo=socket=$work/slurm/munge.socket
CredType=cred/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
SlurmctldParameters=enable_configless
SlurmdParameters=config_overrides
StateSaveLocation=$work/slurm/state
SlurmdSpoolDir=$work/slurm/spool
SlurmctldPidFile=$work/slurm/slurmctld.pid
SlurmdPidFile=$work/slurm/slurmd.pid
NodeName=$host NodeAddr=127.0.0.1 CPUs=2
PartitionName=test Nodes=ALL Default=YES MaxTime=10 State=UP
CONF
  mkdir slurm/state slurm/spool
  export SLURM_CONF="$work/slurm/slurm.conf"
  slurmctld -D &>slurmctld.log &
  started+=($!)
  slurmd -D -N "$host" &>slurmd.log &
  started+=($!)
  wait_for sh -c 'sinfo -h -o %T | grep -q idle'
}

test_slurm() {
  start_slurm
  sbatch --wait array.sh >sbatch.log || tofsmith_die "sbatch failed: $(cat sbatch.log slurm-*.out)"
  tofsmith sweep merge all.sqlite part-*.sqlite >/dev/null
  (($(find . -maxdepth 1 -name 'part-*.sqlite' | wc -l) == 4)) || tofsmith_die 'there are no four parts'
  compare all.sqlite 'Slurm array of four tasks'
}

test_pool
test_mpi
test_slurm
test_dask
echo 'all engines gave the same bytes'

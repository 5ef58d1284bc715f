# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Sweeps and training sets give the same bytes on any executor and after losing workers."""

import contextlib
import multiprocessing
import os
import re
import signal
import sqlite3
import subprocess
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
import pytest

import tofsmith as ts
from tofsmith import _executor

SWEEP = """
set = ["samples=60"]
codes = ["square-k4", "hamiltonian-k4"]
trials = {trials}
[[axis]]
key = "signal_e_per_s"
from = 1e3
to = 1e5
count = 20
[[axis]]
key = "ambient_e_per_s"
values = [1e4]
"""
ITEMS = 40


class Inline(Executor):
    """Computes in submit(); `outcome(call number)` may return an exception to raise."""

    def __init__(self, outcome=lambda call: None):
        self.calls, self.outcome = 0, outcome

    def submit(self, function, /, *arguments):
        self.calls += 1
        future, error = Future(), self.outcome(self.calls)
        if error:
            future.set_exception(error)
        else:
            future.set_result(function(*arguments))
        return future


def pool(method, workers=2):
    return ProcessPoolExecutor(workers, mp_context=multiprocessing.get_context(method))


@pytest.fixture
def sweep(tmp_path):
    file = tmp_path / "sweep.toml"
    file.write_text(SWEEP.format(trials=2000))
    return file


@pytest.fixture
def export(cli, sweep):
    """Returns a function that exports a store and returns the bytes."""
    def bytes_of(store):
        output = store.with_suffix(".json")
        subprocess.run([cli, "sweep", sweep, "--store", store, "--status", "--export", output,
                        "--force", "--quiet"], check=True, capture_output=True)
        return output.read_bytes()
    return bytes_of


@pytest.fixture
def expected(sweep, export, tmp_path):
    ts.run_sweep(sweep, tmp_path / "expected.sqlite")
    return export(tmp_path / "expected.sqlite")


def statuses(store):
    with sqlite3.connect(store) as database:
        rows = database.execute("SELECT status, count(*) FROM items GROUP BY status")
        return dict(rows.fetchall())


executors = {
    "spawn": lambda: pool("spawn"),
    "fork": lambda: pool("fork"),
    "one": lambda: pool("fork", 1),
    "threads": lambda: ThreadPoolExecutor(3),
    "inline": Inline,
}


@pytest.mark.parametrize("name", executors)
def test_every_executor_gives_the_same_bytes(name, sweep, export, expected, tmp_path):
    with executors[name]() as executor:
        results = ts.run_sweep(sweep, tmp_path / "s.sqlite", executor=executor)
        assert (results.finished, results.failures) == (ITEMS, [])
        assert export(tmp_path / "s.sqlite") == expected
        again = ts.run_sweep(sweep, tmp_path / "s.sqlite", executor=executor)
    assert again.finished == ITEMS


def test_finished_items_are_not_computed_again(sweep, tmp_path):
    first, second = Inline(), Inline()
    ts.run_sweep(sweep, tmp_path / "s.sqlite", executor=first)
    ts.run_sweep(sweep, tmp_path / "s.sqlite", executor=second)
    assert first.calls > 0 and second.calls == 0


def test_lost_tasks_are_repeated(sweep, export, expected, tmp_path):
    flaky = Inline(lambda call: OSError("lost") if call % 3 == 1 else None)
    ts.run_sweep(sweep, tmp_path / "s.sqlite", executor=flaky)
    assert export(tmp_path / "s.sqlite") == expected


def test_a_task_that_always_fails_ends_the_run(sweep, tmp_path):
    executor = Inline(lambda call: OSError("no room") if call > 5 else None)
    with pytest.raises(RuntimeError, match="failed 4 times, the last time with OSError: no room"):
        ts.run_sweep(sweep, tmp_path / "s.sqlite", executor=executor)
    assert statuses(tmp_path / "s.sqlite") == {"finished": 5, "pending": ITEMS - 5}


class KilledPool:
    """Starts process pools, and kills a worker of the first pool while it computes."""

    def __init__(self):
        self.pools = []

    def __call__(self):
        self.pools.append(pool("fork"))
        return self.pools[-1]

    def progress(self, fraction, _):
        if len(self.pools) == 1 and fraction > 0.1:
            for process in list(self.pools[0]._processes)[:1]:
                with contextlib.suppress(ProcessLookupError):  # already killed
                    os.kill(process, signal.SIGKILL)


def test_a_new_pool_continues_after_a_killed_worker(sweep, export, expected, tmp_path):
    killed = KilledPool()
    ts.run_sweep(sweep, tmp_path / "s.sqlite", executor=killed, progress=killed.progress)
    assert len(killed.pools) == 2
    assert export(tmp_path / "s.sqlite") == expected


def test_a_broken_pool_keeps_finished_items(sweep, export, expected, tmp_path):
    killed = KilledPool()
    with killed() as broken, pytest.raises(RuntimeError, match="finished items are kept. Call"):
        ts.run_sweep(sweep, tmp_path / "s.sqlite", executor=broken, progress=killed.progress)
    found = statuses(tmp_path / "s.sqlite")
    assert set(found) == {"finished", "pending"} and found["finished"] >= ITEMS // 10
    with pool("fork") as new:
        ts.run_sweep(sweep, tmp_path / "s.sqlite", executor=new)
    assert export(tmp_path / "s.sqlite") == expected


def test_progress_stops_and_the_sweep_resumes(sweep, export, expected, tmp_path):
    seen = []

    def stop(fraction, step):
        seen.append(step)
        return fraction < 0.3

    with pytest.raises(ts.Interrupted):
        ts.run_sweep(sweep, tmp_path / "s.sqlite", executor=lambda: pool("fork"), progress=stop)
    assert re.fullmatch(rf"\d+ of {ITEMS} items", seen[-1])
    found = statuses(tmp_path / "s.sqlite")
    assert set(found) <= {"finished", "pending"} and found["finished"] >= 0.3 * ITEMS
    ts.run_sweep(sweep, tmp_path / "s.sqlite", executor=lambda: pool("fork"))
    assert export(tmp_path / "s.sqlite") == expected


def test_failed_items_are_listed(tmp_path):
    text = 'method = "unwrap"\n' + SWEEP.format(trials=16).replace("square", "sinusoid")
    alone = ts.run_sweep(text, tmp_path / "alone.sqlite")
    results = ts.run_sweep(text, tmp_path / "s.sqlite", executor=Inline())
    assert sorted(results.failures) == sorted(alone.failures) and results.failed == ITEMS // 2


def test_workers_of_other_builds_are_rejected():
    with pytest.raises(RuntimeError, match="0.0 on ABACUS: results would differ"):
        _executor.require_build(("0.0", "ABACUS"))


scenes = {f"{metres} m": np.full((6, 8), float(metres)) for metres in range(1, 8)}


def written(directory, given=scenes, **options):
    run = ts.write_training_set(directory, given, "square-k4", "paper-10f0", seed=3,
                                signal_range=(1e4, 1e6), **options)
    files = {p.relative_to(directory): p.read_bytes() for p in directory.rglob("*.*")}
    return run, files


@pytest.mark.parametrize("name", ["spawn", "threads", "inline"])
def test_training_sets_have_the_same_files(name, tmp_path):
    given = scenes | {"flat": np.ones(3), "eye": "table-top"}
    run, files = written(tmp_path / "alone", given)
    with executors[name]() as executor:
        other, others = written(tmp_path / name, given, executor=executor)
        assert others == files
        assert (other.scenes, other.written, other.kept) == (run.scenes, run.written, run.kept)
        assert other.failures == run.failures and other.failures[0].startswith("flat: ")
        again, _ = written(tmp_path / name, given, executor=executor)
    assert (again.written, again.kept) == (0, len(given) - 1)


def test_shards_of_training_sets_on_executors(tmp_path):
    for index in (1, 2):
        written(tmp_path / "alone", shard=(index, 2))
        written(tmp_path / "shards", shard=(index, 2), executor=Inline())
    assert written(tmp_path / "alone")[1] == written(tmp_path / "shards", executor=Inline())[1]


def test_an_interrupted_training_set_continues(tmp_path):
    with pytest.raises(ts.Interrupted):
        written(tmp_path / "set", executor=Inline(), progress=lambda fraction, step: False)
    run, files = written(tmp_path / "set", executor=Inline())
    assert run.kept > 0 and files == written(tmp_path / "alone")[1]


@pytest.mark.parametrize("executor, threads, message", [
    (3, 1, "executor: got int 3; needs a concurrent.futures.Executor"),
    (Inline(), -1, "threads: got"),
])
def test_rejects_bad_arguments(executor, threads, message, tmp_path):
    with pytest.raises((TypeError, ValueError), match=re.escape(message)):
        ts.run_sweep(SWEEP.format(trials=16), tmp_path / "s", executor=executor, threads=threads)

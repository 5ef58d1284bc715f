# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Long computations report progress, can be stopped and do not block other threads."""

import os
import signal
import threading

import pytest

import tofsmith as ts

long_work = {"trials": 2_000_000_000, "seed": 1}  # runs for many minutes unless stopped


def test_progress_rises_to_the_end(camera):
    seen = []
    ts.evaluate("square-k4", camera, trials=2000, progress=lambda f, step: seen.append((f, step)))
    fractions = [f for f, _ in seen]
    assert fractions == sorted(fractions) and 0 <= fractions[0] and fractions[-1] == 1
    assert all(isinstance(step, str) for _, step in seen)


def test_false_stops(camera):
    with pytest.raises(ts.Interrupted):
        ts.evaluate("square-k4", camera, progress=lambda f, step: False, **long_work)


def test_exceptions_of_the_callback_propagate(camera):
    with pytest.raises(ZeroDivisionError):
        ts.evaluate("square-k4", camera, progress=lambda f, step: 1 // 0, **long_work)


def test_ctrl_c_stops(camera):
    timer = threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        ts.evaluate("square-k4", camera, **long_work)


def test_other_threads_run_meanwhile(camera):
    stop = threading.Event()
    stopped = []

    def work():
        try:
            ts.evaluate("square-k4", camera, progress=lambda f, s: not stop.is_set(), **long_work)
        except ts.Interrupted as error:
            stopped.append(error)

    thread = threading.Thread(target=work)
    thread.start()
    thread.join(0.2)
    assert thread.is_alive()  # still computing
    stop.set()
    thread.join()
    assert stopped

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Long work reports, can be stopped, and lets other threads run."""

import os
import signal
import threading

import pytest

import tofsmith as ts

long_work = {"trials": 2_000_000_000, "seed": 1}  # many minutes, unless it is stopped


def test_progress_rises_to_the_end(camera):
    seen = []
    ts.evaluate("square-k4", camera, trials=2000, progress=lambda f, step: seen.append((f, step)))
    fractions = [f for f, _ in seen]
    assert fractions == sorted(fractions) and 0 <= fractions[0] and fractions[-1] == 1
    assert all(isinstance(step, str) for _, step in seen)


def test_false_stops(camera):
    with pytest.raises(ts.Interrupted):
        ts.evaluate("square-k4", camera, progress=lambda f, step: False, **long_work)


def test_what_the_callback_raises_passes_on(camera):
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
    assert thread.is_alive()  # and yet we are here
    stop.set()
    thread.join()
    assert stopped

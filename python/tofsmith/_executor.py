# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Computes items in small pieces on a concurrent.futures.Executor."""

from __future__ import annotations

import math
import os
import queue
import socket
import threading
import time
from collections.abc import Callable, Sequence
from concurrent.futures import BrokenExecutor, Executor, Future
from dataclasses import dataclass
from typing import Any, Union

from . import _check, _tofsmith

#: An executor, or a function that starts one and is called again when the executor breaks.
ExecutorLike = Union[Executor, Callable[[], Executor]]

#: Target duration of one piece [s]: a lost worker loses little, and the overhead is small.
PIECE_S = 1.0
MAX_PIECE_ITEMS = 256
#: Number of pieces submitted before any worker has answered.
FIRST_PIECES = 16
#: Maximum number of attempts for a piece, after which the run fails.
MAX_ATTEMPTS = 4


def require_build(build: tuple[str, str]) -> None:
    """Checks in a worker that it gives the same results as the calling process, whose
    worker_build() is `build`."""
    own = _tofsmith.worker_build()
    if own != build:
        raise RuntimeError(
            f"{socket.gethostname()} runs tofsmith {own[0]} on {own[1]}, and the calling process "
            f"{build[0]} on {build[1]}: results would differ. Install the same version everywhere, "
            f"and set TOFSMITH_TARGET to an instruction set that all machines have"
        )


@dataclass
class _Piece:
    items: Sequence[Any]
    executor: Any = None  # that it was submitted to
    attempts: int = 0


def _timed(
    compute: Callable[[Any], Sequence[Any]], items: Any, attempt: int
) -> tuple[str, float, Sequence[Any]]:
    """Runs in a worker. Returns the worker's name, the time [s] and the outcomes.

    Dask returns a cached result for calls with equal arguments; `attempt` makes them different."""
    begin = time.perf_counter()
    outcomes = compute(items)
    worker = f"{socket.gethostname()} {os.getpid()} {threading.get_ident()}"
    return worker, time.perf_counter() - begin, outcomes


class Dispatcher:
    """Submits pieces of the items returned by `claim` until none are left.

    Parameters
    ----------
    compute : callable
        Computes outcomes of items; runs in a worker, so it must be picklable.
    claim : callable
        Returns up to a given number of items; none if all were returned.
    left : callable
        Returns the number of items that `claim` has not yet returned.
    keep : callable
        Stores outcomes.
    """

    def __init__(
        self,
        executor: ExecutorLike,
        compute: Callable[[Any], Sequence[Any]],
        claim: Callable[[int], Sequence[Any]],
        left: Callable[[], int],
        keep: Callable[[Sequence[Any]], None],
    ) -> None:
        if not hasattr(executor, "submit") and not callable(executor):
            raise TypeError(f"executor: got {_check.shown(executor)}; needs a "
                            "concurrent.futures.Executor, or a function that starts one")
        self._start = None if hasattr(executor, "submit") else executor
        self._executor: Any = executor if self._start is None else self._start()
        self._compute, self._claim, self._left, self._keep = compute, claim, left, keep
        self._running: dict[Future[Any], _Piece] = {}
        self._done: queue.SimpleQueue[Future[Any]] = queue.SimpleQueue()
        self._lost: list[_Piece] = []
        self._workers: set[str] = set()
        self._seconds_each = math.inf

    def run(self, report: Callable[[], None]) -> None:
        """Computes all items. Calls `report` about 20 times a second, which may cancel by raising
        an exception; outcomes available by then are kept."""
        try:
            while self._submit():
                self._collect(0.05)
                report()
        finally:
            self._stop()

    def _submit(self) -> bool:
        """Submits up to two pieces per known worker. Returns whether any is running."""
        while len(self._running) < max(FIRST_PIECES, 2 * len(self._workers)):
            piece = self._lost.pop() if self._lost else _Piece(self._claim(self._piece_size()))
            if not piece.items:
                break
            piece.executor = self._executor
            try:
                future = self._executor.submit(_timed, self._compute, piece.items, piece.attempts)
            except BrokenExecutor as error:
                self._repeat(piece, error)
                continue
            self._running[future] = piece
            future.add_done_callback(self._done.put)
        return bool(self._running)

    def _piece_size(self) -> int:
        """Returns the items for PIECE_S of work, fewer near the end, so that workers end
        together."""
        share = self._left() // (2 * max(1, len(self._workers)))
        return max(1, min(int(PIECE_S / self._seconds_each), share, MAX_PIECE_ITEMS))

    def _collect(self, max_wait_s: float) -> None:
        """Waits for a piece, then keeps the outcomes of all that are done."""
        try:
            futures = [self._done.get(timeout=max_wait_s)]
        except queue.Empty:
            return
        while not self._done.empty():
            futures.append(self._done.get())
        outcomes: list[Any] = []
        try:
            for future in futures:
                outcomes += self._outcomes(future, self._running.pop(future))
        finally:
            self._keep(outcomes)

    def _outcomes(self, future: Future[Any], piece: _Piece) -> Sequence[Any]:
        try:
            result: tuple[str, float, Sequence[Any]] = future.result()
        except Exception as error:
            self._repeat(piece, error)
            return []
        worker, seconds, outcomes = result
        self._workers.add(worker)
        seconds_each = max(seconds / len(piece.items), 1e-6)
        if math.isinf(self._seconds_each):
            self._seconds_each = seconds_each
        self._seconds_each += 0.3 * (seconds_each - self._seconds_each)
        return outcomes

    def _repeat(self, piece: _Piece, error: Exception) -> None:
        """Queues a lost or failed piece again, for a new executor if this one broke."""
        piece.attempts += 1
        if piece.attempts == MAX_ATTEMPTS:
            raise RuntimeError(
                f"executor: a piece of {len(piece.items)} items failed {MAX_ATTEMPTS} times, the "
                f"last time with {type(error).__name__}: {error}; finished items are kept"
            ) from error
        self._lost.append(piece)
        if not isinstance(error, BrokenExecutor) or piece.executor is not self._executor:
            return
        if self._start is None:
            raise RuntimeError(
                f"executor: a worker was lost, which broke the executor ({error}); finished items "
                "are kept. Call again with a new executor, or pass a function that starts one: "
                "executor=lambda: ProcessPoolExecutor(8)"
            ) from error
        self._executor.shutdown(wait=False)
        self._executor = self._start()

    def _stop(self) -> None:
        outcomes: list[Any] = []
        for future in self._running:
            if not future.cancel() and future.done() and future.exception() is None:
                outcomes += future.result()[2]
        self._keep(outcomes)
        if self._start is not None:
            self._executor.shutdown(wait=not self._running)

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Sweeps over cameras, codes, light levels and seeds, and their results."""

from __future__ import annotations

import csv
import functools
import json
import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from . import _check, _tofsmith
from ._check import Path, Progress
from ._executor import Dispatcher, ExecutorLike, require_build


@dataclass(frozen=True)
class SweepResults:
    """Columns of equal length, with one row per finished item and operating point.

    Attributes
    ----------
    columns : dict of ndarray
        item, code, one per axis of the sweep, and signal_e_per_s, ambient_e_per_s, linear_mde_m,
        linear_se_m, circular_mde_m, circular_se_m, linear_rmse_m, linear_rmse_se_m,
        circular_rmse_m, circular_rmse_se_m, outlier_rate, cramer_rao_mae_m,
        receiver_bound_mae_m, direct_tof_bound_mae_m.
    items, finished, failed, pending : int, optional
        Progress of the sweep, for results from a store.
    failures : list of str
        One line per failed item.
    """

    columns: dict[str, npt.NDArray[Any]]
    items: Optional[int] = None
    finished: Optional[int] = None
    failed: Optional[int] = None
    pending: Optional[int] = None
    seconds: Optional[float] = None
    failures: list[str] = field(default_factory=list)

    def __getitem__(self, name: str) -> npt.NDArray[Any]:
        """Returns a column; KeyError lists the existing names."""
        if name in self.columns:
            return self.columns[name]
        raise KeyError(f"no column '{name}'; there are {', '.join(self.columns)}")

    def __len__(self) -> int:
        return len(next(iter(self.columns.values()), ()))

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

    def where(self, **values: Any) -> SweepResults:
        """Returns the rows whose columns have the given values; numbers within 1e-9 (relative)."""
        kept = np.ones(len(self), bool)
        for name, value in values.items():
            column = self[name]
            kept &= np.isclose(column, value, 1e-9, 0) if column.dtype.kind in "fi" else (
                [each == value for each in column])
        return SweepResults({name: column[kept] for name, column in self.columns.items()})

    def __repr__(self) -> str:
        return f"<SweepResults: {len(self)} rows of {', '.join(self.columns)}>"


def _texts_joined(arrays: dict[str, npt.NDArray[Any]]) -> dict[str, npt.NDArray[Any]]:
    """Combines NAME_index and NAME_names (bytes padded with zeros) into one column of texts."""
    columns = {}
    for name, array in arrays.items():
        if name.endswith("_index") and f"{name[:-6]}_names" in arrays:
            rows = arrays[f"{name[:-6]}_names"]
            names = np.array([bytes(row).rstrip(b"\0").decode() for row in rows], object)
            columns[name[:-6]] = names[array].astype(str) if len(array) else array.astype(str)
        elif not (name.endswith("_names") and f"{name[:-6]}_index" in arrays):
            columns[name] = array
    return columns


def _of_store(values: dict[str, Any]) -> SweepResults:
    return SweepResults(_texts_joined(values.pop("arrays")), **values)


#: Position in the list, and key.
_Item = tuple[int, str]
#: Key, result, error message, and seconds.
_Outcome = tuple[str, str, str, float]


@functools.lru_cache(maxsize=2)
def _list_in_worker(text: str, source_name: str) -> _tofsmith.SweepList:
    return _tofsmith.SweepList(text, source_name)


def _compute_items(
    text: str, source_name: str, build: tuple[str, str], threads: int, items: Sequence[_Item]
) -> Sequence[_Outcome]:
    """Runs in a worker of an executor."""
    require_build(build)
    return _list_in_worker(text, source_name).compute(items, threads)


def _run_on_executor(
    run: _tofsmith.SweepRun, sweep: tuple[str, bool], executor: ExecutorLike, threads: int,
    progress: Progress
) -> list[str]:
    """Returns the messages of failed items."""
    failures: list[str] = []
    text, source_name = sweep[0], os.path.abspath("sweep")
    if not sweep[1]:
        source_name = os.path.abspath(sweep[0])
        with open(source_name, encoding="utf-8") as file:
            text = file.read()

    def keep(outcomes: Sequence[_Outcome]) -> None:
        run.finish(outcomes)
        failures.extend(message for _, _, message, _ in outcomes if message)

    def report() -> None:
        step = f"{run.settled} of {run.size} items"
        if progress and progress(run.settled / run.size, step) is False:
            raise _tofsmith.Interrupted("interrupted")

    compute = functools.partial(
        _compute_items, text, source_name, _tofsmith.worker_build(), threads)
    Dispatcher(executor, compute, run.claim, lambda: run.left, keep).run(report)
    return failures


def run_sweep(
    sweep: Path,
    store: Path,
    *,
    executor: Optional[ExecutorLike] = None,
    threads: int = 1,
    progress: Progress = None,
) -> SweepResults:
    """Computes all unfinished items of a sweep, on this machine or on an executor.

    Parameters
    ----------
    sweep : str or path
        A TOML file, or its text (with a line break); see docs/sweeps.md.
    store : str or path
        SQLite file of results, created if missing; finished items are not computed again.
    executor : concurrent.futures.Executor or a function that starts one, optional
        Computes the items, in pieces of about one second: a process pool, Dask's
        ``Client.get_executor()``, ``mpi4py.futures.MPIPoolExecutor``. Its workers need the same
        version of tofsmith and the files that the sweep names. Lost pieces are repeated up to
        three times. A function is called again when a pool breaks, because a process pool that
        lost a worker is unusable. None: all cores of this machine.
    threads : int, optional
        Threads of each worker of the executor; 0: one per core.
    progress : callable, optional
        Finished items are kept if it cancels.

    Raises
    ------
    OSError
        For errors in the sweep file, with line and column, or if the store fails.
    RuntimeError
        If the executor breaks or a piece fails four times. Finished items are kept.

    Examples
    --------
    >>> from concurrent.futures import ProcessPoolExecutor  # doctest: +SKIP
    >>> with ProcessPoolExecutor(8) as pool:  # doctest: +SKIP
    ...     results = run_sweep("sweep.toml", "store.sqlite", executor=pool)
    """
    source = _source(sweep)
    path = _check.path(store, "store")
    callback = _check.progress(progress)
    if executor is None:
        return _of_store(_tofsmith.run_sweep(*source, path, callback))
    _check.whole(threads, "threads", 0, 65536)
    run = _tofsmith.SweepRun(*source, path, callback)
    try:
        failures = _run_on_executor(run, source, executor, threads, callback)
    finally:
        run.release()
    return _of_store(run.results() | {"failures": failures})


def read_sweep(sweep: Path, store: Path, *, progress: Progress = None) -> SweepResults:
    """Returns the finished items of a sweep without computing."""
    source, is_text = _source(sweep)
    callback = _check.progress(progress)
    return _of_store(_tofsmith.read_sweep(source, is_text, _check.path(store, "store"), callback))


def _source(sweep: Path) -> tuple[str, bool]:
    source = _check.path(sweep, "sweep")
    return source, isinstance(sweep, str) and "\n" in source


def read_sweep_export(path: Path) -> SweepResults:
    """Reads results of `tofsmith sweep --export`: .npz, .csv or .json.

    Raises
    ------
    OSError
        If the file cannot be read or is not such an export.
    """
    name = _check.path(path)
    extension = os.path.splitext(name)[1]
    readers = {".npz": _npz_columns, ".csv": _csv_columns, ".json": _json_columns}
    if extension not in readers:
        raise OSError(f"{name}: found the extension '{extension}'; expected .npz, .csv or .json")
    try:
        columns = readers[extension](name)
    except (KeyError, ValueError, IndexError, TypeError) as error:
        raise OSError(f"{name}: is no export of a sweep ({error})") from error
    if "linear_mde_m" not in columns:
        raise OSError(f"{name}: found no column linear_mde_m; expected an export of a sweep")
    return SweepResults(columns)


def _npz_columns(name: str) -> dict[str, npt.NDArray[Any]]:
    with np.load(name) as arrays:
        return _texts_joined({key: arrays[key] for key in arrays.files})


def _column(values: list[Any]) -> npt.NDArray[Any]:
    try:
        return np.array([float(v) for v in values])
    except (TypeError, ValueError):
        return np.array([str(v) for v in values])


def _csv_columns(name: str) -> dict[str, npt.NDArray[Any]]:
    with open(name, newline="", encoding="utf-8-sig") as file:
        rows = list(csv.reader(file))
    return {key: _column([row[i] for row in rows[1:]]) for i, key in enumerate(rows[0])}


def _json_columns(name: str) -> dict[str, npt.NDArray[Any]]:
    with open(name, encoding="utf-8") as file:
        document = json.load(file)
    rows = []
    for entry in document["codes"]:
        for point in entry["points"]:
            row = {"item": entry["item"], "code": entry["name"]}
            given = entry["settings"].items()
            settings = {k: v for k, v in given if k not in point and k != "code"}
            rows.append(row | settings | point)
    keys = list(rows[0]) if rows else ["linear_mde_m"]
    return {key: _column([row[key] for row in rows]) for key in keys}

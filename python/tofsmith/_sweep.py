# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Sweeps over cameras, codes, light levels and seeds, and their results."""

from __future__ import annotations

import csv
import json
import os
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from . import _check, _tofsmith
from ._check import Path, Progress


@dataclass(frozen=True)
class SweepResults:
    """Columns of one length, a row for each finished item and operating point.

    Attributes
    ----------
    columns : dict of ndarray
        item, code, one per axis of the sweep, and signal_e_per_s, ambient_e_per_s, linear_mde_m,
        linear_se_m, circular_mde_m, circular_se_m, linear_rmse_m, linear_rmse_se_m,
        circular_rmse_m, circular_rmse_se_m, outlier_rate, cramer_rao_mae_m,
        receiver_bound_mae_m, direct_tof_bound_mae_m.
    items, finished, failed, pending : int, optional
        Of a store: how far the sweep has come.
    failures : list of str
        One line for each item that could not be finished.
    """

    columns: dict[str, npt.NDArray[Any]]
    items: Optional[int] = None
    finished: Optional[int] = None
    failed: Optional[int] = None
    pending: Optional[int] = None
    seconds: Optional[float] = None
    failures: list[str] = field(default_factory=list)

    def __getitem__(self, name: str) -> npt.NDArray[Any]:
        """A column; KeyError names those there are."""
        if name in self.columns:
            return self.columns[name]
        raise KeyError(f"no column '{name}'; there are {', '.join(self.columns)}")

    def __len__(self) -> int:
        return len(next(iter(self.columns.values()), ()))

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

    def where(self, **values: Any) -> SweepResults:
        """The rows in which columns have the given values; numbers within 1e-9."""
        kept = np.ones(len(self), bool)
        for name, value in values.items():
            column = self[name]
            kept &= np.isclose(column, value, 1e-9, 0) if column.dtype.kind in "fi" else (
                column == value)
        return SweepResults({name: column[kept] for name, column in self.columns.items()})

    def __repr__(self) -> str:
        return f"<SweepResults: {len(self)} rows of {', '.join(self.columns)}>"


def _texts_joined(arrays: dict[str, npt.NDArray[Any]]) -> dict[str, npt.NDArray[Any]]:
    """NAME_index into NAME_names, bytes padded with zeros, become one column of texts."""
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


def run_sweep(sweep: Path, store: Path, *, progress: Progress = None) -> SweepResults:
    """Finishes all items of a sweep that are unfinished, with all processes that work on the store.

    Parameters
    ----------
    sweep : str or path
        A TOML file, or its text (with a line break); see docs/sweeps.md.
    store : str or path
        SQLite file of results, made if it is missing; what is finished there is not computed again.
    progress : callable, optional
        What is finished when it stops the work is kept.

    Raises
    ------
    OSError
        For what the sweep's file may not say, with line and column, or if the store fails.
    """
    source, is_text = _source(sweep)
    callback = _check.progress(progress)
    return _of_store(_tofsmith.run_sweep(source, is_text, _check.path(store, "store"), callback))


def read_sweep(sweep: Path, store: Path, *, progress: Progress = None) -> SweepResults:
    """The finished items of a sweep; computes nothing."""
    source, is_text = _source(sweep)
    callback = _check.progress(progress)
    return _of_store(_tofsmith.read_sweep(source, is_text, _check.path(store, "store"), callback))


def _source(sweep: Path) -> tuple[str, bool]:
    source = _check.path(sweep, "sweep")
    return source, isinstance(sweep, str) and "\n" in source


def read_sweep_export(path: Path) -> SweepResults:
    """Results that `tofsmith sweep --export` wrote: .npz, .csv or .json.

    Raises
    ------
    OSError
        If the file cannot be read or is no such export.
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
    with open(name, newline="", encoding="utf-8") as file:
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

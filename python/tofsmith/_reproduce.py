# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""The paper's figures and statements, with our numbers; see docs/paper.md."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Optional, Union

from . import _check, _tofsmith
from ._check import Path, Progress


@dataclass(frozen=True)
class CheckedStatement:
    """What the paper states, and what we found.

    Attributes
    ----------
    verdict : str
        holds, holds in part or does not hold.
    statement, measured, why : str
        The statement, our number beside it, and what explains a difference.
    """

    verdict: str
    statement: str
    measured: str
    why: str


@dataclass(frozen=True)
class ReproducedItem:
    """One figure, table or group of statements of the paper.

    Attributes
    ----------
    name, title : str
    verdict : str
        holds or does not hold if all findings do, else holds in part.
    findings : list of CheckedStatement
    kept : bool
        It was finished before.
    """

    name: str
    title: str
    verdict: str
    findings: list[CheckedStatement]
    kept: bool


def paper_items() -> list[tuple[str, str]]:
    """Names and titles of what reproduce() makes, in the paper's order."""
    return _tofsmith.paper_items()


def reproduce(
    names: Union[str, Sequence[str]],
    directory: Path,
    *,
    fast: bool = False,
    seed: int = 1,
    mesh: Optional[Path] = None,
    overwrite: bool = False,
    progress: Progress = None,
) -> list[ReproducedItem]:
    """Makes figures of the paper in a directory: a page of each with its data, and an index.

    Parameters
    ----------
    names : str or sequence of str
        One or several of paper_items(), or "all".
    directory : str or path
        Made if it is missing; what is finished there is not made again.
    fast : bool
        Coarse: seconds instead of minutes, larger errors.
    seed : int
        Of every random choice.
    mesh : str or path, optional
        For fig7, instead of the modelled hand (.obj .ply .stl, of any size).
    overwrite : bool
        Make again what is finished, and replace what something else made.
    progress : callable, optional
        What is finished when it stops the work is kept.

    Raises
    ------
    ValueError
        For a name that is none, with the nearest there is.
    OSError
        If the directory holds pages of something else, or cannot be written.
    """
    wanted = [names] if isinstance(names, str) else list(names)
    if not wanted:
        raise ValueError('names: got none; needs "all" or some of paper_items()')
    for name in wanted:
        _check.text(name, "names")
    options = {
        "fast": fast,
        "seed": seed,
        "mesh": None if mesh is None else _check.path(mesh, "mesh"),
    }
    folder = _check.path(directory, "directory")
    callback = _check.progress(progress)
    items = _tofsmith.reproduce(wanted, folder, options, bool(overwrite), callback)
    for item in items:
        item["findings"] = [CheckedStatement(**finding) for finding in item["findings"]]
    return [ReproducedItem(**item) for item in items]

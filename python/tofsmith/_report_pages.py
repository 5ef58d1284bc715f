# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""HTML reports, each in one self-contained file."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Optional, Union

from . import _check, _tofsmith
from ._camera import CameraLike, camera_of
from ._check import Path
from ._code import CodeLike, code_of
from ._reports import DepthErrorReport, fields_of


def write_report(
    directory: Path, path: Optional[Path] = None, *, overwrite: bool = False
) -> None:
    """Writes the report page for a directory of `design -o`, `demo -o` or DesignResult.write(), as
    `tofsmith report`.

    Parameters
    ----------
    directory : str or path
    path : str or path, optional
        Default: report.html in the directory.
    overwrite : bool

    Raises
    ------
    OSError
        If the directory contains no finished design, or the page exists and `overwrite` is not set.
    """
    folder = _check.path(directory, "directory")
    page = os.path.join(folder, "report.html") if path is None else _check.path(path)
    _tofsmith.write_directory_report(folder, page, bool(overwrite))


def write_evaluation_report(
    path: Path,
    codes: Union[CodeLike, Sequence[CodeLike]],
    camera: CameraLike,
    reports: Union[DepthErrorReport, Sequence[DepthErrorReport]],
    *,
    overwrite: bool = False,
) -> None:
    """Writes the page of codes evaluated on a camera, as `tofsmith evaluate -o page.html`: depth
    errors and bounds, maps over the operating range, waveforms.

    Parameters
    ----------
    path : str or path
        .html
    codes : CodeSet, name of a family or file, or a sequence of them
    camera : Camera or its name
    reports : DepthErrorReport or a sequence of them
        Results of evaluate() for each code on that camera.
    overwrite : bool

    Raises
    ------
    ValueError
        If the numbers of reports and codes differ, or a report has other operating points.
    OSError
        If the page exists and `overwrite` is not set, or cannot be written.

    Examples
    --------
    >>> report = evaluate("square-k4", camera)  # doctest: +SKIP
    >>> write_evaluation_report("square.html", "square-k4", camera, report)  # doctest: +SKIP
    """
    camera = camera_of(camera)
    shown = list(codes) if isinstance(codes, (list, tuple)) else [codes]
    given = [reports] if isinstance(reports, DepthErrorReport) else list(reports)
    if len(given) != len(shown) or not given:
        raise ValueError(f"reports: got {len(given)}; needs one for each of {len(shown)} codes")
    handles = [code_of(code, camera).resampled(camera.samples)._handle for code in shown]
    fields = [fields_of(_check.instance(r, DepthErrorReport, "reports")) for r in given]
    page = _check.path(path)
    _tofsmith.write_evaluation_report(page, handles, camera._handle, fields, bool(overwrite))

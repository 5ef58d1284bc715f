# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Arguments shared by the figures of plot (matplotlib) and figures (HTML)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from . import _check
from ._camera import Camera, CameraLike, camera_of
from ._check import FloatArray
from ._code import CodeLike, CodeSet, code_of
from ._depth_image import DepthImage
from ._design import Candidate
from ._reports import DepthErrorReport
from ._sweep import SweepResults

Reports = Union[DepthErrorReport, Candidate, Sequence[Union[DepthErrorReport, Candidate]]]
Depth = Union[DepthImage, npt.NDArray[Any]]


def code_and_camera(code: CodeLike, camera: CameraLike) -> tuple[CodeSet, Camera]:
    camera = camera_of(camera)
    return code_of(code, camera), camera


def reports_of(reports: Reports) -> list[DepthErrorReport]:
    """Returns a list of one or more reports."""
    listed = [reports] if isinstance(reports, (DepthErrorReport, Candidate)) else list(reports)
    if not listed:
        raise ValueError("reports: got none; needs at least one DepthErrorReport")
    errors = [r.error if isinstance(r, Candidate) else r for r in listed]
    return [_check.instance(r, DepthErrorReport, "reports") for r in errors]


def kind_of(reports: list[DepthErrorReport], kind: str | None) -> str:
    """Returns the given kind of error, or that of the camera of the first report."""
    return reports[0].kind if kind is None else _check.one_of(kind, "kind", ("linear", "circular"))


def error_grid(
    report: DepthErrorReport, kind: str
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Returns signals (S,), ambient lights (A,), mean depth error and its standard error (S, A)
    [m]."""
    signal, row = np.unique(report.signal_e_per_s, return_inverse=True)
    ambient, column = np.unique(report.ambient_e_per_s, return_inverse=True)
    values, errors = np.full((2, len(signal), len(ambient)), np.nan)
    values[row, column] = getattr(report, f"{kind}_mde_m")
    errors[row, column] = getattr(report, f"{kind}_se_m")
    return signal, ambient, values, errors


def error_curve(
    report: DepthErrorReport, kind: str, along: str, at: float | None
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, float]:
    """Returns a section along signal or ambient light, with the other light at the level nearest to
    `at` (default: the middle level): positions, errors, standard errors, receiver bounds [m],
    level."""
    _check.one_of(along, "along", ("signal", "ambient"))
    pair = (report.signal_e_per_s, report.ambient_e_per_s)
    x, other = pair if along == "signal" else pair[::-1]
    levels = np.unique(other)
    near = levels[len(levels) // 2] if at is None else levels[np.argmin(np.abs(levels - at))]
    kept = other == near
    order = np.argsort(x[kept])
    mde, se = (getattr(report, f"{kind}_{name}_m") for name in ("mde", "se"))
    picked = [values[kept][order] for values in (x, mde, se, report.receiver_bound_mae_m)]
    return picked[0], picked[1], picked[2], picked[3], float(near)


def error_range(maps_mm: Sequence[FloatArray]) -> tuple[float, float]:
    """Returns the limits of a logarithmic colour scale that includes all finite values."""
    values = np.concatenate([m[np.isfinite(m)] for m in maps_mm])
    lowest = max(float(values.min()), 1e-6)
    return lowest, max(float(values.max()), 1.001 * lowest)


def sweep_maps(
    results: SweepResults, x: str, y: str, kind: str
) -> tuple[FloatArray, FloatArray, dict[str, FloatArray]]:
    """Returns the values of two columns of a sweep, (X,) and (Y,), and the depth errors of every
    code, (Y, X) [mm]: geometric means over all other columns; NaN for cells with fewer finished
    rows."""
    _check.instance(results, SweepResults, "results")
    _check.one_of(kind, "kind", ("linear", "circular"))
    if x == y:
        raise ValueError(f"y: got '{y}' as x; needs another column")
    numbers = [name for name, column in results.columns.items()
               if column.dtype.kind in "fi" and len(np.unique(column)) > 1]
    for argument, name in (("x", x), ("y", y)):
        if name not in numbers:
            raise ValueError(f"{argument}: got '{name}'; needs a column of numbers that vary: "
                             f"{', '.join(numbers)}")
    across, column = np.unique(results[x], return_inverse=True)
    up, row = np.unique(results[y], return_inverse=True)
    errors = np.log(1e3 * np.maximum(results[f"{kind}_mde_m"], 1e-12))
    maps = {}
    for code in dict.fromkeys(results["code"].tolist()):
        kept = results["code"] == code
        sums, counts = np.zeros((2, len(up), len(across)))
        np.add.at(sums, (row[kept], column[kept]), errors[kept])
        np.add.at(counts, (row[kept], column[kept]), 1)
        whole = counts == counts.max()
        maps[str(code)] = np.where(whole, np.exp(sums / np.maximum(counts, 1)), np.nan)
    return across, up, maps


def depth_of(depth: Depth, name: str = "depth") -> npt.NDArray[np.float32]:
    """Returns a depth plane [m], (H, W)."""
    plane = depth.depth_m if isinstance(depth, DepthImage) else depth
    if plane is None:
        raise ValueError(f"{name}: got a DepthImage without depth_m; needs one with it")
    return np.asarray(_check.real_array(plane, name, "(H, W)"), np.float32)


def named_depths(depths: Any) -> dict[str, npt.NDArray[np.float32]]:
    """Returns one or more depth maps by name."""
    listed = depths if isinstance(depths, dict) else {"depth": depths}
    if not listed:
        raise ValueError("depths: got none; needs at least one depth map")
    named = {str(name): depth_of(d, str(name)) for name, d in listed.items()}
    shapes = {d.shape for d in named.values()}
    if len(shapes) > 1:
        raise ValueError(f"depths: got shapes {sorted(shapes)}; needs one shape")
    return named


def is_signed(named: dict[str, npt.NDArray[np.float32]]) -> bool:
    """Returns True for differences of depths, which have negative values."""
    return any(bool(np.any(plane < 0)) for plane in named.values())

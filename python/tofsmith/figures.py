# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""The figures of the HTML reports, for notebooks and files.

Examples
--------
>>> figure = waveforms("hamiltonian-k4", "paper-10f0")
>>> figure.document["kind"]
'lines'
"""

from __future__ import annotations

import html
import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _check, _tofsmith
from ._camera import CameraLike, camera_of
from ._camera_fields import Lens
from ._code import CodeLike, code_of
from ._figure_data import (
    Depth,
    Reports,
    code_and_camera,
    depth_of,
    error_curve,
    error_grid,
    is_signed,
    kind_of,
    named_depths,
    reports_of,
    sweep_maps,
)
from ._scene import points_m
from ._sweep import SweepResults

@dataclass(frozen=True)
class Figure:
    """A figure as a self-contained HTML page, displayed by notebooks."""

    page: str

    @property
    def document(self) -> dict[str, Any]:
        """Data of the figure: values, axes and units."""
        text = self.page.partition('id="document">')[2].partition("</script>")[0]
        return json.loads(text)["sections"][0]["blocks"][0]

    def save(self, path: Union[str, Path]) -> None:
        """Writes the page to a file."""
        Path(path).write_text(self.page, encoding="utf-8")

    def _repr_html_(self) -> str:
        return (f'<iframe srcdoc="{html.escape(self.page)}" '
                'style="border:0;width:100%;height:32rem"></iframe>')


def waveforms(code: CodeLike, camera: CameraLike) -> Figure:
    """Shows modulation, demodulation and correlation function of every measurement."""
    fitted, camera = code_and_camera(code, camera)
    return Figure(_tofsmith.waveform_figure(fitted.name, fitted._handle, camera._handle))


def coding_curve(codes: Union[CodeLike, Sequence[CodeLike]], camera: CameraLike) -> Figure:
    """Shows the coding curves of codes in three dimensions, coloured by depth."""
    camera = camera_of(camera)
    listed = list(codes) if isinstance(codes, (list, tuple)) else [codes]
    if not listed:
        raise ValueError("codes: got none; needs at least one code")
    handles = [code_of(code, camera)._handle for code in listed]
    return Figure(_tofsmith.coding_curve_figure("Coding curve", handles, camera._handle))


def depth_error_map(reports: Reports, *, kind: Optional[str] = None) -> Figure:
    """Shows the mean depth error at every operating point, one panel per code. `kind`: linear or
    circular; None: that of the first report's camera."""
    listed = reports_of(reports)
    kind = kind_of(listed, kind)
    signal, ambient, _, _ = error_grid(listed[0], kind)
    maps = [error_grid(report, kind)[2] for report in listed]
    names = [report.code for report in listed]
    x_ticks, y_ticks = [f"{a:.3g}" for a in ambient], [f"{s:.3g}" for s in signal]
    return Figure(_tofsmith.heat_map_figure("Depth error", names, maps, x_ticks, y_ticks, "ambient",
                                             "signal", "e/s"))


def depth_error_curves(
    reports: Reports,
    *,
    along: str = "signal",
    at: Optional[float] = None,
    kind: Optional[str] = None,
) -> Figure:
    """Shows the mean depth error along signal or ambient light, with the other light at the level
    nearest to `at`. `kind`: linear or circular; None: that of the first report's camera."""
    listed = reports_of(reports)
    kind = kind_of(listed, kind)
    curves = [(r.code, *error_curve(r, kind, along, at)) for r in listed]
    return Figure(
        _tofsmith.curve_figure(
            "Depth error",
            [c[0] for c in curves],
            [[float(x) for x in c[1]] for c in curves],
            [[float(x) for x in c[2]] for c in curves],
            [[float(x) for x in c[3]] for c in curves],
            along,
            "e/s",
        )
    )


def sweep_map(results: SweepResults, x: str, y: str, *, kind: str = "linear") -> Figure:
    """Shows the mean depth error [mm] over two numeric columns of a sweep: geometric means over the
    other columns, one panel per code."""
    across, up, maps = sweep_maps(results, x, y, kind)
    x_ticks, y_ticks = [f"{v:.4g}" for v in across], [f"{v:.4g}" for v in up]
    errors_m = [np.asarray(values_mm / 1e3, np.float64) for values_mm in maps.values()]
    return Figure(_tofsmith.heat_map_figure("Depth error", list(maps), errors_m, x_ticks, y_ticks,
                                             x, y, ""))


def depth_maps(depths: Union[Depth, dict[str, Depth]]) -> Figure:
    """Shows one depth map, or several of equal shape by name. Differences of depths (with negative
    values) have a diverging scale centred at zero."""
    named = named_depths(depths)
    title = "Depth difference" if is_signed(named) else "Depth"
    return Figure(_tofsmith.image_figure(title, list(named), list(named.values()), is_signed(named)))


def point_cloud(
    depth: Depth, lens: Lens, values: Optional[npt.ArrayLike] = None, *, label: str = "depth"
) -> Figure:
    """Shows points in the camera's frame, coloured by radial distance or by `values` (H, W)."""
    radial_m = depth_of(depth)
    points = points_m(radial_m, lens).reshape(-1, 3)
    plane = radial_m if values is None else _check.real_array(values, "values", "(H, W)")
    if plane.shape != radial_m.shape:
        raise ValueError(f"values: got shape {plane.shape}; needs {radial_m.shape} as of depth")
    colours = np.asarray(plane, np.float32).reshape(-1)
    unit = "m" if values is None else ""
    return Figure(_tofsmith.point_cloud_figure("Point cloud", points, colours, label, unit))

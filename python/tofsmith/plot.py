# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Figures for papers, one line each (matplotlib, imported when the first is drawn).

Every function draws on a new figure, or on `figure`, and returns it:

>>> from tofsmith import plot
>>> plot.waveforms("hamiltonian-k4", "paper-10f0").savefig("code.pdf")  # doctest: +SKIP

Sizes suit one or two columns of a paper, fonts 8 pt, colours those of Okabe and Ito, which read
with any colour vision; maps are viridis. (Some publishers want
matplotlib.rcParams["pdf.fonttype"] = 42.)
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Optional, TypeVar, Union

import numpy as np
import numpy.typing as npt

from . import _check
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
    named_depths,
    reports_of,
)
from ._forward_model import ForwardModel, coding_curve_in_space
from ._scene import points_m

if TYPE_CHECKING:
    from matplotlib.figure import Figure
else:
    Figure = Any

_colours = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
_style = {
    "font.size": 8,
    "axes.titlesize": 8,
    "axes.labelsize": 8,
    "legend.fontsize": 7,
    "xtick.labelsize": 7,
    "ytick.labelsize": 7,
    "axes.linewidth": 0.6,
    "lines.linewidth": 1.2,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "legend.frameon": False,
    "figure.dpi": 200,
}
_column_in = 3.4
_page_in = 7.0

Draw = TypeVar("Draw", bound=Callable[..., Any])


def _styled(draw: Draw) -> Draw:
    """The function, with figures in our style and the user's as it was."""
    from functools import wraps

    @wraps(draw)
    def styled(*arguments: Any, **keywords: Any) -> Any:
        import matplotlib

        with matplotlib.rc_context(_style):
            figure = draw(*arguments, **keywords)
            figure.draw_without_rendering()  # ticks are made now, in our style
            return figure

    return styled  # type: ignore[return-value]


def _new(figure: Optional[Figure], width_in: float, height_in: float) -> Figure:
    if figure is not None:
        return figure
    import matplotlib.pyplot as plt

    return plt.figure(figsize=(width_in, height_in), constrained_layout=True)


@_styled
def waveforms(
    code: CodeLike, camera: CameraLike, *, figure: Optional[Figure] = None
) -> Figure:
    """Modulation, demodulation and correlation function of every measurement, a row each."""
    played, camera = code_and_camera(code, camera)
    model = ForwardModel(played, camera)
    modulation, demodulation = played.modulation, played.demodulation
    rows = played.measurements
    figure = _new(figure, _page_in, 0.5 + 0.75 * rows)
    axes = figure.subplots(rows, 3, squeeze=False, sharex="col", sharey="col")
    edges = np.arange(played.samples + 1) / played.samples
    depth_m = np.arange(played.samples) * camera.bin_m
    chi = model.correlation_table() if model.measurements == rows else None
    for i in range(rows):
        axes[i, 0].stairs(modulation[:, i // played.taps], edges, color=_colours[0], lw=1.2)
        axes[i, 1].stairs(demodulation[:, i], edges, color=_colours[1], lw=1.2)
        if chi is not None:
            axes[i, 2].plot(depth_m, chi[:, i], color=_colours[2])
        axes[i, 0].set_ylabel(f"{i + 1}")
    if chi is None:  # differences: fewer than there are taps
        _curves_in_one(axes[:, 2], depth_m, model.correlation_table())
    for axis, title in zip(axes[0], ("modulation m", "demodulation d", r"correlation $\chi$")):
        axis.set_title(title)
    for axis, label in zip(axes[-1], ("time (periods)", "time (periods)", "depth (m)")):
        axis.set_xlabel(label)
    return figure


def _curves_in_one(column: Any, depth_m: Any, chi: Any) -> None:
    for axis, values in zip(column, chi.T):
        axis.plot(depth_m, values, color=_colours[2])
    for axis in column[chi.shape[1] :]:
        axis.axis("off")


@_styled
def correlation_functions(
    code: CodeLike, camera: CameraLike, *, figure: Optional[Figure] = None
) -> Figure:
    """The K correlation functions over depth, behind the camera's impulse responses."""
    played, camera = code_and_camera(code, camera)
    chi = ForwardModel(played, camera).correlation_table()
    figure = _new(figure, _column_in, 2.2)
    axis = figure.subplots()
    depth_m = np.arange(len(chi)) * camera.range_m / len(chi)
    for i, values in enumerate(chi.T):
        dash = ("-", "--", ":", "-.")[i // len(_colours) % 4]
        axis.plot(depth_m, values, dash, color=_colours[i % len(_colours)], label=f"{i + 1}")
    axis.set(xlabel="depth (m)", ylabel=r"correlation $\chi$", title=played.name)
    axis.set_xlim(0, camera.range_m)
    axis.legend(ncol=2, title="measurement", title_fontsize=7)
    return figure


@_styled
def coding_curve(
    codes: Union[CodeLike, Sequence[CodeLike]],
    camera: CameraLike,
    *,
    figure: Optional[Figure] = None,
) -> Figure:
    """Coding curves in their three directions of largest extent, coloured by depth."""
    from mpl_toolkits.mplot3d.art3d import Line3DCollection

    camera = camera_of(camera)
    listed = list(codes) if isinstance(codes, (list, tuple)) else [codes]
    if not listed:
        raise ValueError("codes: got none; needs at least one code")
    figure = _new(figure, _column_in * min(len(listed), 2) + 0.4, 2.8 * ((len(listed) + 1) // 2))
    for i, one in enumerate(listed):
        played = code_of(one, camera)
        curve = coding_curve_in_space(ForwardModel(played, camera).correlation_table())
        closed = np.vstack([curve, curve[:1]])
        axis = figure.add_subplot(
            (len(listed) + 1) // 2, min(len(listed), 2), i + 1, projection="3d"
        )
        lines = Line3DCollection(np.stack([closed[:-1], closed[1:]], axis=1), cmap="viridis")
        lines.set_array(np.arange(len(curve)) * camera.range_m / len(curve))
        axis.add_collection(lines)
        reach = 1.05 * np.abs(curve).max()
        axis.set(xlim=(-reach, reach), ylim=(-reach, reach), zlim=(-reach, reach))
        axis.set(title=played.name, xticklabels=[], yticklabels=[], zticklabels=[])
        axis.set_box_aspect((1, 1, 1))
        figure.colorbar(lines, ax=axis, label="depth (m)", shrink=0.6, pad=0.02)
    return figure


@_styled
def depth_error_map(
    reports: Reports, *, kind: str = "linear", figure: Optional[Figure] = None
) -> Figure:
    """Mean depth error [mm] at every operating point, a panel per code, one colour scale."""
    from matplotlib.colors import LogNorm

    listed = reports_of(reports)
    grids = [error_grid(report, kind) for report in listed]
    values_mm = [1e3 * grid[2] for grid in grids]
    lowest = min(np.nanmin(np.maximum(v, 1e-6)) for v in values_mm)
    highest = max(np.nanmax(v) for v in values_mm)
    norm = LogNorm(lowest, max(highest, 1.001 * lowest))
    columns = min(len(listed), 3)
    rows = -(-len(listed) // columns)
    figure = _new(figure, 0.8 + 2.1 * columns, 0.3 + 1.9 * rows)
    axes = figure.subplots(rows, columns, squeeze=False, sharex=True, sharey=True)
    picture = None
    for axis, report, (signal, ambient, _), v in zip(axes.flat, listed, grids, values_mm):
        picture = axis.imshow(v, origin="lower", norm=norm, aspect="auto")
        axis.set_title(report.code)
        axis.set_xticks(range(len(ambient)), [f"{a:.0e}" for a in ambient], rotation=45)
        axis.set_yticks(range(len(signal)), [f"{s:.0e}" for s in signal])
        for (row, column), value in np.ndenumerate(v):
            dark = norm(value) < 0.6
            axis.text(column, row, f"{value:.2g}", ha="center", va="center", fontsize=6,
                      color="white" if dark else "black")
    for axis in axes.flat[len(listed) :]:
        axis.axis("off")
    figure.supxlabel("ambient light (e/s)", fontsize=8)
    figure.supylabel("signal (e/s)", fontsize=8)
    figure.colorbar(picture, ax=axes, label=f"mean depth error, {kind} (mm)")
    return figure


@_styled
def depth_error_curves(
    reports: Reports,
    *,
    along: str = "signal",
    at: Optional[float] = None,
    kind: str = "linear",
    figure: Optional[Figure] = None,
) -> Figure:
    """Mean depth error along signal or ambient light, with standard errors; the other light at the
    level nearest `at` (the middle unless given). Dotted grey: the bound of any code."""
    figure = _new(figure, _column_in, 2.6)
    axis = figure.subplots()
    bounds: dict[bytes, Any] = {}
    level = 0.0
    for i, report in enumerate(reports_of(reports)):
        x, mde, se, bound, level = error_curve(report, kind, along, at)
        colour = _colours[i % len(_colours)]
        axis.errorbar(x, 1e3 * mde, 1e3 * se, marker="o", ms=2.5, color=colour, label=report.code)
        bounds[bound.tobytes()] = (x, bound)
    for i, (x, bound) in enumerate(bounds.values()):
        if (bound > 0).any():
            axis.plot(x, 1e3 * bound, ":", color="0.5", label=None if i else "bound of any code")
    other = "ambient light" if along == "signal" else "signal"
    axis.set(xscale="log", yscale="log", ylabel=f"mean depth error, {kind} (mm)")
    axis.set(xlabel=f"{'signal' if along == 'signal' else 'ambient light'} (e/s)")
    axis.set_title(f"{other} {level:.3g} e/s")
    axis.grid(True, which="major", lw=0.3, color="0.85")
    axis.legend()
    return figure


@_styled
def depth_maps(
    depths: Union[Depth, dict[str, Depth]], *, figure: Optional[Figure] = None
) -> Figure:
    """Depth maps side by side with one colour scale: one, or several of one shape by name. Pixels
    without depth are grey."""
    named = named_depths(depths)
    shown = np.concatenate([d[np.isfinite(d)] for d in named.values()])
    low, high = np.percentile(shown, (0.5, 99.5)) if shown.size else (0.0, 1.0)
    columns = min(len(named), 3)
    rows = -(-len(named) // columns)
    height, width = next(iter(named.values())).shape
    panel_in = (_page_in - 0.8) / 3 if len(named) > 1 else _column_in - 0.8
    figure = _new(figure, 0.8 + panel_in * columns, 0.3 + panel_in * height / width * rows)
    axes = figure.subplots(rows, columns, squeeze=False)
    picture = None
    for axis, (name, depth) in zip(axes.flat, named.items()):
        axis.set_facecolor("0.8")
        picture = axis.imshow(depth, vmin=low, vmax=high, interpolation="nearest")
        axis.set(title=name, xticks=[], yticks=[])
    for axis in axes.flat[len(named) :]:
        axis.axis("off")
    figure.colorbar(picture, ax=axes, label="depth (m)", shrink=0.8)
    return figure


@_styled
def point_cloud(
    depth: Depth,
    lens: Lens,
    values: Optional[npt.ArrayLike] = None,
    *,
    label: str = "distance (m)",
    most_points: int = 20000,
    figure: Optional[Figure] = None,
) -> Figure:
    """Points in the camera's frame, coloured by radial distance or by `values` (H, W); of more
    than `most_points`, every n-th is drawn."""
    radial_m = depth_of(depth)
    colours = radial_m if values is None else _check.real_array(values, "values", "(H, W)")
    if colours.shape != radial_m.shape:
        raise ValueError(f"values: got shape {colours.shape}; needs {radial_m.shape} as of depth")
    points = points_m(radial_m, lens).reshape(-1, 3)
    kept = np.flatnonzero(np.isfinite(points).all(axis=1) & np.isfinite(colours.reshape(-1)))
    kept = kept[:: max(1, -(-len(kept) // _check.whole(most_points, "most_points", 1)))]
    x, y, z = points[kept].T
    figure = _new(figure, _column_in + 0.6, 3.2)
    axis = figure.add_subplot(projection="3d")
    cloud = axis.scatter(x, z, -y, c=colours.reshape(-1)[kept], s=0.6, lw=0, cmap="viridis")
    if len(kept):
        axis.set_box_aspect([max(float(np.ptp(v)), 1e-3) for v in (x, z, y)])
    axis.set(xlabel="x (m)", ylabel="z (m)", zlabel="-y (m)")
    axis.view_init(elev=18, azim=-70)
    figure.colorbar(cloud, ax=axis, label=label, shrink=0.6, pad=0.1)
    return figure

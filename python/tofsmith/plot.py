# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Figures for papers with matplotlib, which is imported on first use.

Every function draws on a new figure, or on `figure`, and returns it:

>>> from tofsmith import plot
>>> plot.waveforms("hamiltonian-k4", "paper-10f0").savefig("code.pdf")  # doctest: +SKIP

With `width="column"` or `width="page"`, figures are 3.5 or 7.16 in wide, as one or two columns of a
paper (default: a width that suits the contents). Fonts have 8 pt. The palette of Okabe and Ito is
distinguishable with any colour vision; maps use viridis. Some publishers require
matplotlib.rcParams["pdf.fonttype"] = 42.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _check
from ._camera import CameraLike, camera_of
from ._camera_fields import Lens
from ._check import FloatArray
from ._code import CodeLike, code_of
from ._figure_data import (
    Depth,
    Reports,
    code_and_camera,
    depth_of,
    error_curve,
    error_grid,
    error_range,
    kind_of,
    named_depths,
    reports_of,
    sweep_maps,
)
from ._forward_model import ForwardModel, coding_curve_in_space
from ._plot_style import (
    Width,
    colours,
    column_in,
    draw_depth_maps,
    grid,
    log_ticks_in_plain_numbers,
    new_figure,
    page_in,
    short,
    styled,
    ten_to,
    ticked,
)
from ._scene import points_m
from ._sweep import SweepResults
from ._waveform import Waveform

if TYPE_CHECKING:
    from matplotlib.figure import Figure
else:
    Figure = Any

__all__ = [
    "coding_curve",
    "correlation_functions",
    "depth_error_curves",
    "depth_error_map",
    "depth_maps",
    "point_cloud",
    "sweep_map",
    "waveforms",
]


def __dir__() -> list[str]:
    """Lists public names only."""
    return list(__all__)


@styled
def waveforms(
    code: CodeLike, camera: CameraLike, *, width: Optional[Width] = None,
    figure: Optional[Figure] = None
) -> Figure:
    """Shows modulation, demodulation and correlation function of every measurement, one per row."""
    fitted, camera = code_and_camera(code, camera)
    model = ForwardModel(fitted, camera)
    modulation, demodulation = fitted.modulation_waveforms(), fitted.demodulation_waveforms()
    rows = fitted.measurements
    figure = new_figure(figure, page_in, 0.5 + 0.75 * rows, width=width)
    axes = figure.subplots(rows, 3, squeeze=False, sharex="col", sharey="col")
    depth_m = np.arange(fitted.samples) * camera.bin_m
    chi = model.correlation_table() if model.measurements == rows else None
    for i in range(rows):
        axes[i, 0].stairs(*_steps(modulation[i // fitted.taps]), color=colours[0], lw=1.2)
        axes[i, 1].stairs(*_steps(demodulation[i]), color=colours[1], lw=1.2)
        if chi is not None:
            axes[i, 2].plot(depth_m, chi[:, i], color=colours[2])
        axes[i, 0].set_ylabel(f"{i + 1}")
    if chi is None:  # differences are fewer than the taps
        _curves_in_one(axes[:, 2], depth_m, model.correlation_table())
    for axis, title in zip(axes[0], ("modulation m", "demodulation d", r"correlation $\chi$")):
        axis.set_title(title)
    for axis, label in zip(axes[-1], ("time (periods)", "time (periods)", "depth (m)")):
        axis.set_xlabel(label)
    return figure


def _steps(waveform: Waveform) -> tuple[FloatArray, FloatArray]:
    """Returns the values of a waveform and their limits in time [periods], for binary waveforms
    from the switching times instead of cell averages."""
    if not waveform.is_binary:
        samples = waveform.samples
        if not len(samples):  # cosines
            samples = waveform.cell_averages(100 * len(waveform.coefficients))
        return samples, np.arange(len(samples) + 1) / len(samples)
    on = waveform.on_intervals
    over = on[on[:, 1] > 1]  # wraps around the end of the period
    wrapped = np.stack([np.zeros(len(over)), over[:, 1] - 1], 1)
    times = np.concatenate([wrapped, np.minimum(on, 1)]).ravel()
    values = np.zeros(len(times) + 1)
    values[1::2] = waveform.level
    return values, np.concatenate([[0.0], times, [1.0]])


def _curves_in_one(column: Any, depth_m: Any, chi: Any) -> None:
    for axis, values in zip(column, chi.T):
        axis.plot(depth_m, values, color=colours[2])
    for axis in column[chi.shape[1] :]:
        axis.axis("off")
    last = column[min(chi.shape[1], len(column)) - 1]
    last.set_xlabel("depth (m)")
    last.tick_params(labelbottom=True)


@styled
def correlation_functions(
    code: CodeLike, camera: CameraLike, *, width: Optional[Width] = None,
    figure: Optional[Figure] = None
) -> Figure:
    """Shows the K correlation functions over depth, including the camera's impulse responses."""
    fitted, camera = code_and_camera(code, camera)
    chi = ForwardModel(fitted, camera).correlation_table()
    figure = new_figure(figure, column_in, 2.2, width=width)
    axis = figure.subplots()
    depth_m = np.linspace(0, camera.range_m, len(chi) + 1)
    for i, values in enumerate(np.vstack([chi, chi[:1]]).T):
        dash = ("-", "--", ":", "-.")[i // len(colours) % 4]
        axis.plot(depth_m, values, dash, color=colours[i % len(colours)], label=f"{i + 1}")
    axis.set(xlabel="depth (m)", ylabel=r"correlation $\chi$")
    axis.set_xlim(0, camera.range_m)
    axis.legend(loc="lower left", bbox_to_anchor=(0, 1), ncol=min(chi.shape[1], 8),
                columnspacing=1.0, handlelength=1.2, borderaxespad=0.3, title=fitted.name,
                alignment="left")
    return figure


@styled
def coding_curve(
    codes: Union[CodeLike, Sequence[CodeLike]],
    camera: CameraLike,
    *,
    width: Optional[Width] = None,
    figure: Optional[Figure] = None,
) -> Figure:
    """Shows coding curves in their three principal directions, coloured by depth."""
    from mpl_toolkits.mplot3d.art3d import Line3DCollection

    camera = camera_of(camera)
    listed = list(codes) if isinstance(codes, (list, tuple)) else [codes]
    if not listed:
        raise ValueError("codes: got none; needs at least one code")
    rows, columns = grid(len(listed))
    figure = new_figure(figure, 2.4 * columns + 0.8, 2.3 * rows,
                        (0.01, 0.02, 0.97, 0.92, 0.02, 0.15), width, True)
    lines = None
    for i, one in enumerate(listed):
        fitted = code_of(one, camera)
        curve = coding_curve_in_space(ForwardModel(fitted, camera).correlation_table())
        closed = np.vstack([curve, curve[:1]])
        axis = figure.add_subplot(rows, columns, i + 1, projection="3d")
        lines = Line3DCollection(np.stack([closed[:-1], closed[1:]], axis=1), cmap="viridis")
        lines.set_array(np.arange(len(curve)) * camera.range_m / len(curve))
        axis.add_collection(lines)
        reach = 1.05 * np.abs(curve).max()
        axis.set(xlim=(-reach, reach), ylim=(-reach, reach), zlim=(-reach, reach))
        axis.set(title=fitted.name, xticklabels=[], yticklabels=[], zticklabels=[])
        axis.set_box_aspect((1, 1, 1))
        for of_space in (axis.xaxis, axis.yaxis, axis.zaxis):
            of_space.set_tick_params(length=0)
            of_space._axinfo["grid"].update(linewidth=0.4, color="0.85")
            of_space._axinfo["tick"].update(inward_factor=0, outward_factor=0)
    figure.colorbar(lines, ax=figure.axes, label="depth (m)", shrink=0.7, pad=0.03)
    return figure


@styled
def depth_error_map(
    reports: Reports, *, kind: Optional[str] = None, width: Optional[Width] = None,
    figure: Optional[Figure] = None
) -> Figure:
    """Shows the mean depth error [mm] and its standard error at every operating point, one panel
    per code, with one colour scale. `kind`: linear or circular; None: that of the first report's
    camera."""
    from matplotlib.colors import LogNorm

    listed = reports_of(reports)
    kind = kind_of(listed, kind)
    grids = [error_grid(report, kind) for report in listed]
    values_mm = [1e3 * grid[2] for grid in grids]
    lowest = min(float(np.nanmin(np.maximum(v, 1e-6))) for v in values_mm)
    highest = max(float(np.nanmax(v)) for v in values_mm)
    norm = LogNorm(lowest, max(highest, 1.001 * lowest))
    rows, columns = grid(len(listed))
    figure = new_figure(figure, 0.9 + 1.9 * columns, 0.5 + 1.7 * rows, width=width)
    axes = figure.subplots(rows, columns, squeeze=False, sharex=True, sharey=True)
    picture = None
    for axis, report, (signal, ambient, _, error_m), v in zip(
        axes.flat, listed, grids, values_mm
    ):
        picture = axis.imshow(v, origin="lower", norm=norm, aspect="auto")
        axis.set_title(report.code)
        axis.set_xticks(range(len(ambient)), [ten_to(a) for a in ambient], rotation=45)
        axis.set_yticks(range(len(signal)), [ten_to(s) for s in signal])
        axis.tick_params(length=0)
        for (row, column), value in np.ndenumerate(v):
            dark = norm(value) < 0.6
            shown = short(float(value))
            if np.isfinite(error_m[row, column]):
                shown += f"\n± {short(1e3 * float(error_m[row, column]))}"
            axis.text(column, row, shown, ha="center", va="center", fontsize=5, linespacing=1.0,
                      color="white" if dark else "black")
    for axis in axes.flat[len(listed) :]:
        axis.axis("off")
    for axis in axes.flat[len(listed) - columns : len(listed)]:
        axis.tick_params(labelbottom=True)  # nothing is drawn below
    figure.supxlabel("ambient light (e/s)", fontsize=8)
    figure.supylabel("signal (e/s)", fontsize=8)
    figure.colorbar(picture, ax=axes, label=f"mean depth error, {kind} (mm)")
    return figure


@styled
def depth_error_curves(
    reports: Reports,
    *,
    along: str = "signal",
    at: Optional[float] = None,
    kind: Optional[str] = None,
    width: Optional[Width] = None,
    figure: Optional[Figure] = None,
) -> Figure:
    """Shows the mean depth error along signal or ambient light, with standard errors; the other
    light is at the level nearest to `at` (default: the middle level). Grey lines are bounds
    for any code; codes with the same bound share a line. `kind`: linear or circular; None: as in
    the first report's camera."""
    listed = reports_of(reports)
    kind = kind_of(listed, kind)
    longest = max(len("bound of any code"), *(len(report.code) for report in listed))
    narrow = width == "column"  # the legend is then above the axes, otherwise next to them
    height_in = 2.4 + (0.15 * (len(listed) + 1) if narrow else 0.0)
    figure = new_figure(figure, column_in + 0.4 + 0.055 * longest, height_in, width=width)
    axis = figure.subplots()
    bounds: dict[bytes, Any] = {}
    bounded: dict[bytes, list[str]] = {}
    level = 0.0
    for i, report in enumerate(listed):
        x, mde, se, bound, level = error_curve(report, kind, along, at)
        colour = colours[i % len(colours)]
        dash = ("-", "--", ":", "-.")[i // len(colours) % 4]
        axis.errorbar(x, 1e3 * mde, 1e3 * se, marker="o", ms=2.5, ls=dash, color=colour,
                      label=report.code)
        if (bound > 0).any():
            bounds[bound.tobytes()] = (x, bound)
            bounded.setdefault(bound.tobytes(), []).append(report.code)
    for i, (key, (x, bound)) in enumerate(bounds.items()):
        label = "bound of any code"
        if len(bounds) > 1:  # bounds depend on the number of exposures and on the camera
            label = "bound for " + ", ".join(bounded[key])
        dash = (":", "-.", "--")[i % 3]
        axis.plot(x, 1e3 * bound, dash, color="0.5", lw=1.0, label=label)
    names = ("signal", "ambient light")
    varied, other = names if along == "signal" else names[::-1]
    axis.set(xscale="log", yscale="log", ylabel=f"mean depth error, {kind} (mm)")
    axis.set(xlabel=f"{varied} (e/s), at {other} {ten_to(level)} e/s")
    log_ticks_in_plain_numbers(axis.yaxis)
    axis.grid(True, which="major", lw=0.3, color="0.85")
    axis.legend(loc="lower left" if narrow else "upper left",
                bbox_to_anchor=(0, 1) if narrow else (1, 1), handlelength=1.6)
    return figure


@styled
def sweep_map(
    results: SweepResults,
    x: str,
    y: str,
    *,
    kind: str = "linear",
    width: Optional[Width] = None,
    figure: Optional[Figure] = None,
) -> Figure:
    """Shows the mean depth error [mm] over two numeric columns of a sweep, such as
    "light.peak_factor" and "signal_e_per_s": geometric means over the other columns, one panel per
    code, with one colour scale. Unfinished cells are white."""
    from matplotlib.colors import LogNorm

    across, up, maps = sweep_maps(results, x, y, kind)
    norm = LogNorm(*error_range([m for m in maps.values()]))
    rows, columns = grid(len(maps))
    figure = new_figure(figure, 0.9 + 1.9 * columns, 0.5 + 1.7 * rows, width=width)
    axes = figure.subplots(rows, columns, squeeze=False, sharex=True, sharey=True)
    picture = None
    for axis, (code, values_mm) in zip(axes.flat, maps.items()):
        picture = axis.imshow(values_mm, origin="lower", norm=norm, aspect="auto")
        axis.set_title(code)
        axis.set_xticks(range(len(across)), [ticked(v) for v in across], rotation=45)
        axis.set_yticks(range(len(up)), [ticked(v) for v in up])
        axis.tick_params(length=0)
        if values_mm.size <= 64:
            for (row, column), value in np.ndenumerate(values_mm):
                if np.isfinite(value):
                    axis.text(column, row, short(float(value)), ha="center", va="center",
                              fontsize=6, color="white" if norm(value) < 0.6 else "black")
    for axis in axes.flat[len(maps) :]:
        axis.axis("off")
    for axis in axes.flat[len(maps) - columns : len(maps)]:
        axis.tick_params(labelbottom=True)  # nothing is drawn below
    figure.supxlabel(x, fontsize=8)
    figure.supylabel(y, fontsize=8)
    figure.colorbar(picture, ax=axes, label=f"mean depth error, {kind} (mm)")
    return figure


@styled
def depth_maps(
    depths: Union[Depth, dict[str, Depth]],
    *,
    range_m: Optional[tuple[float, float]] = None,
    columns: Optional[int] = None,
    label: Optional[str] = None,
    width: Optional[Width] = None,
    figure: Optional[Figure] = None,
) -> Figure:
    """Shows one depth map, or several of equal shape by name, with one colour scale. Pixels without
    depth are grey. Differences of depths (with negative values) have a diverging scale centred at
    zero. `range_m`: limits of the colour scale; None: all but 1 % of the depths. `columns`: maps
    per row."""
    named = named_depths(depths)
    shown = named if isinstance(depths, dict) else {"": named["depth"]}
    return draw_depth_maps(shown, figure, range_m, columns, label, width)


@styled
def point_cloud(
    depth: Depth,
    lens: Lens,
    values: Optional[npt.ArrayLike] = None,
    *,
    label: str = "distance (m)",
    max_points: int = 20000,
    width: Optional[Width] = None,
    figure: Optional[Figure] = None,
) -> Figure:
    """Shows points in the camera's frame, coloured by radial distance or by `values` (H, W). If
    there are more than `max_points`, every n-th is drawn. The axes exclude the outermost 0.5 % of
    the points on either side."""
    radial_m = depth_of(depth)
    shown = radial_m if values is None else _check.real_array(values, "values", "(H, W)")
    if shown.shape != radial_m.shape:
        raise ValueError(f"values: got shape {shown.shape}; needs {radial_m.shape} as of depth")
    points = points_m(radial_m, lens).reshape(-1, 3)
    kept = np.flatnonzero(np.isfinite(points).all(axis=1) & np.isfinite(shown.reshape(-1)))
    kept = kept[:: max(1, -(-len(kept) // _check.whole(max_points, "max_points", 1)))]
    if len(kept):
        low, high = np.percentile(points[kept], (0.5, 99.5), axis=0)
        kept = kept[((points[kept] >= low) & (points[kept] <= high)).all(axis=1)]
    x, y, z = points[kept].T
    figure = new_figure(figure, column_in + 1.2, 3.2, (0.0, 0.06, 0.94, 1.0), width, True)
    axis = figure.add_subplot(projection="3d")
    cloud = axis.scatter(x, z, -y, c=shown.reshape(-1)[kept], s=0.6, lw=0, cmap="viridis")
    if len(kept):
        axis.set_box_aspect([max(float(np.ptp(v)), 1e-3) for v in (x, z, y)])
    axis.set(xlabel="right (m)", ylabel="ahead (m)", zlabel="up (m)")
    axis.view_init(elev=18, azim=-70)
    axis.locator_params(nbins=5)
    for of_space in (axis.xaxis, axis.yaxis, axis.zaxis):
        of_space._axinfo["grid"].update(linewidth=0.4, color="0.85")
    figure.colorbar(cloud, ax=axis, label=label, shrink=0.6, pad=0.2)
    return figure

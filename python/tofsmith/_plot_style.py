# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Style of the figures of tofsmith.plot."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Literal, Optional, TypeVar

import numpy as np

from . import _check

if TYPE_CHECKING:
    from matplotlib.figure import Figure
else:
    Figure = Any

colours = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
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
column_in = 3.5
page_in = 7.16
Width = Literal["column", "page"]

Draw = TypeVar("Draw", bound=Callable[..., Any])


def styled(draw: Draw) -> Draw:
    """Decorates a function to draw figures in our style and restore the user's style."""
    from functools import wraps

    @wraps(draw)
    def drawn(*arguments: Any, **keywords: Any) -> Any:
        import matplotlib

        with matplotlib.rc_context(_style):
            figure = draw(*arguments, **keywords)
            figure.draw_without_rendering()  # creates the ticks in our style
            return figure

    return drawn  # type: ignore[return-value]


def new_figure(
    figure: Optional[Figure],
    width_in: float,
    height_in: float,
    margins: Optional[tuple[float, ...]] = None,
    width: Optional[Width] = None,
    keeps_shape: bool = False,
) -> Figure:
    """Returns the given figure, or a new one of this size. `width` replaces the width of a new
    figure by one or two columns; with `keeps_shape`, the height is scaled by the same factor.
    Three-dimensional axes do not support the constrained layout and have explicit margins."""
    if width is not None:
        other_in = {"column": column_in, "page": page_in}[
            _check.one_of(width, "width", ("column", "page"))]
        height_in *= other_in / width_in if keeps_shape else 1.0
        width_in = other_in
    if figure is not None:
        return figure
    import matplotlib.pyplot as plt

    made = plt.figure(figsize=(width_in, height_in), constrained_layout=margins is None)
    if margins is not None:
        made.subplots_adjust(*margins)
    return made


def grid(panels: int) -> tuple[int, int]:
    """Returns the number of rows and of columns, at most three, for a full grid."""
    rows = -(-panels // 3)
    return rows, -(-panels // rows)


def ten_to(value: float) -> str:
    """Formats a number as 10^3 or 3 10^3."""
    if value <= 0:
        return f"{value:g}"
    exponent = int(np.floor(np.log10(value) + 1e-9))
    factor = value / 10.0**exponent
    power = rf"10^{{{exponent}}}"
    return f"${power}$" if abs(factor - 1) < 0.005 else rf"${factor:.2g}\cdot{power}$"


def ticked(value: float) -> str:
    """Formats a value as tick label of a map."""
    return f"{value:.4g}" if 1e-3 <= abs(value) < 1e4 or value == 0 else ten_to(value)


def log_ticks_in_plain_numbers(axis: Any) -> None:
    """Sets tick labels 1, 10, 100 instead of powers, and 2 and 5 for short axes."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    low, high = axis.get_view_interval()
    axis.set_major_locator(LogLocator(subs=(1, 2, 5) if high < 300 * low else (1,)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def short(value: float) -> str:
    """Formats two digits; integers from 10 on."""
    return f"{value:.2g}" if value < 10 else f"{value:.0f}"


def draw_depth_maps(
    depths_m: dict[str, Any],
    figure: Optional[Figure] = None,
    range_m: Optional[tuple[float, float]] = None,
    columns: Optional[int] = None,
    label: Optional[str] = None,
    width: Optional[Width] = None,
) -> Figure:
    """Draws named depth planes (H, W) next to each other with one colour scale; see
    plot.depth_maps(). Pixels without depth are grey. Differences of depths (with negative values)
    have a diverging scale."""
    shown = np.concatenate([d[np.isfinite(d)] for d in depths_m.values()])
    low, high = np.percentile(shown, (0.5, 99.5)) if shown.size else (0.0, 1.0)
    signed = bool(np.any(shown < 0))
    if signed:
        high = max(-low, high)
        low = -high
    low, high = (low, high) if range_m is None else range_m
    count = len(depths_m)
    rows, columns = grid(count) if columns is None else (-(-count // columns), columns)
    height_px, width_px = next(iter(depths_m.values())).shape
    panel_in = (page_in - 0.8) / max(3, columns) if count > 1 else column_in - 0.8
    height_in = 0.3 + panel_in * height_px / width_px * rows
    figure = new_figure(figure, 0.8 + panel_in * columns, height_in, width=width, keeps_shape=True)
    axes = figure.subplots(rows, columns, squeeze=False)
    picture = None
    for axis, (name, depth_m) in zip(axes.flat, depths_m.items()):
        axis.set_facecolor("0.8")
        picture = axis.imshow(depth_m, vmin=low, vmax=high, interpolation="nearest",
                              cmap="RdBu_r" if signed else None)
        axis.set(title=name, xticks=[], yticks=[])
        axis.spines[:].set_visible(False)
    for axis in axes.flat[count:]:
        axis.axis("off")
    if label is None:
        label = "depth difference (m)" if signed else "depth (m)"
    figure.colorbar(picture, ax=axes, label=label, extend="neither" if range_m is None else "both")
    return figure

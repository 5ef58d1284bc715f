# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Colours, names and sizes of all figures."""

from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

#: For matplotlib.rc_context().
style = {
    "font.size": 8, "axes.titlesize": 8, "legend.fontsize": 7, "lines.linewidth": 1.2,
    "axes.spines.top": False, "axes.spines.right": False, "pdf.fonttype": 42,
}

#: Colours of Okabe and Ito, which are distinguishable with any colour vision.
family_colours = {
    "hamiltonian-k3": "#56b4e9", "hamiltonian-k4": "#0072b2", "hamiltonian-k5": "#009e73",
    "hamiltonian-k6": "#000000", "pulsed-multifrequency": "#8a8f98", "multifrequency": "#cc79a7",
    "sinusoid": "#d55e00", "square": "#e69f00",
}


def colour_of(code: str) -> str:
    return next(colour for family, colour in family_colours.items() if code.startswith(family))


def short_name(code: str) -> str:
    """Returns the name of a code for small pictures."""
    if code.endswith("-redesigned"):
        return f"redesigned K = {code[len('hamiltonian-k')]}"
    return "sinusoid" if code.startswith("sinusoid") else "multi-frequency"


def new_figure(width_in: float, height_in: float, *shape: int, **options: Any) -> tuple[Figure, Any]:
    """Returns a figure and its axes, in rows and columns."""
    figure = Figure(figsize=(width_in, height_in), layout="constrained")
    return figure, figure.subplots(*shape, **options)


def legend_below(columns: int, *axes: Axes) -> None:
    """Adds one legend for the lines of some axes, below all axes of their figure."""
    figure = axes[0].figure
    entries = {label: handle for axis in axes
               for handle, label in zip(*axis.get_legend_handles_labels())}
    height = (0.1 + 0.16 * -(-len(entries) // columns)) / figure.get_figheight()
    figure.get_layout_engine().set(rect=(0, height, 1, 1 - height))
    figure.legend(entries.values(), entries, loc="lower center", ncol=columns, frameon=False)

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Notebook representation of objects: repr, and a figure if matplotlib is installed."""

from __future__ import annotations

import base64
import html
import io
from collections.abc import Callable
from typing import Any

import numpy as np

from ._plot_style import draw_depth_maps, new_figure, styled


def picture_of(value: object, draw: Callable[[], Any]) -> str:
    """Returns HTML with the repr of `value` and the matplotlib figure returned by `draw`; without
    matplotlib only the repr."""
    text = f"<code>{html.escape(repr(value))}</code>"
    try:
        figure = draw()
    except ImportError:  # no matplotlib
        return text
    data = io.BytesIO()
    figure.savefig(data, format="png", dpi=100)
    encoded = base64.b64encode(data.getvalue()).decode("ascii")
    name = html.escape(type(value).__name__)
    return f'{text}<br><img alt="{name}" src="data:image/png;base64,{encoded}">'


def depth_picture(value: object, depth_m: Any) -> str:
    """Returns HTML for depth (H, W) or (F, H, W), with the first frame."""
    if depth_m is None or not np.isfinite(depth_m).any() or min(np.shape(depth_m)) == 0:
        return f"<code>{html.escape(repr(value))}</code>"
    frame = depth_m if np.ndim(depth_m) == 2 else depth_m[0]
    depths_m = {"": np.asarray(frame, np.float32)}
    return picture_of(value, lambda: styled(draw_depth_maps)(depths_m))


def table_picture(value: object, correlation: Any, range_m: float) -> str:
    """Returns HTML for correlation functions over depth, (N, K)."""

    def draw() -> Any:
        figure = new_figure(None, 4.5, 2.2)
        axis = figure.subplots()
        depth_m = (np.arange(len(correlation)) + 0.5) * range_m / len(correlation)
        axis.plot(depth_m, correlation)
        axis.set(xlabel="depth (m)", ylabel="correlation function")
        return figure

    return picture_of(value, draw)


def camera_picture(value: object, frequency_hz: float, transfer: Any) -> str:
    """Returns HTML for a camera, with the transfer of each harmonic by both arms."""

    def draw() -> Any:
        figure = new_figure(None, 4.5, 2.0)
        axis = figure.subplots()
        axis.bar(1e-6 * frequency_hz * np.arange(len(transfer)), np.abs(transfer),
                 0.5e-6 * frequency_hz)
        axis.set(xlabel="harmonics of the fundamental frequency (MHz)", ylabel="let through",
                 ylim=(0, 1.05))
        return figure

    return picture_of(value, draw)


def code_picture(value: object, modulation: Any, demodulation: Any, taps: int) -> str:
    """Returns HTML for a code: modulation and demodulation of all taps, one exposure per row."""

    def draw() -> Any:
        samples, exposures = modulation.shape
        figure = new_figure(None, 4.5, 0.4 + 0.8 * exposures)
        axes = figure.subplots(exposures, 1, sharex=True, squeeze=False)[:, 0]
        periods = np.arange(samples) / samples
        for e, axis in enumerate(axes):
            light = modulation[:, e] / max(float(modulation.max()), 1e-300)
            axis.step(periods, light, where="post", label="light, of its peak")
            for tap in range(taps):
                axis.step(periods, demodulation[:, e * taps + tap], where="post",
                          label="sensor" if taps == 1 else f"tap {tap + 1}")
        axes[0].legend(loc="upper right")
        axes[-1].set_xlabel("period")
        return figure

    return picture_of(value, draw)

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Pairs of waveforms and their correlation functions, for Figs. 2, 3 and 6."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.figure import Figure

import tofsmith
from tofsmith import Camera, Factorization, Waveform

from ._style import colour_of, legend_below, new_figure

ZERO_RMS = 1e-6  # residuals below are rounding errors
POINTS = 480  # per period of a drawn curve


@dataclass(frozen=True)
class Pair:
    """Waveforms of one measurement, their camera, and the target (N,)."""

    modulation: Waveform
    demodulation: Waveform
    camera: Camera
    target: Any

    def outputs(self, points: int) -> list[Any]:
        """Returns the waveforms after the impulse responses of light and sensor, (points,) each."""
        return [tofsmith.arm_output(waveform, self.camera, arm=arm, points=points)
                for arm, waveform in (("light", self.modulation), ("sensor", self.demodulation))]

    def correlation(self, points: int) -> Any:
        """Returns the correlation function at equal steps of depth, (points,)."""
        code = tofsmith.CodeSet.from_waveforms(
            [self.modulation], [self.demodulation], samples=self.camera.samples)
        # Increase the peak of the camera, to include waveforms beyond its limit.
        camera = self.camera.replace(light={"peak_factor": max(1.0, 1.001 * self.modulation.peak)})
        return tofsmith.ForwardModel(code, camera).correlation_table(points)[:, 0]

    def residual_rms(self) -> float:
        """Returns the root mean square over depth of correlation function minus target, linear
        between bins."""
        n = len(self.target)
        target = np.interp(np.arange(8 * n) / 8, np.arange(n + 1), closed(self.target))
        return float(np.sqrt(np.mean((self.correlation(8 * n) - target) ** 2)))


def closed(values: Any) -> Any:
    """Appends the end point to a period."""
    return np.append(values, values[0])


def ideal_targets(family: str) -> Any:
    """Returns the correlation functions (N, K) of a family on a camera without limits."""
    camera = Camera("paper-30x", light={"peak_factor": 1000})
    return tofsmith.ForwardModel(family, camera).correlation_table()


def pair_of(found: Factorization, camera: Camera) -> Pair:
    """Returns the best waveforms of a factorization, with the longest pulse at half the period."""
    modulation, demodulation = found.best.modulation, found.best.demodulation
    intervals = modulation.on_intervals
    rise, fall = intervals[np.argmax(intervals[:, 1] - intervals[:, 0]), :]
    delay = 0.5 - 0.5 * float(rise + fall)
    return Pair(modulation.delayed(delay), demodulation.delayed(delay), camera, found.target)


def pair_panels(pairs: dict[str, Pair], code: str) -> Figure:
    """Plots one row per pair: nominal input (thin) and output (thick) of both arms, and the
    correlation function with its target (dotted)."""
    figure, axes = new_figure(7.2, 0.7 + 1.1 * len(pairs), len(pairs), 3, squeeze=False, sharex="col")
    for row, (title, pair) in zip(axes, pairs.items()):
        time_ns = np.linspace(0, 1e9 / pair.camera.fundamental_frequency_hz, POINTS + 1)
        is_limited = pair.camera.light.impulse_response.kind != "none"
        for axis, waveform, output in zip(
                row, (pair.modulation, pair.demodulation), pair.outputs(POINTS)):
            axis.stairs(waveform.cell_averages(POINTS), time_ns, label="input of the arm",
                        color=colour_of(code), linewidth=0.7 if is_limited else 1.3)
            if is_limited:
                axis.plot(time_ns, closed(output), label="output of the arm", color=colour_of(code))
        for curve, label, drawn in ((pair.correlation(POINTS), "correlation function", colour_of(code)),
                                    (pair.target, "target", "0.3")):
            depth_m = np.linspace(0, pair.camera.range_m, len(curve) + 1)
            row[2].plot(depth_m, closed(curve), ":" if label == "target" else "-", color=drawn, label=label)
        row[0].set_ylabel(title)
    for axis, title, last in zip(axes[0], ("modulation (mean power 1)", "demodulation (gain)",
                                            "correlation function"), axes[-1]):
        axis.set_title(title)
        last.set_xlabel("depth (m)" if title == "correlation function" else "time (ns)")
    legend_below(4, axes[-1, 0], axes[-1, 2])
    return figure

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Depth error over signal and ambient light, for Figs. 4 and 8."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

import tofsmith
from tofsmith import Camera, CodeSet, DepthErrorReport, plot

from ._study import FAILS, HOLDS, IN_PART, Study


@dataclass(frozen=True)
class Surface:
    """Mean depth error of a code at its best origin of depth; arrays are (signal, ambient)."""

    rotation_bin: int
    report: DepthErrorReport

    def grid(self, values: str) -> Any:
        """Returns values of the report, such as "linear_mde_m", over the light levels."""
        return getattr(self.report, values).reshape(len(self.signal), len(self.ambient))

    @property
    def signal(self) -> Any:
        return np.unique(self.report.signal_e_per_s)

    @property
    def ambient(self) -> Any:
        return np.unique(self.report.ambient_e_per_s)

    @property
    def mean_m(self) -> float:
        """Returns the geometric mean of the linear error over all light levels."""
        return self.report.linear.geometric_mean_m

    def by_signal(self) -> Any:
        """Returns the geometric mean over ambient light, (signal,)."""
        return np.exp(np.log(self.grid("linear_mde_m")).mean(axis=1))


#: Surfaces of one camera by the names of codes, and of several cameras.
Panel = dict[str, Surface]
Panels = dict[str, Panel]


def with_light_levels(study: Study, camera: Camera) -> Camera:
    """Returns the camera with the paper's 5 x 5 light levels (3 x 3 with --fast) and the linear
    error."""
    levels: Any = study.pick({}, {"signal_e_per_s": [10**3.5, 1e4, 1e5], "ambient_e_per_s": [1e2, 1e4, 1e5]})
    return camera.replace(operating=levels | {"error": "linear"})


def measure_surface(study: Study, code: CodeSet, camera: Camera, **trials: int) -> Surface:
    """Evaluates the depth error at the paper's light levels, to a relative standard error of 2 %."""
    counts: Any = study.pick({"trials": 8000, "max_trials": 50_000_000, "rotation_trials": 20000},
                        {"trials": 16000, "max_trials": 16000, "rotation_trials": 4000}) | trials
    camera = with_light_levels(study, camera)
    # 1. Find the best origin of depth, with other random numbers than in step 2.
    rotation, _ = tofsmith.best_rotation(code, camera, trials=counts.pop("rotation_trials"),
                                         seed=study.seed + 1)
    # 2. Evaluate with as many trials at every light level as the standard error requires.
    report = tofsmith.evaluate(code.rotated(rotation), camera, seed=study.seed + 2,
                               target_standard_error=study.pick(0.02, 0.1), **counts)
    return Surface(rotation, report)


@dataclass(frozen=True)
class Comparison:
    """Ratio of the errors of another code and of this code at all light levels, and the numbers of
    levels at which this code is better, tied (within two standard errors) and worse."""

    ratio: Any
    better: int
    tied: int
    worse: int

    @property
    def mean(self) -> float:
        return float(np.exp(np.log(self.ratio).mean()))

    @property
    def verdict(self) -> str:
        levels = self.ratio.size
        return HOLDS if self.better == levels else IN_PART if 2 * self.better > levels else FAILS

    def counts(self) -> str:
        return (f"better at {self.better} of {self.ratio.size} light levels, tied at {self.tied}, "
                f"worse at {self.worse}")

    def factors(self) -> str:
        return f"{self.ratio.min():.2f} to {self.ratio.max():.2f}"


def compare(ours: Surface, *others: Surface) -> Comparison:
    """Compares a code with the best of others at each light level."""
    errors, deviations = (np.stack([other.grid(values) for other in others])
                          for values in ("linear_mde_m", "linear_se_m"))
    best = errors.argmin(axis=0)[None]
    theirs, theirs_se = (np.take_along_axis(of_all, best, 0)[0] for of_all in (errors, deviations))
    error_m = ours.grid("linear_mde_m")
    gain, margin = theirs - error_m, 2 * np.hypot(theirs_se, ours.grid("linear_se_m"))
    better, worse = int((gain > margin).sum()), int((gain < -margin).sum())
    return Comparison(theirs / error_m, better, gain.size - better - worse, worse)


def together(comparisons: Sequence[Comparison]) -> Comparison:
    """Combines comparisons on several cameras."""
    return Comparison(np.concatenate([one.ratio.ravel() for one in comparisons]),
                      *(sum(getattr(one, count) for one in comparisons)
                        for count in ("better", "tied", "worse")))


def show_surfaces(study: Study, panels: Panels) -> None:
    """Draws for every camera maps of the linear error, and sections at an ambient light of 1e4 e/s.
    Writes a table with one row per camera, code and light level."""
    for title, panel in panels.items():
        reports = [surface.report for surface in panel.values()]
        name = title.replace(" ", "").replace(",", "-").replace("=", "")
        study.picture(f"map-{name}", plot.depth_error_map(reports),
                      f"{title}: linear mean depth error, each code at its best origin of depth.")
        study.picture(f"curves-{name}", plot.depth_error_curves(reports, at=1e4),
                      f"{title}: a cut at ambient light of 1e4 e/s.")
    columns = ("signal_e_per_s", "ambient_e_per_s", "linear_mde_m", "linear_se_m", "circular_mde_m")
    study.table("surfaces", [
        {"setting": title, "code": name, "rotation_bin": surface.rotation_bin}
        | dict(zip(columns, map(float, values)))
        for title, panel in panels.items() for name, surface in panel.items()
        for values in zip(*(getattr(surface.report, column) for column in columns))])


def mean_rows(panels: Panels, **setting: str) -> list[dict[str, Any]]:
    """Returns one row per camera and code: geometric means over all light levels, and named
    levels."""
    return [setting | {"setting": title, "code": name}
            | {kind + unit: getattr(surface.report.of(kind), "geometric_mean" + unit)
               for kind in ("linear", "circular") for unit in ("_m", "_se_m")}
            for title, panel in panels.items() for name, surface in panel.items()]

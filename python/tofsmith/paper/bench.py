# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Repeated measurements, for Figs. 7 and 9 to 11."""

from functools import lru_cache
from typing import Any

import numpy as np

import tofsmith
from tofsmith import Camera, CodeSet, Decoder, Scene

from ._study import Study
from .cameras import SCAN_POWER_MW, Light

BASELINES = ("sinusoid-k4", "multifrequency-k5")


def scanning_codes(study: Study) -> tuple[Camera, list[CodeSet]]:
    """Returns the prototype, the redesigned codes of K = 4 and 5, and both baselines."""
    camera = Camera("prototype")
    signals = [SCAN_POWER_MW * signal for signal in camera.operating.signal_e_per_s]
    camera = camera.replace(name="prototype-10mw", operating={"signal_e_per_s": signals})
    return camera, study.codes(camera, (4, 5), BASELINES)


decoder_of = lru_cache(maxsize=64)(Decoder)


def decoded_depths(scene: Scene, code: CodeSet, camera: Camera, light: Light, **options: Any) -> Any:
    """Captures a scene with options of capture() and decodes every frame: radial depth [m],
    (F, H, W). Uses all estimates, regardless of their status."""
    raw = tofsmith.capture(scene, code, camera, signal_e_per_s=light.signal_e_per_s,
                           ambient_e_per_s=light.ambient_e_per_s, **options)
    return decoder_of(code, camera).decode(raw, planes=["depth_m"]).depth_m


def emulate_range(
    code: CodeSet, camera: Camera, light: Light, *, target_m: float, shifts: int = 20,
    estimates: int = 300, seed: int = 1,
) -> Any:
    """Measures a static target with one pixel while the modulation is delayed in equal steps over
    its period, which emulates a target that moves over the whole range at constant light. Returns
    circular depth errors (shifts, estimates) [m]."""
    true_m = (target_m + camera.range_m * np.arange(shifts) / shifts) % camera.range_m
    scene = Scene(np.repeat(true_m[:, None], estimates, axis=1).astype(np.float32))
    decoded_m, = decoded_depths(scene, code, camera, light, frames=1, seed=seed, falloff=False)
    difference = np.abs(decoded_m - true_m[:, None])
    return np.minimum(difference, camera.range_m - difference)


class Plane:
    """Total least squares through points (n, 3) [m]."""

    def __init__(self, points: Any) -> None:
        self.point = points.mean(axis=0)
        self.normal = np.linalg.svd(points - self.point, full_matrices=False)[2][2]

    def distance_m(self, points: Any) -> Any:
        return np.abs((points - self.point) @ self.normal)

    def depth_m(self, directions: Any) -> Any:
        """Returns the radial depth of the plane along rays from the camera."""
        return (self.point @ self.normal) / (directions @ self.normal)


class Sphere:
    """Least squares of orthogonal distances of points (n, 3) [m]."""

    def __init__(self, points: Any) -> None:
        # Algebraic start |p|^2 = 2 c p + k about the mean, then Gauss-Newton.
        origin = points.mean(axis=0)
        p, ones = points - origin, np.ones((len(points), 1))
        *centre, k = np.linalg.lstsq(np.hstack([2 * p, ones]), (p**2).sum(axis=1), rcond=None)[0]
        centre, radius = np.array(centre), np.sqrt(k + np.dot(centre, centre))
        for _ in range(10):
            arm = p - centre
            length = np.linalg.norm(arm, axis=1)
            jacobian = np.hstack([arm / length[:, None], ones])
            step = np.linalg.lstsq(jacobian, length - radius, rcond=None)[0]
            centre, radius = centre + step[:3], radius + step[3]
        self.centre, self.radius = centre + origin, radius

    def distance_m(self, points: Any) -> Any:
        return np.abs(np.linalg.norm(points - self.centre, axis=1) - self.radius)

    def depth_m(self, directions: Any) -> Any:
        """Returns the radial depth of the near side along rays from the camera; NaN for rays that
        miss it."""
        along = directions @ self.centre
        inside = along**2 - self.centre @ self.centre + self.radius**2
        return along - np.sqrt(np.where(inside >= 0, inside, np.nan))


def fit_without_outliers(surface: type[Plane] | type[Sphere], points: Any) -> tuple[Plane | Sphere, float]:
    """Alternates fitting and omitting the few points beyond three robust standard deviations.
    Returns the surface and the root mean square distance of the points that remain [m]."""
    kept = np.ones(len(points), bool)
    for _ in range(50):
        fitted = surface(points[kept])
        away_m = fitted.distance_m(points)
        near = away_m <= 3 * 1.4826 * np.median(away_m)
        if (near == kept).all():
            break
        kept = near
    return fitted, float(np.sqrt(np.mean(away_m[kept] ** 2)))

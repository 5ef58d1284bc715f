# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Depth error of codes, and bounds on it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Optional

from . import _check, _tofsmith
from ._camera import CameraLike, camera_of
from ._check import FloatArray, Progress
from ._code import CodeLike, code_of


@dataclass(frozen=True)
class DepthErrorMean:
    """One figure for all operating points, with its standard error [m]."""

    geometric_mean_m: float
    geometric_mean_se_m: float
    mean_m: float
    mean_se_m: float


@dataclass(frozen=True)
class DepthErrorReport:
    """Depth error of a code on a camera; arrays have one entry per operating point, (P,), signal by
    signal.

    Attributes
    ----------
    code : str
    exposures, taps, measurements, samples : int
    trials : int
        Made, per operating point.
    seed : int
    outlier_threshold_m : float
    signal_e_per_s, ambient_e_per_s : ndarray
        The operating points [e/s].
    linear_mde_m, linear_se_m : ndarray
        Mean |decoded - true| [m] and its standard error.
    circular_mde_m, circular_se_m : ndarray
        Of the shorter way round the range [m].
    outlier_rate : ndarray
        Share of circular errors beyond the threshold.
    cramer_rao_mae_m, receiver_bound_mae_m, direct_tof_bound_mae_m : ndarray
        Bounds of the code, of any code on the camera, of the camera's light [m]; docs/bounds.md.
    linear, circular : DepthErrorMean
    """

    code: str
    exposures: int
    taps: int
    measurements: int
    samples: int
    trials: int
    seed: int
    outlier_threshold_m: float
    signal_e_per_s: FloatArray
    ambient_e_per_s: FloatArray
    linear_mde_m: FloatArray
    linear_se_m: FloatArray
    circular_mde_m: FloatArray
    circular_se_m: FloatArray
    outlier_rate: FloatArray
    cramer_rao_mae_m: FloatArray
    receiver_bound_mae_m: FloatArray
    direct_tof_bound_mae_m: FloatArray
    linear: DepthErrorMean
    circular: DepthErrorMean

    def __repr__(self) -> str:
        return (
            f"<DepthErrorReport {self.code}: linear {self.linear.geometric_mean_m * 1e3:.4g} mm, "
            f"circular {self.circular.geometric_mean_m * 1e3:.4g} mm (geometric means of "
            f"{len(self.signal_e_per_s)} operating points, {self.trials} trials each)>"
        )


@dataclass(frozen=True)
class RobustnessReport:
    """Depth error when the camera is not quite what it was said to be: geometric means over its
    operating points [m]; pairs are (value, standard error).

    Attributes
    ----------
    kind : str
        linear or circular, as the camera's operating range says.
    nominal_m, worst_calibrated_m, worst_uncalibrated_m : tuple of float
        On the camera as it was said to be; on the worst, with a decoder that knows it, and with one
        that does not.
    names : list of str
        What was changed.
    calibrated_m, uncalibrated_m : ndarray
        Of each change.
    """

    kind: str
    trials: int
    seed: int
    nominal_m: tuple[float, float]
    worst_calibrated_m: tuple[float, float]
    worst_uncalibrated_m: tuple[float, float]
    names: list[str]
    calibrated_m: FloatArray
    uncalibrated_m: FloatArray


def report_of(values: dict[str, Any]) -> DepthErrorReport:
    linear = DepthErrorMean(**values.pop("linear"))
    circular = DepthErrorMean(**values.pop("circular"))
    return DepthErrorReport(**values, linear=linear, circular=circular)


def evaluate(
    code: CodeLike,
    camera: CameraLike,
    *,
    trials: Optional[int] = None,
    seed: Optional[int] = None,
    outlier_threshold_m: Optional[float] = None,
    sub_bin: Optional[bool] = None,
    depth: Optional[str] = None,
    clip_to_open_sensor: Optional[bool] = None,
    method: Optional[str] = None,
    unwrap_weights: Optional[str] = None,
    progress: Progress = None,
) -> DepthErrorReport:
    """Monte Carlo depth error at every operating point of the camera, with bounds beside it.

    Parameters
    ----------
    code : CodeSet, name of a family or file
    camera : Camera or its name
    trials : int, optional
        Per operating point (20000).
    seed : int, optional
        Of all trials (1): codes are compared on the same depths and noise.
    outlier_threshold_m : float, optional
        Circular errors beyond are outliers [m] (0.5).
    sub_bin : bool, optional
        Decode between bins (True).
    depth : {"uniform", "bins"}, optional
        Where true depths lie; bins flatters codes.
    clip_to_open_sensor : bool, optional
        Clip electrons to [0, T (S + A)] (False), as the paper's authors' simulator does.
    method, unwrap_weights : str, optional
        As of Decoder.
    progress : callable, optional

    Raises
    ------
    ValueError
        If the code does not fit, the method cannot decode it, or an option breaks a rule.
    """
    camera = camera_of(camera)
    options = {
        "trials": trials,
        "seed": seed,
        "outlier_threshold_m": outlier_threshold_m,
        "sub_bin": sub_bin,
        "depth": depth,
        "clip_to_open_sensor": clip_to_open_sensor,
        "method": method,
        "unwrap_weights": unwrap_weights,
    }
    handle = code_of(code, camera)._handle
    callback = _check.progress(progress)
    return report_of(_tofsmith.evaluate(handle, camera._handle, options, callback))


def best_rotation(
    code: CodeLike,
    camera: CameraLike,
    *,
    trials: Optional[int] = None,
    seed: Optional[int] = None,
    progress: Progress = None,
) -> tuple[int, FloatArray]:
    """The origin of depth with the least linear error.

    Returns
    -------
    rotation_bin : int
        CodeSet.rotated() by so many bins is best.
    linear_geometric_mean_m : ndarray, shape (N,)
        For each rotation, geometric mean over the operating points [m].
    """
    camera = camera_of(camera)
    options = {"trials": trials, "seed": seed}
    handle = code_of(code, camera)._handle
    callback = _check.progress(progress)
    return _tofsmith.best_rotation(handle, camera._handle, options, callback)


def robustness(
    code: CodeLike, camera: CameraLike, *, progress: Progress = None, **options: Any
) -> RobustnessReport:
    """Judges a code on perturbations of its camera.

    Parameters
    ----------
    code : CodeSet, name of a family or file
    camera : Camera or its name
    progress : callable, optional
    **options
        bandwidth (0.2), peak (0.1), edge_jitter_s (50e-12), tap_mismatch (0.02), clock_s (0), droop
        (0), together (False), trials (4000), seed (1), method, unwrap_weights; 0 leaves a change
        out. See docs/robustness.md.
    """
    camera = camera_of(camera)
    handle = code_of(code, camera)._handle
    callback = _check.progress(progress)
    return RobustnessReport(**_tofsmith.robustness(handle, camera._handle, options, callback))


def _light(signal_e_per_s: float, ambient_e_per_s: float) -> tuple[float, float]:
    light = []
    for value, name in ((signal_e_per_s, "signal_e_per_s"), (ambient_e_per_s, "ambient_e_per_s")):
        if _check.number(value, name) < 0:
            raise ValueError(f"{name}: got {value}; needs a number >= 0")
        light.append(float(value))
    return light[0], light[1]


class CramerRaoBound:
    """How well any unbiased estimator can measure depth with one code, signal and ambient light
    unknown; see docs/bounds.md.

    Parameters
    ----------
    code : CodeSet, name of a family or file
    camera : Camera or its name
    of_variance_too : bool
        Also count what the size of the noise tells (under 0.1 % more).
    """

    def __init__(
        self, code: CodeLike, camera: CameraLike, *, of_variance_too: bool = False
    ) -> None:
        camera = camera_of(camera)
        handle = code_of(code, camera)._handle
        self._handle = _tofsmith.CramerRaoBound(handle, camera._handle, bool(of_variance_too))

    def sigma_m(self, signal_e_per_s: float, ambient_e_per_s: float) -> FloatArray:
        """Smallest standard deviation [m] at 4 N depths, the middles of cells of 1/4 bin."""
        return self._handle.sigma_m(*_light(signal_e_per_s, ambient_e_per_s))

    def mae_m(
        self, signal_e_per_s: float, ambient_e_per_s: float, *, uniform_albedo: bool = False
    ) -> float:
        """Mean absolute error over depth [m]; also over a signal scaled uniformly in (0, 1)."""
        light = _light(signal_e_per_s, ambient_e_per_s)
        return self._handle.mae_m(*light, bool(uniform_albedo))


class ReceiverBound:
    """How well any code at all can do on a camera, in a number of exposures; docs/bounds.md."""

    def __init__(self, camera: CameraLike, exposures: int) -> None:
        count = _check.whole(exposures, "exposures", 1, 1_000_000)
        self._handle = _tofsmith.ReceiverBound(camera_of(camera)._handle, count)

    def mae_m(
        self, signal_e_per_s: float, ambient_e_per_s: float, *, uniform_albedo: bool = False
    ) -> float:
        """Mean absolute error over depth [m]; 0 without impulse responses."""
        light = _light(signal_e_per_s, ambient_e_per_s)
        return self._handle.mae_m(*light, bool(uniform_albedo))


class DirectTofBound:
    """What the camera's light alone allows, to an ideal direct time-of-flight receiver."""

    def __init__(self, camera: CameraLike) -> None:
        self._handle = _tofsmith.DirectTofBound(camera_of(camera)._handle)

    def mae_m(
        self, signal_e_per_s: float, ambient_e_per_s: float, *, uniform_albedo: bool = False
    ) -> float:
        """Mean absolute error over depth [m]; 0 where the light has no impulse response."""
        light = _light(signal_e_per_s, ambient_e_per_s)
        return self._handle.mae_m(*light, bool(uniform_albedo))

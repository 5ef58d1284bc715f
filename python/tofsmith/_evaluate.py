# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Depth error of codes, and its bounds."""

from __future__ import annotations

from typing import Any, Optional, Unpack

from . import _check, _tofsmith
from ._camera import CameraLike, camera_of
from ._check import FloatArray, Progress
from ._code import CodeLike, handles_of
from ._decoding_table import DecodingTable
from ._light import light_of
from ._option_fields import EvaluateOptions, RobustnessOptions
from ._options import takes
from ._reports import DepthErrorReport, GeneratorLoss, report_of
from ._result_fields import InterferenceReport, MotionReport, RobustnessReport
from ._results import result_of


class _Bound:
    """Base of the bounds."""

    _handle: Any

    def mae_m(
        self, signal_e_per_s: float, ambient_e_per_s: float, *, uniform_albedo: bool = False
    ) -> float:
        """Returns the mean absolute error over depth [m]; with `uniform_albedo`, also over signals
        scaled by a factor uniform in (0, 1).
        """
        light = light_of(signal_e_per_s, ambient_e_per_s)
        return self._handle.mae_m(*light, bool(uniform_albedo))


class CramerRaoBound(_Bound):
    """Cramer-Rao bound on the depth error of unbiased estimators for one code, with unknown signal
    and ambient light; see docs/bounds.md.

    Parameters
    ----------
    code : CodeSet, name of a family or file
    camera : Camera or its name
    of_variance_too : bool
        Include the information in the variance of the noise (less than 0.1 %).
    """

    def __init__(
        self, code: CodeLike, camera: CameraLike, *, of_variance_too: bool = False
    ) -> None:
        handles = handles_of(code, camera)
        self._handle = _tofsmith.CramerRaoBound(*handles, bool(of_variance_too))

    def sigma_m(self, signal_e_per_s: float, ambient_e_per_s: float) -> FloatArray:
        """Returns the minimum standard deviation [m] at the centres of equal cells of the range.

        There are at least 4 cells per bin, depending on the harmonics of the code.
        """
        return self._handle.sigma_m(*light_of(signal_e_per_s, ambient_e_per_s))


class ReceiverBound(_Bound):
    """Bound on the depth error of any code on a camera, for a number of exposures; docs/bounds.md.
    It is 0 without impulse responses."""

    def __init__(self, camera: CameraLike, exposures: int) -> None:
        count = _check.whole(exposures, "exposures", 1, 1_000_000)
        self._handle = _tofsmith.ReceiverBound(camera_of(camera)._handle, count)


class HistogramBound(_Bound):
    """Lower bound on the depth error of all rows with the light of one exposure, from measuring all
    time bins separately; docs/rows.md.

    Parameters
    ----------
    code : CodeSet, name of a family or file
        Rows; only their light is used.
    camera : Camera, or the name of a built-in camera or camera file
        With `sensor.readout` = "rows".
    """

    def __init__(self, code: CodeLike, camera: CameraLike) -> None:
        self._handle = _tofsmith.HistogramBound(*handles_of(code, camera))


class DirectTofBound(_Bound):
    """Bound on the depth error of an ideal direct time-of-flight receiver with the camera's light.
    It is 0 if the light has no impulse response."""

    def __init__(self, camera: CameraLike) -> None:
        self._handle = _tofsmith.DirectTofBound(camera_of(camera)._handle)


@takes(EvaluateOptions)
def evaluate(
    code: CodeLike,
    camera: CameraLike,
    *,
    progress: Progress = None,
    **options: Unpack[EvaluateOptions],
) -> DepthErrorReport:
    """Computes the Monte Carlo depth error and its bounds at every operating point of the camera.

    Parameters
    ----------
    code : CodeSet, name of a family or file
    camera : Camera or its name
    progress : callable, optional
    **options
        As in EvaluateOptions.

    Raises
    ------
    ValueError
        If the code does not fit, the method does not support it, or an option is invalid.
    """
    camera = camera_of(camera)
    values = _tofsmith.evaluate(
        *handles_of(code, camera), dict(options), _check.progress(progress))
    return report_of(values, camera)


def best_rotation(
    code: CodeLike,
    camera: CameraLike,
    *,
    trials: Optional[int] = None,
    seed: Optional[int] = None,
    progress: Progress = None,
) -> tuple[int, FloatArray]:
    """Finds the origin of depth with the smallest linear error, averaged over close origins.

    Returns
    -------
    rotation_bin : int
        Best argument of CodeSet.rotated().
    linear_geometric_mean_m : ndarray, shape (N,)
        Error of each rotation, geometric mean over the operating points [m].
    """
    options = {"trials": trials, "seed": seed}
    return _tofsmith.best_rotation(
        *handles_of(code, camera), options, _check.progress(progress))


@takes(EvaluateOptions)
def generator_loss(
    code: CodeLike,
    camera: CameraLike,
    *,
    progress: Progress = None,
    **options: Unpack[EvaluateOptions],
) -> GeneratorLoss:
    """Computes the increase in depth error due to the limits of a camera's waveform generators.

    Parameters
    ----------
    code : CodeSet, name of a family or file
    camera : Camera or its name
        Camera with generators, such as "prototype". Without them, waveforms are nominal.
    progress : callable, optional
    **options
        As in EvaluateOptions.
    """
    camera = camera_of(camera)
    values = _tofsmith.generator_loss(
        *handles_of(code, camera), dict(options), _check.progress(progress))
    nominal, actual, uncalibrated = (
        report_of(values[name], camera) for name in ("nominal", "actual", "uncalibrated")
    )
    return GeneratorLoss(nominal, actual, uncalibrated, values["correlation_change"])


def table_depth_error_m(
    table: DecodingTable,
    signal: float,
    ambient_e_per_s: float,
    *,
    trials: int = 20000,
    seed: int = 1,
) -> tuple[float, float]:
    """Returns the mean circular depth error of a table on frames simulated from itself, for
    comparison of measured tables with codes.

    Parameters
    ----------
    table : DecodingTable
    signal : float
        For a measured table: multiple of the signal at which it was measured. For the table of a
        code: S [e/s].
    ambient_e_per_s : float
    trials, seed : int

    Returns
    -------
    error_m, standard_error_m : float
    """
    handle = _check.instance(table, DecodingTable, "table")._handle
    light = _check.number(signal, "signal"), _check.number(ambient_e_per_s, "ambient_e_per_s")
    counts = _check.whole(trials, "trials", 2, 2**32), _check.whole(seed, "seed", 0, 2**64 - 1)
    return _tofsmith.table_depth_error_m(handle, *light, *counts)


@takes(RobustnessOptions)
def robustness(
    code: CodeLike,
    camera: CameraLike,
    *,
    progress: Progress = None,
    **options: Unpack[RobustnessOptions],
) -> RobustnessReport:
    """Computes the depth error of a code on perturbations of its camera; see docs/robustness.md.

    Parameters
    ----------
    code : CodeSet, name of a family or file
    camera : Camera or its name
    progress : callable, optional
    **options
        As in RobustnessOptions.
    """
    values = _tofsmith.robustness(
        *handles_of(code, camera), dict(options), _check.progress(progress))
    return result_of(RobustnessReport, values)


@takes(EvaluateOptions)
def motion_error(
    code: CodeLike,
    camera: CameraLike,
    velocity_m_per_s: float,
    *,
    progress: Progress = None,
    **options: Unpack[EvaluateOptions],
) -> MotionReport:
    """Computes the depth error of a surface that moves along the ray while exposures follow one
    another, and of an edge that passes between two exposures; see docs/robustness.md.

    Parameters
    ----------
    code : CodeSet, name of a family or file
    camera : Camera or its name
    velocity_m_per_s : float
        Positive: away from the camera.
    progress : callable, optional
    **options
        As in EvaluateOptions; trials, seed, method and unwrap_weights are used.
    """
    values = _tofsmith.motion_error(
        *handles_of(code, camera), _check.number(velocity_m_per_s, "velocity_m_per_s"),
        dict(options), _check.progress(progress))
    return result_of(MotionReport, values)


@takes(EvaluateOptions)
def interference_error(
    code: CodeLike,
    camera: CameraLike,
    *,
    progress: Progress = None,
    **options: Unpack[EvaluateOptions],
) -> InterferenceReport:
    """Computes the depth error with the light of other cameras, as the camera's
    `operating.interference` describes them; see docs/robustness.md.

    Parameters
    ----------
    code : CodeSet, name of a family or file
    camera : Camera or its name
    progress : callable, optional
    **options
        As in EvaluateOptions; trials, seed, method and unwrap_weights are used.
    """
    values = _tofsmith.interference_error(
        *handles_of(code, camera), dict(options), _check.progress(progress))
    return result_of(InterferenceReport, values)

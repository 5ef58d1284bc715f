# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Results of evaluating the depth error of codes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple, Optional

import numpy as np
import numpy.typing as npt

from . import _check
from ._camera import Camera
from ._check import FloatArray


class Estimate(NamedTuple):
    """A value and its standard error."""

    value: float
    standard_error: float


def with_estimates(fields: dict[str, Any]) -> dict[str, Any]:
    """Returns fields with an Estimate for each pair (value, standard error)."""
    return {name: Estimate(*value) if isinstance(value, tuple) else value
            for name, value in fields.items()}


@dataclass(frozen=True)
class DepthErrorMean:
    """Geometric mean of the depth error over all operating points, with its standard error [m]."""

    geometric_mean_m: float
    geometric_mean_se_m: float
    mean_m: float
    mean_se_m: float


@dataclass(frozen=True)
class DepthErrorReport:
    """Depth error of a code on a camera. Arrays have one entry per operating point, (P,), ordered
    by signal.

    Attributes
    ----------
    code : str
    exposures, taps, measurements, samples : int
    trials : int
        Trials per operating point; with a target standard error the maximum.
    points_short_of_target : int
        Number of operating points that reached max_trials before the target.
    seed : int
    outlier_threshold_m : float
    signal_e_per_s, ambient_e_per_s : ndarray
        Operating points [e/s].
    linear_mde_m, linear_se_m : ndarray
        Mean absolute difference of decoded and true depth [m], and its standard error.
    circular_mde_m, circular_se_m : ndarray
        The same for the circular (wrapped) difference [m].
    linear_rmse_m, linear_rmse_se_m, circular_rmse_m, circular_rmse_se_m : ndarray
        Root mean square of both, and standard errors [m].
    point_trials : ndarray of int64
        Trials at each point.
    outlier_rate : ndarray
        Share of circular errors above the threshold.
    cramer_rao_mae_m, receiver_bound_mae_m, direct_tof_bound_mae_m : ndarray
        Bounds for the code, for any code on the camera, and for the camera's light [m];
        docs/bounds.md. 0 if there is no bound, e.g. without impulse responses.
    linear, circular : DepthErrorMean
        Means of mean absolute errors.
    linear_rmse, circular_rmse : DepthErrorMean
        Means of root mean square errors.
    kind : str
        Error used for ranking, the camera's `operating.error`: linear or circular.
    """

    code: str
    exposures: int
    taps: int
    measurements: int
    samples: int
    trials: int
    points_short_of_target: int
    seed: int
    outlier_threshold_m: float
    signal_e_per_s: FloatArray
    ambient_e_per_s: FloatArray
    point_trials: npt.NDArray[np.int64]
    linear_mde_m: FloatArray
    linear_se_m: FloatArray
    circular_mde_m: FloatArray
    circular_se_m: FloatArray
    linear_rmse_m: FloatArray
    linear_rmse_se_m: FloatArray
    circular_rmse_m: FloatArray
    circular_rmse_se_m: FloatArray
    outlier_rate: FloatArray
    cramer_rao_mae_m: FloatArray
    receiver_bound_mae_m: FloatArray
    direct_tof_bound_mae_m: FloatArray
    linear: DepthErrorMean
    circular: DepthErrorMean
    linear_rmse: DepthErrorMean
    circular_rmse: DepthErrorMean
    kind: str

    def of(self, kind: str) -> DepthErrorMean:
        """Returns the mean for `kind`, linear or circular."""
        _check.one_of(kind, "kind", ("linear", "circular"))
        return self.linear if kind == "linear" else self.circular

    def __repr__(self) -> str:
        return (
            f"<DepthErrorReport {self.code}: linear {self.linear.geometric_mean_m * 1e3:.4g} mm, "
            f"circular {self.circular.geometric_mean_m * 1e3:.4g} mm (geometric means of "
            f"{len(self.signal_e_per_s)} operating points, {self.trials} trials each)>"
        )


@dataclass(frozen=True)
class RobustnessReport:
    """Depth error if the camera deviates from its description: geometric means over its operating
    points [m]; pairs are (value, standard error).

    Attributes
    ----------
    kind : str
        linear or circular, from the camera's operating range.
    nominal_m, worst_calibrated_m, worst_uncalibrated_m : tuple of float
        For the camera as described; for the worst perturbation, with a decoder that knows the
        perturbation, and with one that does not.
    names : list of str
        Perturbations.
    calibrated_m, calibrated_se_m, uncalibrated_m, uncalibrated_se_m : ndarray
        For each perturbation.
    """

    kind: str
    trials: int
    seed: int
    nominal_m: tuple[float, float]
    worst_calibrated_m: tuple[float, float]
    worst_uncalibrated_m: tuple[float, float]
    names: list[str]
    calibrated_m: FloatArray
    calibrated_se_m: FloatArray
    uncalibrated_m: FloatArray
    uncalibrated_se_m: FloatArray


@dataclass(frozen=True)
class WrongShares:
    """Shares of trials whose exposures saw different depths. A depth is wrong if it deviates from
    all true depths by more than three times its `deviation_m`.

    Attributes
    ----------
    wrong : float
    wrong_ok, wrong_inconsistent : float
        Wrong, with status ok or inconsistent.
    inconsistent : float
        Status inconsistent.
    """

    wrong: float
    wrong_ok: float
    wrong_inconsistent: float
    inconsistent: float


@dataclass(frozen=True)
class MotionErrors:
    """Depth errors of trials whose exposures saw different depths.

    Attributes
    ----------
    geometric_mean_m, geometric_mean_se_m : float
        Geometric mean over the operating points of the circular error.
    shares : WrongShares
        Means over the operating points.
    signal_e_per_s, ambient_e_per_s : ndarray
        Operating points.
    circular_mde_m, circular_se_m : ndarray
        Mean distance from the nearest true depth, wrapped.
    bias_m, bias_se_m : ndarray
        Mean difference from the nearest true depth.
    wrong, wrong_ok, wrong_inconsistent, inconsistent : ndarray
        As in WrongShares.
    """

    geometric_mean_m: float
    geometric_mean_se_m: float
    shares: WrongShares
    signal_e_per_s: FloatArray
    ambient_e_per_s: FloatArray
    circular_mde_m: FloatArray
    circular_se_m: FloatArray
    bias_m: FloatArray
    bias_se_m: FloatArray
    wrong: FloatArray
    wrong_ok: FloatArray
    wrong_inconsistent: FloatArray
    inconsistent: FloatArray


@dataclass(frozen=True)
class MotionReport:
    """Effect of motion while the exposures of a frame follow one another.

    Attributes
    ----------
    velocity_m_per_s : float
    rms_bias_m, mean_bias_m : float
        Depth error of a moving surface without noise, over all depths, to first order in the
        velocity.
    surface : MotionErrors
        For a moving surface; its true depth is its depth in the middle of the frame.
    edge : MotionErrors
        At an edge that passes between two exposures; the true depths are the depths of both
        surfaces. Codes with one exposure have no operating points.
    """

    velocity_m_per_s: float
    rms_bias_m: float
    mean_bias_m: float
    surface: MotionErrors
    edge: MotionErrors


@dataclass(frozen=True)
class InterferenceReport:
    """Effect of the light of other cameras, as in the camera's `operating.interference`.

    Attributes
    ----------
    rms_m : float
        Root mean square error of zncc without noise, to first order in the light of the others.
    linear, circular : DepthErrorMean
        Mean errors with noise, over the operating points.
    shares : WrongShares
        Means over the operating points.
    signal_e_per_s, ambient_e_per_s : ndarray
        Operating points.
    expected_rmse_m : ndarray
        Root mean square error of zncc with interference and noise, to first order.
    linear_mde_m, linear_se_m, circular_mde_m, circular_se_m : ndarray
        Mean absolute error of trials.
    circular_rmse_m, circular_rmse_se_m : ndarray
        Root mean square error of trials.
    wrong, wrong_ok, wrong_inconsistent, inconsistent : ndarray
        As in WrongShares.
    """

    rms_m: float
    linear: DepthErrorMean
    circular: DepthErrorMean
    shares: WrongShares
    signal_e_per_s: FloatArray
    ambient_e_per_s: FloatArray
    expected_rmse_m: FloatArray
    linear_mde_m: FloatArray
    linear_se_m: FloatArray
    circular_mde_m: FloatArray
    circular_se_m: FloatArray
    circular_rmse_m: FloatArray
    circular_rmse_se_m: FloatArray
    wrong: FloatArray
    wrong_ok: FloatArray
    wrong_inconsistent: FloatArray
    inconsistent: FloatArray


def interference_report_of(values: dict[str, Any]) -> InterferenceReport:
    parts: dict[str, Any] = {name: DepthErrorMean(**values.pop(name))
                             for name in ("linear", "circular")}
    shares = WrongShares(**values.pop("shares"))
    return InterferenceReport(**values, **parts, shares=shares)


@dataclass(frozen=True)
class OperatingMultipathReport:
    """Depth error if every pixel has a second return as in the camera's `operating.multipath`:
    geometric means over its operating points [m], each as (value, standard error).

    Attributes
    ----------
    single_path_linear_m, single_path_circular_m : tuple of float
        Decoded with a single return.
    two_return_linear_m, two_return_circular_m : tuple of float, optional
        Decoded with two returns; None if the code cannot separate them.
    """

    single_path_linear_m: tuple[float, float]
    single_path_circular_m: tuple[float, float]
    two_return_linear_m: Optional[tuple[float, float]]
    two_return_circular_m: Optional[tuple[float, float]]


@dataclass(frozen=True)
class GeneratorLoss:
    """Depth error of a code with and without generator limits, for the same depths and noise.

    Attributes
    ----------
    nominal, actual, uncalibrated : DepthErrorReport
        Without generators; with generators, with a decoder that knows the actual waveforms; with
        generators, with a decoder that assumes the nominal waveforms. Without bounds.
    correlation_change : ndarray, shape (K,)
        Rms difference of the nominal and actual correlation functions, relative to the rms of the
        nominal ones about their means.
    """

    nominal: DepthErrorReport
    actual: DepthErrorReport
    uncalibrated: DepthErrorReport
    correlation_change: FloatArray

    def ratio(self, kind: str = "linear") -> float:
        """Returns actual / nominal, of the geometric means."""
        return self.actual.of(kind).geometric_mean_m / self.nominal.of(kind).geometric_mean_m

    def uncalibrated_ratio(self, kind: str = "linear") -> float:
        """Returns uncalibrated / nominal, of the geometric means."""
        return self.uncalibrated.of(kind).geometric_mean_m / self.nominal.of(kind).geometric_mean_m


_means = ("linear", "circular", "linear_rmse", "circular_rmse")


def report_of(values: dict[str, Any], camera: Camera) -> DepthErrorReport:
    means: dict[str, Any] = {name: DepthErrorMean(**values.pop(name)) for name in _means}
    return DepthErrorReport(**values, **means, kind=camera.operating.error)


def fields_of(report: DepthErrorReport) -> dict[str, Any]:
    """Inverse of report_of()."""
    fields = vars(report) | {name: vars(getattr(report, name)) for name in _means}
    del fields["kind"]
    return fields

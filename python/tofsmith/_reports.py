# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Results of evaluating the depth error of codes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Optional

from . import _check, _result_fields
from ._camera import Camera
from ._check import FloatArray
from ._result_fields import DepthErrorMean
from ._results import Estimate, result_of


@dataclass(frozen=True)
class DepthErrorReport(_result_fields.DepthErrorReport):
    __doc__ = _result_fields.DepthErrorReport.__doc__

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
class OperatingMultipathReport:
    """Depth error if every pixel has a second return as in the camera's `operating.multipath`:
    geometric means over its operating points [m], each as (value, standard error).

    Attributes
    ----------
    single_path_linear_m, single_path_circular_m : Estimate
        Decoded with a single return.
    two_return_linear_m, two_return_circular_m : Estimate, optional
        Decoded with two returns; None if the code cannot separate them.
    """

    single_path_linear_m: Estimate
    single_path_circular_m: Estimate
    two_return_linear_m: Optional[Estimate]
    two_return_circular_m: Optional[Estimate]


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


def report_of(values: dict[str, Any], camera: Camera) -> DepthErrorReport:
    return result_of(DepthErrorReport, {**values, "kind": camera.operating.error})


def fields_of(report: DepthErrorReport) -> dict[str, Any]:
    """Returns the values of a report for the compiled module."""
    return {name: vars(value) if isinstance(value, DepthErrorMean) else value
            for name, value in vars(report).items()}

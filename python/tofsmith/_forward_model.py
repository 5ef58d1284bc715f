# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Measurements of a camera: correlation functions, coding curves, expected electrons."""

from __future__ import annotations

from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from . import _check, _tofsmith
from ._camera import CameraLike
from ._check import FloatArray
from ._code import CodeLike, handles_of


def coding_curve_length(table: npt.ArrayLike) -> float:
    """Returns the length of the closed curve of the K correlations (N, K) over depth."""
    return _tofsmith.coding_curve_length(_check.finite_array(table, "table", "(N, K)"))


def coding_curve_in_space(table: npt.ArrayLike) -> FloatArray:
    """Projects the coding curve (N, K) on its three principal directions, (N, 3)."""
    return _tofsmith.coding_curve_in_space(_check.finite_array(table, "table", "(N, K)"))


def coding_curve_rank(table: npt.ArrayLike, tolerance: float = 1e-6) -> int:
    """Returns the rank of the table (N, K) after subtracting the mean of each column."""
    array = _check.finite_array(table, "table", "(N, K)")
    return _tofsmith.coding_curve_rank(array, _check.number(tolerance, "tolerance"))


def harmonics_used(table: npt.ArrayLike, share: float = 0.99) -> int:
    """Returns the lowest harmonic h such that 1 to h contain `share` of the energy of the table (N,
    K)."""
    array = _check.finite_array(table, "table", "(N, K)")
    return _tofsmith.harmonics_used(array, _check.number(share, "share"))


class ForwardModel:
    """Expected electrons and variance of the measurements of a code on a camera.

    mu_i(z) = T_i (S chi_i(z) + A kappa_i + dark), with variance mu_i + sigma_r^2 (+ step^2 / 12).
    chi and kappa include the responses of both arms (Gutierrez-Barragan et al., CVPR 2019, Eq. 4).
    K is the number of outputs of the sensor: a difference counts once.

    Parameters
    ----------
    code : CodeSet, name of a family or file
    camera : Camera or its name

    Raises
    ------
    ValueError
        If the code does not fit the camera.
    """

    def __init__(self, code: CodeLike, camera: CameraLike) -> None:
        self._handle = _tofsmith.ForwardModel(*handles_of(code, camera))

    @property
    def measurements(self) -> int:
        """K, number of measurements."""
        return self._handle.measurements()

    @property
    def samples(self) -> int:
        """N, samples per period."""
        return self._handle.samples()

    def correlation(self, depth_bin: npt.ArrayLike) -> FloatArray:
        """Returns chi at any depths: depth_bin (...) [bins] to (..., K)."""
        return self._by_depth(depth_bin, self._handle.correlation)

    def correlation_table(self, points: Optional[int] = None) -> FloatArray:
        """Returns chi at depth_bin = j N / points, (points, K); default: points = N."""
        count = self.samples if points is None else _check.whole(points, "points", 1, 10_000_000)
        return self._handle.correlation_table(count)

    @property
    def ambient_gain(self) -> FloatArray:
        """kappa (K,): mean gain for ambient light."""
        return self._handle.ambient_gain()

    @property
    def exposure_s(self) -> FloatArray:
        """T [s] of every measurement (K,)."""
        return self._handle.exposure_s()

    @property
    def dark_electrons(self) -> FloatArray:
        """Electrons from dark current (K,)."""
        return self._handle.dark_electrons()

    @property
    def constant_variance_e2(self) -> FloatArray:
        """Variance independent of light [e^2] (K,)."""
        return self._handle.constant_variance_e2()

    def expected_electrons(
        self, depth_bin: npt.ArrayLike, signal_e_per_s: float, ambient_e_per_s: float
    ) -> FloatArray:
        """Returns the expected measurements [e]: depth_bin (...) to (..., K)."""
        light = _light(signal_e_per_s, ambient_e_per_s)
        return self._by_depth(depth_bin, lambda d: self._handle.expected_electrons(d, *light))

    def variance_e2(
        self, depth_bin: npt.ArrayLike, signal_e_per_s: float, ambient_e_per_s: float
    ) -> FloatArray:
        """Returns the variance [e^2] before any clipping: depth_bin (...) to (..., K)."""
        light = _light(signal_e_per_s, ambient_e_per_s)
        return self._by_depth(depth_bin, lambda d: self._handle.variance_e2(d, *light))

    def covariance_e2(
        self, depth_bin: float, signal_e_per_s: float, ambient_e_per_s: float
    ) -> FloatArray:
        """Returns the covariance [e^2] at one depth (K, K); diagonal except for rows."""
        light = _light(signal_e_per_s, ambient_e_per_s)
        return self._handle.covariance_e2(_check.number(depth_bin, "depth_bin"), *light)

    def _by_depth(self, depth_bin: npt.ArrayLike, of_depths: Any) -> FloatArray:
        depths = np.asarray(depth_bin)
        flat = _check.finite_array(depths.reshape(-1), "depth_bin", "(depths,)")
        rows: FloatArray = of_depths(flat)
        return rows.reshape(*depths.shape, self.measurements)


def _light(signal_e_per_s: float, ambient_e_per_s: float) -> tuple[float, float]:
    return (
        _check.number(signal_e_per_s, "signal_e_per_s"),
        _check.number(ambient_e_per_s, "ambient_e_per_s"),
    )

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""What a camera measures: correlation functions, coding curves, expected electrons."""

from __future__ import annotations

from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from . import _check, _tofsmith
from ._camera import CameraLike, camera_of
from ._check import FloatArray
from ._code import CodeLike, code_of


def coding_curve_length(table: npt.ArrayLike) -> float:
    """Length of the closed path that the K correlations (N, K) draw over depth."""
    return _tofsmith.coding_curve_length(_check.finite_array(table, "table", "(N, K)"))


def coding_curve_in_space(table: npt.ArrayLike) -> FloatArray:
    """The curve (N, K) in its three directions of largest extent, (N, 3)."""
    return _tofsmith.coding_curve_in_space(_check.finite_array(table, "table", "(N, K)"))


def coding_curve_rank(table: npt.ArrayLike, tolerance: float = 1e-6) -> int:
    """Number of independent directions of the table (N, K), each column about its mean."""
    array = _check.finite_array(table, "table", "(N, K)")
    return _tofsmith.coding_curve_rank(array, _check.number(tolerance, "tolerance"))


def harmonics_used(table: npt.ArrayLike, share: float = 0.99) -> int:
    """Lowest harmonic h such that 1 to h hold `share` of the energy of the table (N, K)."""
    array = _check.finite_array(table, "table", "(N, K)")
    return _tofsmith.harmonics_used(array, _check.number(share, "share"))


class ForwardModel:
    """What a camera that plays a code measures: expected electrons and their variance.

    mu_i(z) = T_i (S chi_i(z) + A kappa_i + dark), variance mu_i + sigma_r^2 (+ step^2 / 12); chi
    and kappa are those of the actual waveforms, behind both arms (Gutierrez-Barragan et al.,
    CVPR 2019, Eq. 4). K here counts what leaves the sensor: differences count once.

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
        camera = camera_of(camera)
        self._handle = _tofsmith.ForwardModel(code_of(code, camera)._handle, camera._handle)

    @property
    def measurements(self) -> int:
        """K."""
        return self._handle.measurements()

    @property
    def samples(self) -> int:
        """N."""
        return self._handle.samples()

    def correlation(self, depth_bin: npt.ArrayLike) -> FloatArray:
        """chi at real depths: depth_bin of shape (..) [bins] to (.., K)."""
        return self._by_depth(depth_bin, self._handle.correlation)

    def correlation_table(self, points: Optional[int] = None) -> FloatArray:
        """chi at depth_bin = j N / points, (points, K); points = N unless given."""
        count = self.samples if points is None else _check.whole(points, "points", 1, 10_000_000)
        return self._handle.correlation_table(count)

    @property
    def ambient_gain(self) -> FloatArray:
        """kappa (K,): mean gain seen by ambient light."""
        return self._handle.ambient_gain()

    @property
    def exposure_s(self) -> FloatArray:
        """T [s] of every measurement (K,)."""
        return self._handle.exposure_s()

    @property
    def dark_electrons(self) -> FloatArray:
        """Electrons of dark current (K,)."""
        return self._handle.dark_electrons()

    @property
    def constant_variance_e2(self) -> FloatArray:
        """Variance that does not depend on light [e^2] (K,)."""
        return self._handle.constant_variance_e2()

    def expected_electrons(
        self, depth_bin: npt.ArrayLike, signal_e_per_s: float, ambient_e_per_s: float
    ) -> FloatArray:
        """Expected measurements [e]: depth_bin of shape (..) to (.., K)."""
        light = _light(signal_e_per_s, ambient_e_per_s)
        return self._by_depth(depth_bin, lambda d: self._handle.expected_electrons(d, *light))

    def variance_e2(
        self, depth_bin: npt.ArrayLike, signal_e_per_s: float, ambient_e_per_s: float
    ) -> FloatArray:
        """Their variance [e^2] before any clipping: depth_bin of shape (..) to (.., K)."""
        light = _light(signal_e_per_s, ambient_e_per_s)
        return self._by_depth(depth_bin, lambda d: self._handle.variance_e2(d, *light))

    def covariance_e2(
        self, depth_bin: float, signal_e_per_s: float, ambient_e_per_s: float
    ) -> FloatArray:
        """Their covariance [e^2] at one depth (K, K); diagonal but where rows are read out."""
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

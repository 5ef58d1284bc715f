# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Bounds on depth error."""

from __future__ import annotations

from typing import Any

from . import _check, _tofsmith
from ._camera import CameraLike, camera_of
from ._check import FloatArray
from ._code import CodeLike, code_of


def light_of(signal_e_per_s: float, ambient_e_per_s: float) -> tuple[float, float]:
    light = []
    for value, name in ((signal_e_per_s, "signal_e_per_s"), (ambient_e_per_s, "ambient_e_per_s")):
        if _check.number(value, name) < 0:
            raise ValueError(f"{name}: got {value}; needs a number >= 0")
        light.append(float(value))
    return light[0], light[1]


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
        camera = camera_of(camera)
        handle = code_of(code, camera)._handle
        self._handle = _tofsmith.CramerRaoBound(handle, camera._handle, bool(of_variance_too))

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
        camera = camera_of(camera)
        self._handle = _tofsmith.HistogramBound(code_of(code, camera)._handle, camera._handle)


class DirectTofBound(_Bound):
    """Bound on the depth error of an ideal direct time-of-flight receiver with the camera's light.
    It is 0 if the light has no impulse response."""

    def __init__(self, camera: CameraLike) -> None:
        self._handle = _tofsmith.DirectTofBound(camera_of(camera)._handle)

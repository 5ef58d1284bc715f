# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Multipath light of pixels, in addition to the direct return."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from . import _check


def light_of(signal_e_per_s: float, ambient_e_per_s: float) -> tuple[float, float]:
    """Returns both as floats. Raises ValueError unless both are >= 0."""
    light = []
    for value, name in ((signal_e_per_s, "signal_e_per_s"), (ambient_e_per_s, "ambient_e_per_s")):
        if _check.number(value, name) < 0:
            raise ValueError(f"{name}: got {value}; needs a number >= 0")
        light.append(float(value))
    return light[0], light[1]


@dataclass(frozen=True)
class ExponentialTail:
    """Light that decreases exponentially after the direct return, as in haze or translucent
    objects.

    Attributes
    ----------
    mean_delay_m : float
        [m], > 0 and at most the range of the period.
    ratio : float
        Total signal of the tail relative to that of the direct return, >= 0.
    """

    mean_delay_m: float = 0.5
    ratio: float = 0.3


@dataclass(frozen=True)
class MultipathReturns:
    """Any number of multipath returns for every pixel of a scene, row by row, as in the files of
    `tofsmith simulate --multipath-file`.

    Attributes
    ----------
    first : ndarray of int64, shape (H W + 1,)
        Pixel i has the returns first[i] to first[i + 1] - 1.
    distance_m : ndarray, shape (returns,)
        Half the path length [m]; increasing within a pixel, at least its depth.
    ratio : ndarray, shape (returns,)
        Signal relative to that of the pixel's direct return, >= 0.
    """

    first: npt.NDArray[Any]
    distance_m: npt.NDArray[Any]
    ratio: npt.NDArray[Any]


@dataclass(frozen=True)
class Transients:
    """Measured responses of a scene to a short pulse: histograms of light over distance.

    Attributes
    ----------
    light : ndarray, shape (T,) or (H, W, T)
        Light of each bin, >= 0, in any unit: one histogram for all pixels, or one per pixel.
    bin_m : float
        Depth per bin, c / 2 times its duration [m].
    first_m : float
        Start of bin 0, relative to the pixel's depth [m].
    """

    light: npt.NDArray[Any]
    bin_m: float
    first_m: float = 0.0


def light_dict(
    returns: Union[MultipathReturns, Sequence[tuple[float, float]], None],
    tail: Union[ExponentialTail, None],
    transients: Union[Transients, None],
    depth_m: npt.NDArray[Any],
) -> dict[str, Any]:
    """Converts the arguments of capture() for the compiled module."""
    light: dict[str, Any] = {}
    if isinstance(returns, MultipathReturns):
        first = _check.real_array(returns.first, "returns.first", "(H W + 1,)")
        if first.dtype.kind not in "iu":
            raise ValueError(f"returns.first: got dtype {first.dtype}; needs whole numbers")
        light["returns"] = (
            first.astype(np.int64),
            _list_of_floats(returns.distance_m, "returns.distance_m"),
            _list_of_floats(returns.ratio, "returns.ratio"),
        )
    elif returns is not None:
        pairs = _check.finite_array(returns, "returns", "(returns, 2)")
        if pairs.shape[1] != 2:
            raise ValueError(f"returns: got shape {pairs.shape}; needs (returns, 2), each a delay "
                             "[m] and a ratio")
        light["behind"] = pairs
    if tail is not None:
        _check.instance(tail, ExponentialTail, "tail")
        light["tail"] = (
            _check.number(tail.mean_delay_m, "tail.mean_delay_m"),
            _check.number(tail.ratio, "tail.ratio"),
        )
    if transients is not None:
        _check.instance(transients, Transients, "transients")
        axes = "(T,)" if np.ndim(transients.light) == 1 else "(H, W, T)"
        bins = _check.finite_array(transients.light, "transients.light", axes)
        if bins.ndim == 3 and bins.shape[:2] != np.shape(depth_m):
            height, width = np.shape(depth_m)
            raise ValueError(f"transients.light: got shape {bins.shape}; needs (T,) or "
                             f"({height}, {width}, T) as of the scene")
        light["transients"] = (
            bins.reshape(-1, bins.shape[-1]),
            _check.number(transients.bin_m, "transients.bin_m"),
            _check.number(transients.first_m, "transients.first_m"),
        )
    return light


def _list_of_floats(values: Any, name: str) -> npt.NDArray[np.float32]:
    array = np.asarray(values)
    if array.dtype.kind not in "fiu" or array.ndim != 1:
        raise ValueError(f"{name}: got {_check.shown(array)}; needs numbers of shape (returns,)")
    return array.astype(np.float32)

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""How light comes back to a pixel, beside its one direct way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from . import _check


@dataclass(frozen=True)
class ExponentialTail:
    """Light that trails off behind the direct return, as in haze or translucent things.

    Attributes
    ----------
    mean_delay_m : float
        [m], > 0 and at most the range of the period.
    ratio : float
        Signal of all of the tail over that of the direct return, >= 0.
    """

    mean_delay_m: float = 0.5
    ratio: float = 0.3


@dataclass(frozen=True)
class MultipathReturns:
    """Any number of multipath returns for every pixel of a scene, as one list, row by row; the arrays
    of the files that `tofsmith simulate --multipath-file` reads.

    Attributes
    ----------
    first : ndarray of int64, shape (H W + 1,)
        Pixel i has the returns first[i] .. first[i + 1] - 1.
    distance_m : ndarray, shape (returns,)
        Half the way it went [m]; increasing within a pixel, from its depth on.
    ratio : ndarray, shape (returns,)
        Its signal over that of the pixel's direct return, >= 0.
    """

    first: npt.NDArray[Any]
    distance_m: npt.NDArray[Any]
    ratio: npt.NDArray[Any]


@dataclass(frozen=True)
class Transients:
    """Measured responses of a scene to one short pulse: light by distance, as histograms.

    Attributes
    ----------
    light : ndarray, shape (T,) or (H, W, T)
        Of each bin, >= 0, any unit: one histogram for all pixels, or one for each.
    bin_m : float
        Depth that one bin takes, c / 2 times its time [m].
    first_m : float
        Depth at which bin 0 begins, behind the pixel's depth [m].
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
    """The arguments of capture() as the compiled part takes them."""
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

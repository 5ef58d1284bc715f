# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Depth error where light comes back twice or trails off, and its bound; see docs/multipath.md."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Unpack

import numpy as np
import numpy.typing as npt

from . import _check, _tofsmith
from ._camera import CameraLike, camera_of
from ._check import FloatArray, Progress
from ._code import CodeLike, code_of
from ._bounds import light_of
from ._light import ExponentialTail
from ._option_fields import MultipathErrorOptions
from ._options import takes


@dataclass(frozen=True)
class MultipathCells:
    """Error of direct depth [m], the shorter way round the range; all arrays of one shape.

    Attributes
    ----------
    ratio, delay_m : ndarray
        Of the second return, or of the tail, whose mean delay it is.
    single_bias_m, single_error_m, single_error_se_m : ndarray
        Mean of decoded - true, mean of its absolute value and standard error of that, of
        single-path decoding (zncc).
    bias_m, error_m, error_se_m : ndarray
        The same of two-return (tail) decoding; NaN where the code cannot.
    two_share, unresolved_share : ndarray
        Of pixels found to hold two returns, and of those found to be more than can be separated.
    cramer_rao_mae_m : ndarray
        Of MultipathBound.
    law_m : ndarray
        ratio delay_m / (1 + ratio): what single-path decoding is off by, roughly.
    """

    ratio: FloatArray
    delay_m: FloatArray
    single_bias_m: FloatArray
    single_error_m: FloatArray
    single_error_se_m: FloatArray
    bias_m: FloatArray
    error_m: FloatArray
    error_se_m: FloatArray
    two_share: FloatArray
    unresolved_share: FloatArray
    cramer_rao_mae_m: FloatArray
    law_m: FloatArray

    def gain(self) -> FloatArray:
        """single_error_m / error_m."""
        return self.single_error_m / self.error_m


@dataclass(frozen=True)
class MultipathMaps:
    """Maps at one signal.

    Attributes
    ----------
    signal_e_per_s : float
        S1.
    points : MultipathCells, shape (ratios, delays)
        Of second returns.
    tails : MultipathCells, shape (ratios, tails)
    single : MultipathCells, shape ()
        Without a second return: what two-return decoding loses.
    single_by_tail : MultipathCells, shape ()
        The same by tail decoding, of the middle tail.
    """

    signal_e_per_s: float
    points: MultipathCells
    tails: MultipathCells
    single: MultipathCells
    single_by_tail: MultipathCells


@dataclass(frozen=True)
class MultipathErrorReport:
    """What a code does where light comes back twice.

    Attributes
    ----------
    code : str
    measurements : int
    why_no_two_returns, why_no_tail : str
        Empty where that decoding works.
    maps : list of MultipathMaps
        One for each signal.
    """

    code: str
    measurements: int
    why_no_two_returns: str
    why_no_tail: str
    maps: list[MultipathMaps]


def _cells(columns: dict[str, npt.NDArray[Any]], shape: tuple[int, ...]) -> MultipathCells:
    return MultipathCells(**{name: column.reshape(shape) for name, column in columns.items()})


def _maps(values: dict[str, Any]) -> MultipathMaps:
    ratios = len(np.unique(values["points"]["ratio"]))
    return MultipathMaps(
        values["signal_e_per_s"],
        _cells(values["points"], (ratios, -1)),
        _cells(values["tails"], (ratios, -1)),
        _cells(values["single"], ()),
        _cells(values["single_by_tail"], ()),
    )


@takes(MultipathErrorOptions)
def multipath_error(
    code: CodeLike,
    camera: CameraLike,
    *,
    progress: Progress = None,
    **options: Unpack[MultipathErrorOptions],
) -> MultipathErrorReport:
    """Bias and error of single-path against two-return and tail decoding, in the camera's noise.

    Parameters
    ----------
    code : CodeSet, name of a family or file
    camera : Camera or its name
    progress : callable, optional
    **options
        As MultipathErrorOptions; `decoding` as `multipath` of Decoder, without tail_m.
    """
    camera = camera_of(camera)
    handle = code_of(code, camera)._handle
    callback = _check.progress(progress)
    values = _tofsmith.multipath_error(handle, camera._handle, dict(options), callback)
    maps = [_maps(m) for m in values.pop("maps")]
    return MultipathErrorReport(**values, maps=maps)


class MultipathBound:
    """Cramer-Rao bound of direct depth where light comes back twice: two returns pay only where it
    is below the bias of single-path decoding.

    Parameters
    ----------
    code : CodeSet, name of a family or file
    camera : Camera or its name
    """

    def __init__(self, code: CodeLike, camera: CameraLike) -> None:
        camera = camera_of(camera)
        self._handle = _tofsmith.MultipathBound(code_of(code, camera)._handle, camera._handle)

    def sigma_m(
        self, signal_e_per_s: float, ambient_e_per_s: float, ratio: float, delay_m: float
    ) -> FloatArray:
        """Smallest standard deviation of direct depth [m] at the middle of each bin (N,), all of
        (z, delta, S1, S2, A) unknown."""
        second = _check.number(ratio, "ratio"), _check.number(delay_m, "delay_m")
        return self._handle.sigma_m(*light_of(signal_e_per_s, ambient_e_per_s), *second)

    def tail_sigma_m(
        self, signal_e_per_s: float, ambient_e_per_s: float, tail: ExponentialTail
    ) -> FloatArray:
        """The same behind a tail of known mean delay, (N,)."""
        _check.instance(tail, ExponentialTail, "tail")
        light = light_of(signal_e_per_s, ambient_e_per_s)
        return self._handle.tail_sigma_m(*light, tail.mean_delay_m, tail.ratio)

    def mae_m(self, sigma_m: npt.ArrayLike) -> float:
        """Mean absolute error over depth [m]: of sqrt(2 / pi) sigma, at each depth held to a
        quarter of the range."""
        return self._handle.mae_m(np.asarray(_check.real_array(sigma_m, "sigma_m", "(N,)"), float))


def single_path_bias_m(ratio: float, delay_m: float) -> float:
    """ratio delay_m / (1 + ratio) [m]: bias of single-path decoding behind a second return that is
    closer than the correlation functions' features, with every code."""
    return _tofsmith.single_path_bias_m(
        _check.number(ratio, "ratio"), _check.number(delay_m, "delay_m")
    )

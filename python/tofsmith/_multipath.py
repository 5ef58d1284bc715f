# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Depth error with a second return or a tail, and its bound; see docs/multipath.md."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Unpack

import numpy as np
import numpy.typing as npt

from . import _check, _result_fields, _tofsmith
from ._camera import CameraLike
from ._check import FloatArray, Progress
from ._code import CodeLike, handles_of
from ._light import ExponentialTail, light_of
from ._option_fields import MultipathErrorOptions
from ._options import takes


@dataclass(frozen=True)
class MultipathCells(_result_fields.MultipathCells):
    __doc__ = _result_fields.MultipathCells.__doc__

    def gain(self) -> FloatArray:
        """single_error_m / error_m."""
        return self.single_error_m / self.error_m


@dataclass(frozen=True)
class MultipathMaps:
    """Multipath errors at one signal level.

    Attributes
    ----------
    signal_e_per_s : float
        S1.
    points : MultipathCells, shape (ratios, delays)
        For second returns.
    tails : MultipathCells, shape (ratios, tails)
    single : MultipathCells, shape ()
        Without a second return: the loss due to two-return decoding.
    single_by_tail : MultipathCells, shape ()
        The same for tail decoding, with the middle tail.
    """

    signal_e_per_s: float
    points: MultipathCells
    tails: MultipathCells
    single: MultipathCells
    single_by_tail: MultipathCells


@dataclass(frozen=True)
class MultipathErrorReport:
    """Multipath errors of a code.

    Attributes
    ----------
    code : str
    measurements : int
    why_no_two_returns, why_no_tail : str
        Empty if the code supports that decoding.
    maps : list of MultipathMaps
        One per signal level.
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
    """Computes bias and error of single-path, two-return and tail decoding, with the camera's
    noise.

    Parameters
    ----------
    code : CodeSet, name of a family or file
    camera : Camera or its name
    progress : callable, optional
    **options
        As in MultipathErrorOptions; `decoding` as `multipath` of Decoder, without tail_m.
    """
    values = _tofsmith.multipath_error(
        *handles_of(code, camera), dict(options), _check.progress(progress))
    maps = [_maps(m) for m in values.pop("maps")]
    return MultipathErrorReport(**values, maps=maps)


class MultipathBound:
    """Cramer-Rao bound on the direct depth with multipath. Two-return decoding is only useful where
    this bound is below the bias of single-path decoding.

    Parameters
    ----------
    code : CodeSet, name of a family or file
    camera : Camera or its name
    """

    def __init__(self, code: CodeLike, camera: CameraLike) -> None:
        self._handle = _tofsmith.MultipathBound(*handles_of(code, camera))

    def sigma_m(
        self, signal_e_per_s: float, ambient_e_per_s: float, ratio: float, delay_m: float
    ) -> FloatArray:
        """Returns the minimum standard deviation of the direct depth [m] at the centre of each bin
        (N,), with (z, delta, S1, S2, A) unknown."""
        second = _check.number(ratio, "ratio"), _check.number(delay_m, "delay_m")
        return self._handle.sigma_m(*light_of(signal_e_per_s, ambient_e_per_s), *second)

    def tail_sigma_m(
        self, signal_e_per_s: float, ambient_e_per_s: float, tail: ExponentialTail
    ) -> FloatArray:
        """Returns the same for a tail of known mean delay, (N,)."""
        _check.instance(tail, ExponentialTail, "tail")
        light = light_of(signal_e_per_s, ambient_e_per_s)
        return self._handle.tail_sigma_m(*light, tail.mean_delay_m, tail.ratio)

    def mae_m(self, sigma_m: npt.ArrayLike) -> float:
        """Returns the mean absolute error over depth [m]: the mean of sqrt(2 / pi) sigma, limited
        to a quarter of the range at each depth."""
        return self._handle.mae_m(np.asarray(_check.real_array(sigma_m, "sigma_m", "(N,)"), float))


def single_path_bias_m(ratio: float, delay_m: float) -> float:
    """Returns ratio delay_m / (1 + ratio) [m], the bias of single-path decoding with any code due
    to a second return with a delay below the resolution of the correlation functions."""
    return _tofsmith.single_path_bias_m(
        _check.number(ratio, "ratio"), _check.number(delay_m, "delay_m")
    )

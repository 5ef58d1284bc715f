# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Factorization of correlation functions into pairs of waveforms."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Optional, Unpack

from . import _check, _tofsmith
from ._camera import CameraLike, camera_of
from ._check import FloatArray, Progress
from ._design import Target, target_of
from ._option_fields import FactorizeOptions
from ._options import takes
from ._results import result_of
from ._waveform import Waveform


@dataclass(frozen=True)
class FactorizedPair:
    """A pair of waveforms that a camera can generate, and its distance from the target.

    Attributes
    ----------
    modulation, demodulation : Waveform
    residual_rms : float
        Root mean square over depth of its correlation function minus the target, with linear
        interpolation between bins.
    start : str
        Start of the search, such as "random 3".
    iterations : int
        Pairs of convex steps.
    """

    modulation: Waveform
    demodulation: Waveform
    residual_rms: float
    start: str
    iterations: int


@dataclass(frozen=True)
class Factorization:
    """Result of factorizing one correlation function.

    Attributes
    ----------
    target : ndarray, shape (N,)
    pairs : list of FactorizedPair
        Distinct, smallest residual first; never empty.
    iterations_per_start : list of int
        Pairs of convex steps of every random start.
    target_variation_rms : float
        Root mean square of the target about its mean.
    message : str
    """

    target: FloatArray
    pairs: list[FactorizedPair]
    iterations_per_start: list[int]
    target_variation_rms: float
    message: str

    @property
    def best(self) -> FactorizedPair:
        return self.pairs[0]


@dataclass(frozen=True)
class Alternation:
    """One run of the alternation of convex steps; arrays have one entry per pair of steps.

    Attributes
    ----------
    relaxed : tuple of Waveform
        Modulation and demodulation after the last step, N samples each.
    playable : tuple of Waveform
        Best projection of all steps to waveforms that the camera can generate.
    objective, relaxed_residual_rms, playable_residual_rms : ndarray
    """

    relaxed: tuple[Waveform, Waveform]
    playable: tuple[Waveform, Waveform]
    objective: FloatArray
    relaxed_residual_rms: FloatArray
    playable_residual_rms: FloatArray


@takes(FactorizeOptions)
def factorize(
    target: Target,
    camera: CameraLike,
    *,
    measurements: Optional[Sequence[int]] = None,
    normalize: bool = False,
    seed: int = 1,
    progress: Progress = None,
    **options: Unpack[FactorizeOptions],
) -> list[Factorization]:
    """Finds waveforms whose correlation functions on the camera approximate given ones.

    Parameters
    ----------
    target : str, path, CodeSet or ndarray (N, K)
        As in design(): correlation functions, or a family, code or file with them.
    camera : Camera or its name
    measurements : sequence of int, optional
        Columns to factorize, counted from 0. None: all.
    normalize : bool
        Rescale the columns of a table to [0, 1].
    seed : int
        Seed of the random starts.
    progress : callable, optional
    **options
        As in FactorizeOptions.

    Returns
    -------
    list of Factorization
        One per measurement.

    Raises
    ------
    ValueError
        For invalid options or a target that does not fit the camera.

    Notes
    -----
    Solves problems (6) and (7) of Gutierrez-Barragan et al., CVPR 2019.

    Examples
    --------
    >>> found = factorize("hamiltonian-k3", "paper-30x", measurements=[0], random_starts=4)
    >>> found[0].best.residual_rms < 1e-6
    True
    """
    camera = camera_of(camera)
    targets = target_of(target, camera, normalize)
    callback = _check.progress(progress)
    given: dict[str, Any] = {**options, "seed": seed}
    chosen = range(_tofsmith.number_of_targets(targets)) if measurements is None else [
        _measurement(each, targets) for each in measurements]
    results = []
    for index in chosen:
        found = _tofsmith.factorize(targets, index, camera._handle, given, callback)
        results.append(result_of(Factorization, found))
    return results


def alternate(
    target: Target,
    camera: CameraLike,
    *,
    measurement: int,
    total_variation_weight: float,
    start: int = 0,
    normalize: bool = False,
    seed: int = 1,
    **options: Unpack[FactorizeOptions],
) -> Alternation:
    """Runs the alternation of factorize() once, without refining switching times afterwards.

    Parameters
    ----------
    target, camera, normalize, seed
        As in factorize().
    measurement : int
        Column of the target, counted from 0.
    total_variation_weight : float
        lambda of problem (6); 0 omits total variation.
    start : int
        Number of the random start.
    **options
        max_iterations, objective_tolerance and feed_back_projection as in factorize().
    """
    camera = camera_of(camera)
    targets = target_of(target, camera, normalize)
    weight = _check.number(total_variation_weight, "total_variation_weight")
    given: dict[str, Any] = {**options, "seed": seed}
    values = _tofsmith.alternate(
        targets, _measurement(measurement, targets), camera._handle,
        _check.whole(start, "start", 0), weight, given)
    return result_of(Alternation, values)


def _measurement(index: int, targets: _tofsmith.TargetSet) -> int:
    return _check.whole(index, "measurement", 0, _tofsmith.number_of_targets(targets) - 1)

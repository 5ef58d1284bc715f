# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Depth error of codes."""

from __future__ import annotations

from typing import Optional, Unpack

from . import _check, _tofsmith
from ._camera import CameraLike, camera_of
from ._check import FloatArray, Progress
from ._code import CodeLike, code_of
from ._decoding_table import DecodingTable
from ._option_fields import EvaluateOptions, RobustnessOptions
from ._options import takes
from ._reports import DepthErrorReport, GeneratorLoss, RobustnessReport, report_of


@takes(EvaluateOptions)
def evaluate(
    code: CodeLike,
    camera: CameraLike,
    *,
    progress: Progress = None,
    **options: Unpack[EvaluateOptions],
) -> DepthErrorReport:
    """Monte Carlo depth error at every operating point of the camera, with bounds beside it.

    Parameters
    ----------
    code : CodeSet, name of a family or file
    camera : Camera or its name
    progress : callable, optional
    **options
        As EvaluateOptions.

    Raises
    ------
    ValueError
        If the code does not fit, the method cannot decode it, or an option breaks a rule.
    """
    camera = camera_of(camera)
    handle = code_of(code, camera)._handle
    callback = _check.progress(progress)
    values = _tofsmith.evaluate(handle, camera._handle, dict(options), callback)
    return report_of(values, camera)


def best_rotation(
    code: CodeLike,
    camera: CameraLike,
    *,
    trials: Optional[int] = None,
    seed: Optional[int] = None,
    progress: Progress = None,
) -> tuple[int, FloatArray]:
    """The origin of depth with the least linear error.

    Returns
    -------
    rotation_bin : int
        CodeSet.rotated() by so many bins is best.
    linear_geometric_mean_m : ndarray, shape (N,)
        For each rotation, geometric mean over the operating points [m].
    """
    camera = camera_of(camera)
    options = {"trials": trials, "seed": seed}
    handle = code_of(code, camera)._handle
    callback = _check.progress(progress)
    return _tofsmith.best_rotation(handle, camera._handle, options, callback)


@takes(EvaluateOptions)
def generator_loss(
    code: CodeLike,
    camera: CameraLike,
    *,
    progress: Progress = None,
    **options: Unpack[EvaluateOptions],
) -> GeneratorLoss:
    """What the limits of a camera's waveform generators do to a code.

    Parameters
    ----------
    code : CodeSet, name of a family or file
    camera : Camera or its name
        With generators, such as "prototype"; the camera without them has the nominal waveforms.
    progress : callable, optional
    **options
        As EvaluateOptions.
    """
    camera = camera_of(camera)
    handle = code_of(code, camera)._handle
    callback = _check.progress(progress)
    values = _tofsmith.generator_loss(handle, camera._handle, dict(options), callback)
    nominal, actual, uncalibrated = (
        report_of(values[name], camera) for name in ("nominal", "actual", "uncalibrated")
    )
    return GeneratorLoss(nominal, actual, uncalibrated, values["correlation_change"])


def table_depth_error_m(
    table: DecodingTable,
    signal: float,
    ambient_e_per_s: float,
    *,
    trials: int = 20000,
    seed: int = 1,
) -> tuple[float, float]:
    """Mean circular depth error of a table on frames made from itself, so that measured tables
    stand beside codes.

    Parameters
    ----------
    table : DecodingTable
    signal : float
        In multiples of what the table was measured with; of a code's table S [e/s].
    ambient_e_per_s : float
    trials, seed : int

    Returns
    -------
    error_m, standard_error_m : float
    """
    handle = _check.instance(table, DecodingTable, "table")._handle
    light = _check.number(signal, "signal"), _check.number(ambient_e_per_s, "ambient_e_per_s")
    counts = _check.whole(trials, "trials", 2, 2**32), _check.whole(seed, "seed", 0, 2**64 - 1)
    return _tofsmith.table_depth_error_m(handle, *light, *counts)


@takes(RobustnessOptions)
def robustness(
    code: CodeLike,
    camera: CameraLike,
    *,
    progress: Progress = None,
    **options: Unpack[RobustnessOptions],
) -> RobustnessReport:
    """Judges a code on perturbations of its camera; see docs/robustness.md.

    Parameters
    ----------
    code : CodeSet, name of a family or file
    camera : Camera or its name
    progress : callable, optional
    **options
        As RobustnessOptions.
    """
    camera = camera_of(camera)
    handle = code_of(code, camera)._handle
    callback = _check.progress(progress)
    values = _tofsmith.robustness(handle, camera._handle, dict(options), callback)
    return RobustnessReport(**values)

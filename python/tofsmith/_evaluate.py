# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Depth error of codes."""

from __future__ import annotations

from typing import Any, Optional

from . import _check, _tofsmith
from ._camera import CameraLike, camera_of
from ._check import FloatArray, Progress
from ._code import CodeLike, code_of
from ._decoding_table import DecodingTable
from ._reports import DepthErrorReport, GeneratorLoss, RobustnessReport, report_of


def evaluate(
    code: CodeLike,
    camera: CameraLike,
    *,
    trials: Optional[int] = None,
    seed: Optional[int] = None,
    outlier_threshold_m: Optional[float] = None,
    sub_bin: Optional[bool] = None,
    depth: Optional[str] = None,
    clip_to_open_sensor: Optional[bool] = None,
    method: Optional[str] = None,
    unwrap_weights: Optional[str] = None,
    target_standard_error: Optional[float] = None,
    max_trials: Optional[int] = None,
    draw_every_measurement: Optional[bool] = None,
    bounds: Optional[bool] = None,
    progress: Progress = None,
) -> DepthErrorReport:
    """Monte Carlo depth error at every operating point of the camera, with bounds beside it.

    Parameters
    ----------
    code : CodeSet, name of a family or file
    camera : Camera or its name
    trials : int, optional
        Per operating point (20000); with a target: at first.
    seed : int, optional
        Of all trials (1): codes are compared on the same depths and noise.
    outlier_threshold_m : float, optional
        Circular errors beyond are outliers [m] (0.5).
    sub_bin : bool, optional
        Decode between bins (True).
    depth : {"uniform", "bins"}, optional
        Where true depths lie; bins flatters codes.
    clip_to_open_sensor : bool, optional
        Clip electrons to [0, T (S + A)] (False), as the paper's authors' simulator does.
    method, unwrap_weights : str, optional
        As of Decoder.
    target_standard_error : float, optional
        Trials go on at a point until the standard error is at most this share of the error that the
        camera is judged by; 0 (the default): no target.
    max_trials : int, optional
        Per operating point with a target (50e6).
    draw_every_measurement : bool, optional
        Draw the noise of every measurement even where it could be drawn in the plane that ZNCC
        looks at (False): so methods are compared on the same noise.
    bounds : bool, optional
        Also compute the bounds (True); else they are 0.
    progress : callable, optional

    Raises
    ------
    ValueError
        If the code does not fit, the method cannot decode it, or an option breaks a rule.
    """
    camera = camera_of(camera)
    options = {
        "trials": trials,
        "seed": seed,
        "outlier_threshold_m": outlier_threshold_m,
        "sub_bin": sub_bin,
        "depth": depth,
        "clip_to_open_sensor": clip_to_open_sensor,
        "method": method,
        "unwrap_weights": unwrap_weights,
        "target_standard_error": target_standard_error,
        "max_trials": max_trials,
        "draw_every_measurement": draw_every_measurement,
        "bounds": bounds,
    }
    handle = code_of(code, camera)._handle
    callback = _check.progress(progress)
    return report_of(_tofsmith.evaluate(handle, camera._handle, options, callback), camera)


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


def generator_loss(
    code: CodeLike, camera: CameraLike, *, progress: Progress = None, **options: Any
) -> GeneratorLoss:
    """What the limits of a camera's waveform generators do to a code.

    Parameters
    ----------
    code : CodeSet, name of a family or file
    camera : Camera or its name
        With generators, such as "prototype"; the camera without them has the nominal waveforms.
    progress : callable, optional
    **options
        As of evaluate(): trials, seed, method, ..
    """
    camera = camera_of(camera)
    handle = code_of(code, camera)._handle
    callback = _check.progress(progress)
    values = _tofsmith.generator_loss(handle, camera._handle, options, callback)
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


def robustness(
    code: CodeLike, camera: CameraLike, *, progress: Progress = None, **options: Any
) -> RobustnessReport:
    """Judges a code on perturbations of its camera.

    Parameters
    ----------
    code : CodeSet, name of a family or file
    camera : Camera or its name
    progress : callable, optional
    **options
        bandwidth (0.2), peak (0.1), edge_jitter_s (50e-12), tap_mismatch (0.02), clock_s (0), droop
        (0), together (False), trials (4000), seed (1), method, unwrap_weights; 0 leaves a change
        out. See docs/robustness.md.
    """
    camera = camera_of(camera)
    handle = code_of(code, camera)._handle
    callback = _check.progress(progress)
    return RobustnessReport(**_tofsmith.robustness(handle, camera._handle, options, callback))

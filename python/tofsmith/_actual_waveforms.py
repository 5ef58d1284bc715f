# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Actual waveforms of a camera: effects of its generators and impulse responses."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional

from . import _check, _tofsmith
from ._camera import CameraLike, camera_of
from ._check import FloatArray
from ._code import CodeLike, handles_of
from ._waveform import Waveform


@dataclass(frozen=True)
class GeneratorReport:
    """Nominal and actual properties of one waveform on its generator.

    Attributes
    ----------
    arm : {"light", "sensor"}
    index : int
        Exposure (light) or tap value (sensor), from 0.
    points_per_period : int
    clock_hz : float
        Points per second.
    duty_nominal, duty_actual, mean_nominal, mean_actual, peak_nominal, peak_actual : float
    edges_nominal, edges_actual : int
    rms_difference : float
        Root mean square over the period of actual minus nominal waveform.
    largest_edge_move_s : float, optional
        Largest displacement of a switching time [s]; None for a waveform that is not binary.
    """

    arm: str
    index: int
    points_per_period: int
    clock_hz: float
    duty_nominal: float
    duty_actual: float
    mean_nominal: float
    mean_actual: float
    peak_nominal: float
    peak_actual: float
    edges_nominal: int
    edges_actual: int
    rms_difference: float
    largest_edge_move_s: Optional[float]


def generator_report(code: CodeLike, camera: CameraLike) -> list[GeneratorReport]:
    """Compares nominal and actual waveforms of a code on the camera's generators.

    Parameters
    ----------
    code : CodeSet, name of a family or file
    camera : Camera or its name

    Returns
    -------
    list of GeneratorReport
        One for each waveform of a generator, light first; empty without generators.

    Raises
    ------
    ValueError
        If the code does not fit the camera.
    """
    reports = _tofsmith.generator_report(*handles_of(code, camera))
    return [GeneratorReport(**report) for report in reports]


def actual_waveforms(code: CodeLike, camera: CameraLike) -> tuple[list[Waveform], list[Waveform]]:
    """Returns the waveforms of the camera's generators, before its impulse responses.

    Parameters
    ----------
    code : CodeSet, name of a family or file
    camera : Camera or its name

    Returns
    -------
    modulation : list of Waveform
        One per exposure.
    demodulation : list of Waveform
        One per tap value.

    Raises
    ------
    ValueError
        If the generator cannot generate a pulse of a modulation.
    """
    arms = _tofsmith.actual_waveforms(*handles_of(code, camera))
    modulation, demodulation = ([Waveform._of(handle) for handle in arm] for arm in arms)
    return modulation, demodulation


def arm_output(
    waveform: Waveform, camera: CameraLike, *, arm: str, points: Optional[int] = None
) -> FloatArray:
    """Returns a waveform convolved with the impulse response of an arm of the camera.

    Parameters
    ----------
    waveform : Waveform
    camera : Camera or its name
    arm : {"light", "sensor"}
    points : int, optional
        Values per period, at t = j / points; None: the camera's samples.

    Returns
    -------
    ndarray, shape (points,)
        Without impulse response: averages over the cells [j, j + 1) / points.
    """
    camera = camera_of(camera)
    handle = _check.instance(waveform, Waveform, "waveform")._handle
    is_light = _check.one_of(arm, "arm", ("light", "sensor")) == "light"
    count = camera.samples if points is None else _check.whole(points, "points", 1, 2**24)
    return _tofsmith.arm_output(handle, camera._handle, is_light, count)

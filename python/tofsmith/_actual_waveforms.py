# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Actual waveforms of a camera: effects of its generators and impulse responses."""

from __future__ import annotations

from typing import Optional

from . import _check, _tofsmith
from ._camera import CameraLike, camera_of
from ._check import FloatArray
from ._code import CodeLike, handles_of
from ._result_fields import GeneratorReport
from ._waveform import Waveform


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

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Dependence of depth and signal on the temperature of a camera; docs/calibration.md."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from . import _check, _tofsmith
from ._camera import Camera, CameraLike, camera_of
from ._check import Path, Progress
from ._code import CodeLike, code_of
from ._reports import Estimate


@dataclass(frozen=True)
class SensorDrift:
    """Part of the drift that follows the temperature of the sensor; see TemperatureDrift."""

    mean_c: float
    offset_m_per_c: Estimate
    signal_per_c: Estimate
    temperature_c: list[float]


@dataclass(frozen=True)
class TemperatureDrift:
    """Drift of depth and signal with temperature.

    Attributes
    ----------
    mean_c : float
        Mean of the frames [degrees C], the origin of both lines.
    offset_m_per_c, signal_per_c : Estimate
        Change of the measured depth per degree [m]; d log(signal) per degree. A 95 % interval is +-
        `interval_factor` standard errors.
    offset_m_per_c2, signal_per_c2 : Estimate
        Second-order terms, in addition to the lines.
    interval_factor : float
    offset_rms_m, signal_rms : float
        Deviation of the frames from the lines [m]; the same for log(signal).
    temperature_c, offset_m, log_signal : list of float
        For each frame [degrees C]; offset relative to the mean of all frames [m]; the same for
        log(signal).
    pixels : int
        Number of pixels that decode in every frame.
    notes : list of str
    sensor : SensorDrift or None
        Drift with the temperature of the sensor, if it was fitted. The other attributes then refer
        to the temperature of the light source.
    hysteresis_m : Estimate or None
        Offset while the temperature rises, minus the offset while it falls [m]; None if it does not
        do both.
    """

    mean_c: float
    offset_m_per_c: Estimate
    signal_per_c: Estimate
    offset_m_per_c2: Estimate
    signal_per_c2: Estimate
    interval_factor: float
    offset_rms_m: float
    signal_rms: float
    temperature_c: list[float]
    offset_m: list[float]
    log_signal: list[float]
    pixels: int
    notes: list[str]
    sensor: Optional[SensorDrift]
    hysteresis_m: Optional[Estimate]
    _handle: _tofsmith.TemperatureDrift = field(repr=False, compare=False)

    def camera(
        self,
        camera: CameraLike,
        *,
        reference_c: Optional[float] = None,
        sensor_reference_c: Optional[float] = None,
    ) -> Camera:
        """Return the camera with this drift.

        Parameters
        ----------
        camera : Camera or its name
        reference_c : float, optional
            Temperature of the other calibrations, at which nothing changes [degrees C]; None: the
            mean of the frames.
        sensor_reference_c : float, optional
            The same for the temperature of the sensor.
        """
        reference = _check.optional_number(reference_c, "reference_c")
        sensor_reference = _check.optional_number(sensor_reference_c, "sensor_reference_c")
        return Camera._of(
            self._handle.camera(camera_of(camera)._handle, reference, sensor_reference))

    def write_report(
        self, path: Path, *, source: str = "frames", overwrite: bool = False
    ) -> None:
        """Writes the page of `tofsmith calibrate temperature --report` (.html)."""
        self._handle.write_report(
            _check.path(path), _check.text(source, "source"), bool(overwrite)
        )


def calibrate_temperature(
    frames: npt.ArrayLike,
    temperature_c: npt.ArrayLike,
    code: CodeLike,
    camera: CameraLike,
    *,
    sensor_temperature_c: Optional[npt.ArrayLike] = None,
    progress: Progress = None,
) -> TemperatureDrift:
    """Determine the drift with temperature from frames of a static scene.

    Parameters
    ----------
    frames : array_like, shape (F, H, W, K)
        At least 5 frames.
    temperature_c : array_like, shape (F,)
        Temperature of each frame [degrees C]: that of the light source if `sensor_temperature_c`
        is given.
    code : CodeSet, name of a family or file
        Code of the frames.
    camera : Camera or its name
        Its own drift is ignored.
    sensor_temperature_c : array_like, shape (F,), optional
        Temperature of the sensor at each frame [degrees C]. Drifts with both temperatures are
        fitted together, from at least 6 frames.
    progress : callable, optional
        Called with (fraction, step); returning False cancels.

    Raises
    ------
    ValueError
        If the number of temperatures differs from that of frames, if they are not finite or all
        equal, or if no pixel decodes in every frame.

    Examples
    --------
    >>> found = calibrate_temperature(frames, degrees, "sinusoid-k4", camera)  # doctest: +SKIP
    >>> warm = found.camera(camera, reference_c=25.0).at_temperature(41.5)  # doctest: +SKIP
    >>> image = decode(raw, "sinusoid-k4", warm)  # doctest: +SKIP
    """
    camera = camera_of(camera)
    degrees = _degrees(temperature_c, "temperature_c")
    sensor_degrees = ([] if sensor_temperature_c is None
                      else _degrees(sensor_temperature_c, "sensor_temperature_c"))
    handle = _tofsmith.calibrate_temperature(
        _check.frames(frames, "frames"), degrees, sensor_degrees, code_of(code, camera)._handle,
        camera._handle, _check.progress(progress))
    fields = _with_estimates(handle.fields())
    if fields["sensor"] is not None:
        fields["sensor"] = SensorDrift(**_with_estimates(fields["sensor"]))
    return TemperatureDrift(**fields, _handle=handle)


def _degrees(temperatures: npt.ArrayLike, name: str) -> list[float]:
    degrees = np.asarray(temperatures, float)
    if degrees.ndim != 1:
        raise ValueError(f"{name}: got {_check.shown(temperatures)}; needs numbers of shape (F,)")
    return [float(c) for c in degrees]


def _with_estimates(fields: dict[str, Any]) -> dict[str, Any]:
    return {name: Estimate(*value) if isinstance(value, tuple) else value
            for name, value in fields.items()}

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""How depth and signal change with a camera's temperature; docs/calibration.md."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Optional

import numpy as np
import numpy.typing as npt

from . import _check, _tofsmith
from ._camera import Camera, CameraLike, camera_of
from ._check import Path, Progress
from ._code import CodeLike, code_of
from ._reports import Estimate


@dataclass(frozen=True)
class TemperatureDrift:
    """Drift of depth and signal with temperature.

    Attributes
    ----------
    mean_c : float
        Of the frames [degrees C]: where both lines were laid.
    offset_m_per_c, signal_per_c : Estimate
        By how much depth reads farther per degree [m]; d log(signal) per degree. A 95 % interval is
        +- `interval_factor` standard errors.
    offset_m_per_c2, signal_per_c2 : Estimate
        Second-order terms beside the lines.
    interval_factor : float
    offset_rms_m, signal_rms : float
        Of the frames around the lines [m]; of log(signal).
    temperature_c, offset_m, log_signal : list of float
        Of each frame [degrees C]; against the mean of all frames [m]; likewise.
    pixels : int
        That decode in every frame.
    notes : list of str
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
    _handle: _tofsmith.TemperatureDrift = field(repr=False, compare=False)

    def camera(self, camera: CameraLike, *, reference_c: Optional[float] = None) -> Camera:
        """The camera that changes so.

        Parameters
        ----------
        camera : Camera or its name
        reference_c : float, optional
            Where it was calibrated otherwise, so that nothing changes there [degrees C]; None: the
            mean of the frames.
        """
        reference = None if reference_c is None else _check.number(reference_c, "reference_c")
        return Camera._of(self._handle.camera(camera_of(camera)._handle, reference))

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
    progress: Progress = None,
) -> TemperatureDrift:
    """Drift with temperature from frames of a scene that stands still.

    Parameters
    ----------
    frames : array_like, shape (F, H, W, K)
        At least 5.
    temperature_c : array_like, shape (F,)
        Of each frame [degrees C].
    code : CodeSet, name of a family or file
        That the camera played.
    camera : Camera or its name
        A drift that it has already says nothing.
    progress : callable, optional
        Called with (fraction, step); False stops.

    Raises
    ------
    ValueError
        If temperatures are not as many as frames, not finite or all the same, or no pixel decodes
        in every frame.

    Examples
    --------
    >>> found = calibrate_temperature(frames, degrees, "sinusoid-k4", camera)  # doctest: +SKIP
    >>> warm = found.camera(camera, reference_c=25.0).at_temperature(41.5)  # doctest: +SKIP
    >>> image = decode(raw, "sinusoid-k4", warm)  # doctest: +SKIP
    """
    camera = camera_of(camera)
    degrees = np.asarray(temperature_c, float)
    if degrees.ndim != 1:
        raise ValueError(f"temperature_c: got {_check.shown(temperature_c)}; needs numbers of shape "
                         "(F,)")
    handle = _tofsmith.calibrate_temperature(
        _check.frames(frames, "frames"), [float(c) for c in degrees], code_of(code, camera)._handle,
        camera._handle, _check.progress(progress))
    fields = handle.fields()
    for name in ("offset_m_per_c", "signal_per_c", "offset_m_per_c2", "signal_per_c2"):
        fields[name] = Estimate(*fields[name])
    return TemperatureDrift(**fields, _handle=handle)

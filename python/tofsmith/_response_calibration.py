# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Impulse responses from bench measurements; see docs/calibration.md."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from typing import Any, Union, Unpack

import numpy.typing as npt

from . import _check, _tofsmith
from ._camera import Camera, CameraLike, camera_of
from ._camera_fields import ImpulseResponse
from ._check import Path
from ._option_fields import ResponseCalibrationOptions, ResponseRecordOptions
from ._options import takes
from ._result_fields import ParametricResponse
from ._results import Estimate, calibrated


@dataclass(frozen=True)
class ResponseRecord:
    """An instrument's record of a response, with a constant time step.

    Attributes
    ----------
    values : ndarray, shape (T,)
        In units of the instrument, T >= 16.
    time_step_s : float
        [s], > 0.
    start_time_s : float
        Time of the first value [s].
    counts : bool
        Values are photon counts, whose variance equals their mean.
    notes : list of str
    """

    values: npt.NDArray[Any]
    time_step_s: float
    start_time_s: float = 0.0
    counts: bool = False
    notes: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class CalibratedResponse:
    """Result of calibrate_impulse_response().

    Attributes
    ----------
    excitation : str
        Input of the arm: pulse or step.
    falling : bool
        Negative pulse, or a step down.
    background, height, noise_rms : float
        In units of the record: level before the response, height of pulse or step above it, noise
        outside the response.
    snr_db : float
        20 log10(height / noise).
    delay_s : float
        Centre of gravity of the response in the record [s].
    response : ImpulseResponse
        Denoised, of kind file. Its centre of gravity is `response_centre_s` [s] after its first
        sample.
    response_centre_s : float
    bandwidth_hz : Estimate
        -3 dB bandwidth of the measured response [Hz].
    fits : list of ParametricResponse
        By increasing residual.
    fit_is_good : bool
        The best fit agrees with the record within its noise.
    peaks : list of (time_s, height)
        Relative to the highest peak, by decreasing height.
    record : ResponseRecord
        As used.
    notes : list of str
    """

    excitation: str
    falling: bool
    background: float
    height: float
    noise_rms: float
    snr_db: float
    delay_s: float
    response: ImpulseResponse
    response_centre_s: float
    bandwidth_hz: Estimate
    fits: list[ParametricResponse]
    fit_is_good: bool
    peaks: list[tuple[float, float]]
    record: ResponseRecord
    notes: list[str]
    _handle: _tofsmith.CalibratedResponse = field(repr=False, compare=False)

    def camera(self, camera: CameraLike, *, arm: str = "light", kind: str = "file") -> Camera:
        """Returns the camera with the response in one of its arms.

        Parameters
        ----------
        camera : Camera or its name
            Camera to modify.
        arm : {"light", "sensor", "system"}
            Arm of the response; system: both together, stored as the light's.
        kind : {"file", "hann", "gaussian", "lowpass"}
            The measured response, or a fit.
        """
        handle = self._handle.camera(camera_of(camera)._handle, arm, kind)
        return Camera._of(handle)

    def write_camera(
        self,
        path: Path,
        camera: CameraLike,
        *,
        arm: str = "light",
        kind: str = "file",
        overwrite: bool = False,
    ) -> Camera:
        """Writes that camera (.toml) and, for kind file, NAME-response.csv next to it, as `tofsmith
        calibrate impulse-response -o`. Returns the camera read from the file.

        Raises
        ------
        OSError
            If a file exists and `overwrite` is not set, or cannot be written.
        """
        name = _check.path(path)
        base = camera_of(camera)._handle
        self._handle.write_camera(name, base, arm, kind, bool(overwrite))
        return Camera(name)

    def write_report(
        self, path: Path, *, source: str = "a record", overwrite: bool = False
    ) -> None:
        """Writes the page of `tofsmith calibrate impulse-response --report` (.html): record, fits,
        response and transfer function, with `source` in its title."""
        self._handle.write_report(
            _check.path(path), _check.text(source, "source"), bool(overwrite)
        )

    def __repr__(self) -> str:
        best = self.fits[0]
        return (
            f"<CalibratedResponse: a {self.excitation}, -3 dB at "
            f"{self.bandwidth_hz.value / 1e6:.4g} MHz; best fit {best.response.kind}, "
            f"{100 * best.residual_rms:.2g} % left>"
        )


@takes(ResponseRecordOptions)
def read_response_record(
    path: Path,
    **options: Unpack[ResponseRecordOptions],
) -> ResponseRecord:
    """Reads an oscilloscope record (text of times and values) or a histogram (.npy, values only).

    Parameters
    ----------
    path : str or path
    **options
        As in ResponseRecordOptions.

    Raises
    ------
    OSError
        Naming file and line if it is not a record.
    """
    return ResponseRecord(**_tofsmith.read_response_record(_check.path(path), dict(options)))


@takes(ResponseCalibrationOptions)
def calibrate_impulse_response(
    record: Union[ResponseRecord, Path],
    camera: CameraLike,
    **options: Unpack[ResponseCalibrationOptions],
) -> CalibratedResponse:
    """Calibrates the impulse response of an arm from a record of its response to a pulse or step.

    Parameters
    ----------
    record : ResponseRecord, str or path
    camera : Camera or its name
        Its f0 and N are used: the step of the response is a period over a multiple of N.
    **options
        As in ResponseCalibrationOptions.

    Raises
    ------
    ValueError
        If no value exceeds the noise, or the record is invalid.
    OSError
        If a file cannot be read.

    Examples
    --------
    >>> found = calibrate_impulse_response("scope.csv", "paper-10f0")  # doctest: +SKIP
    >>> camera = found.camera("paper-10f0", arm="light")  # doctest: +SKIP
    """
    if isinstance(record, (str, os.PathLike)):
        record = read_response_record(record)
    if not isinstance(record, ResponseRecord):
        raise TypeError(
            f"record: got {_check.shown(record)}; needs a tofsmith.ResponseRecord or its file"
        )
    camera = camera_of(camera)
    values = _check.finite_array(record.values, "record.values", "(T,)")
    step_s = _check.number(record.time_step_s, "record.time_step_s")
    period_s = 1 / camera.fundamental_frequency_hz
    if not 0 < step_s <= period_s:
        raise ValueError(
            f"record.time_step_s: got {step_s:.4g} s; needs > 0 and at most the camera's period of "
            f"{period_s:.4g} s (time_unit_s=1e-9 reads nanoseconds)"
        )
    start_s = _check.number(record.start_time_s, "record.start_time_s")
    handle = _tofsmith.calibrate_impulse_response(
        values, step_s, start_s, bool(record.counts), record.notes, camera._handle, dict(options)
    )
    return calibrated(CalibratedResponse, handle)

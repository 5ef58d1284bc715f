# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Noise, stray light and temperature of a camera, from recordings; docs/calibration.md."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Optional, Union, Unpack

import numpy as np
import numpy.typing as npt

from . import _check, _result_fields, _tofsmith
from ._camera import Camera, CameraLike, camera_of
from ._check import Path, Progress, RawLike
from ._code import CodeLike, code_of
from ._decoding_table import DecodingTable, table_of
from ._option_fields import PhotonTransferOptions
from ._options import takes
from ._results import WithReport, calibrated


@dataclass(frozen=True)
class PhotonTransfer(_result_fields.PhotonTransfer):
    __doc__ = _result_fields.PhotonTransfer.__doc__
    _handle: _tofsmith.PhotonTransfer = field(repr=False, compare=False)

    def camera(self, camera: CameraLike) -> Camera:
        """Returns the camera with the calibrated gain, read noise, black level, bits and full
        well."""
        return Camera._of(self._handle.camera(camera_of(camera)._handle))

    def write_report(self, path: Path, *, overwrite: bool = False) -> None:
        """Writes the page of `tofsmith calibrate noise --report` (.html)."""
        self._handle.write_report(_check.path(path), bool(overwrite))


@takes(PhotonTransferOptions)
def photon_transfer(
    levels: Union[npt.ArrayLike, Sequence[npt.ArrayLike]],
    camera: CameraLike,
    *,
    dark: Optional[npt.ArrayLike] = None,
    code: Optional[CodeLike] = None,
    **options: Unpack[PhotonTransferOptions],
) -> PhotonTransfer:
    """Computes the noise of a sensor from pairs of frames with the same light.

    Parameters
    ----------
    levels : array_like, shape (F, H, W, K), or a list of such
        Two consecutive frames must have the same light. Different levels may be in one array or in
        several. Raw numbers of single taps, or differences.
    camera : Camera or its name
    dark : array_like, shape (F, H, W, K), optional
        Pairs of frames without active light.
    code : CodeSet, name of a family or file, optional
        Code of the recording; required for cameras that read differences, whose shot noise is
        computed from the code at the decoded depth. There must be no ambient light.
    **options
        As in PhotonTransferOptions.

    Raises
    ------
    ValueError
        If frames are not paired, sizes differ, the black level is unknown, the levels do not
        differ, or `code` is missing for a camera that reads differences.

    Examples
    --------
    >>> levels = [read_raw(f"level{i}.npy") for i in (1, 2, 3)]  # doctest: +SKIP
    >>> found = photon_transfer(levels, "paper-10f0", dark=read_raw("dark.npy"))  # doctest: +SKIP
    >>> camera = found.camera("paper-10f0")  # doctest: +SKIP
    """
    given: Sequence[Any] = levels if isinstance(levels, (list, tuple)) else [levels]
    frames = [_check.frames(level, f"levels[{i}]") for i, level in enumerate(given)]
    camera = camera_of(camera)
    reads_differences = camera.sensor.readout == "difference"
    if reads_differences != (code is not None):
        raise ValueError("code: got none; needs the code that the camera used, because the mean of "
                         "differences does not determine the shot noise"
                         if reads_differences else
                         "code: is only valid with cameras that read differences (sensor.readout)")
    code_handle = None if code is None else code_of(code, camera)._handle
    dark_frames = None if dark is None else _check.frames(dark, "dark")
    handle = _tofsmith.photon_transfer(frames, dark_frames, camera._handle, code_handle,
                                       dict(options))
    return calibrated(PhotonTransfer, handle)


@dataclass(frozen=True)
class CalibratedStrayLight(_result_fields.CalibratedStrayLight, WithReport):
    __doc__ = _result_fields.CalibratedStrayLight.__doc__
    _handle: _tofsmith.CalibratedStrayLight = field(repr=False, compare=False)

    def write(self, path: Path, *, overwrite: bool = False) -> None:
        """Writes the kernel (.npy .npz .exr .pfm), for `tofsmith decode --stray-light`."""
        self._handle.write(_check.path(path), bool(overwrite))


def calibrate_stray_light(
    frames: npt.ArrayLike,
    camera: CameraLike,
    *,
    dark: Optional[npt.ArrayLike] = None,
    progress: Progress = None,
) -> CalibratedStrayLight:
    """Calibrates stray light from frames of a small bright target on a black background.

    Parameters
    ----------
    frames : array_like, shape (F, H, W, K)
        Frames are averaged. Other bright objects are mistaken for stray light.
    camera : Camera or its name
        Its black level and saturation are used.
    dark : array_like, shape (F, H, W, K), optional
        Frames with the target covered.
    progress : callable, optional
        Called with (fraction, step); returning False cancels.

    Raises
    ------
    ValueError
        If nothing is bright, the target is saturated, has fewer than 4 pixels or more than a
        quarter of the image, or the background is not black.
    """
    dark_frames = None if dark is None else _check.frames(dark, "dark")
    handle = _tofsmith.calibrate_stray_light(
        _check.frames(frames, "frames"), dark_frames, camera_of(camera)._handle,
        _check.progress(progress))
    return calibrated(CalibratedStrayLight, handle)


def remove_stray_light(
    raw: RawLike,
    kernel: npt.ArrayLike,
    code: CodeLike | DecodingTable,
    camera: Optional[CameraLike] = None,
    *,
    layout: str = "interleaved",
) -> npt.NDArray[np.float32]:
    """Removes the light that a lens scatters from raw numbers, before decoding.

    Parameters
    ----------
    raw : ndarray, shape (H, W, K) or (F, H, W, K)
        As in Decoder.decode(). Saturated and invalid pixels are unchanged.
    kernel : array_like, shape (2 R + 1, 2 Q + 1)
        Share of a pixel's light that is scattered to each other pixel, as
        CalibratedStrayLight.kernel. Values >= 0 with a sum below 0.5.
    code : CodeSet, DecodingTable, name of a family or file
        As in Decoder.
    camera : Camera or its name
        Required unless `code` is a DecodingTable.
    layout : {"interleaved", "planar"}
        Not inferred from the shape.

    Returns
    -------
    ndarray of float32, shape (H, W, K) or (F, H, W, K)
        With about the noise of `raw`.

    Raises
    ------
    ValueError
        For invalid shapes or shares.
    """
    array, is_planar = _check.raw_array(raw, layout)
    return _tofsmith.without_stray_light(
        table_of(code, camera)._handle, array, is_planar, np.asarray(kernel, np.float32))


@dataclass(frozen=True)
class TemperatureDrift(_result_fields.TemperatureDrift, WithReport):
    __doc__ = _result_fields.TemperatureDrift.__doc__
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
    return calibrated(TemperatureDrift, handle)


def _degrees(temperatures: npt.ArrayLike, name: str) -> list[float]:
    degrees = np.asarray(temperatures, float)
    if degrees.ndim != 1:
        raise ValueError(f"{name}: got {_check.shown(temperatures)}; needs numbers of shape (F,)")
    return [float(c) for c in degrees]

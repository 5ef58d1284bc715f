# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Correlation functions, pixel maps and ideal codes from delay sweeps; docs/calibration.md."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Optional, Union, Unpack, overload

import numpy as np
import numpy.typing as npt

from . import _check, _result_fields, _tofsmith
from ._camera import Camera, CameraLike, camera_of
from ._check import FloatArray, Path, Progress
from ._code import CodeLike, code_of
from ._decoding_table import DecodingTable
from ._depth_calibration import CalibratedDepth, calibrate_depth
from ._option_fields import DelaySweepOptions
from ._options import takes
from ._results import Estimate, calibrated


@dataclass(frozen=True)
class DelaySweep:
    """Frames of a flat target at known delays that cover a whole period, in order of time.

    Attributes
    ----------
    delay_periods : ndarray, shape (F,)
        One per frame, in periods of f0; any real number.
    frames : ndarray, shape (F, H, W, K)
        Raw numbers; H = W = 1 for a table of means.
    notes : list of str
    """

    delay_periods: npt.NDArray[Any]
    frames: npt.NDArray[Any]
    notes: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class DeadPixels(_result_fields.DeadPixels):
    __doc__ = _result_fields.DeadPixels.__doc__

    @property
    def total(self) -> int:
        return self.not_a_number + self.constant + self.saturated + self.low


@dataclass(frozen=True)
class CalibratedCorrelation:
    """Result of calibrate_correlation() from a delay sweep.

    Attributes
    ----------
    correlation, standard_error : ndarray, shape (N, K)
        Correlation functions of the average pixel [raw numbers], with row n at depth_bin = n, and
        their standard errors.
    model_error_percent : float
        Twice the standard errors in percent of the signal (root mean square), which a Decoder of
        decoding_table() tolerates.
    ambient_gain, exposure_s, black_level : ndarray, shape (K,) or (0,)
        As in a measured table; empty: the camera's.
    taps : int
    delay_offset_m, gain : ndarray of float32, shape (H, W) or (0, 0)
        Excess depth [m] of each pixel, with mean 0, and response, with mean 1; NaN for dead pixels.
        Decoder.decode() accepts both. Empty for a table of means.
    delay_error_m, gain_error : float
        Standard errors of delay and gain of a pixel.
    dead : DeadPixels
    light_drift, level_drift : Estimate, optional
        Relative change of the light and change of the level [raw numbers] during the sweep; None
        without repeated delays.
    drift_corrected : bool
    tap_mismatch : list of Estimate
        One per exposure with two taps.
    noise_rms : float
        Noise of a raw number [raw numbers].
    noise_source : str
        pixels, repeats or high harmonics.
    notes : list of str
    """

    correlation: FloatArray
    standard_error: FloatArray
    model_error_percent: float
    ambient_gain: FloatArray
    exposure_s: FloatArray
    black_level: FloatArray
    taps: int
    delay_offset_m: npt.NDArray[np.float32]
    gain: npt.NDArray[np.float32]
    delay_error_m: float
    gain_error: float
    dead: DeadPixels
    drift_corrected: bool
    light_drift: Optional[Estimate]
    level_drift: Optional[Estimate]
    tap_mismatch: list[Estimate]
    noise_rms: float
    noise_source: str
    notes: list[str]
    _handle: _tofsmith.CalibratedCorrelation = field(repr=False, compare=False)

    def decoding_table(self, camera: CameraLike) -> DecodingTable:
        """Returns the table for a Decoder, with the camera's range, exposure, noise and readout."""
        return DecodingTable._of(self._handle.decoding_table(camera_of(camera)._handle))

    def write_table(self, path: Path, *, overwrite: bool = False) -> None:
        """Writes the table (.npz), for `tofsmith decode --code` and read_measured_table()."""
        self._handle.write_table(_check.path(path), bool(overwrite))

    def write_maps(
        self,
        offset_map: Optional[Path] = None,
        gain_map: Optional[Path] = None,
        *,
        overwrite: bool = False,
    ) -> None:
        """Writes the maps of delay offset and gain (.npy .npz .exr .pfm), for `tofsmith decode
        --offset-map --gain-map`.

        Raises
        ------
        ValueError
            For a table of means, which has no pixels.
        """
        maps = (("offset", offset_map, self.delay_offset_m), ("gain", gain_map, self.gain))
        for name, path, values in maps:
            if path is None:
                continue
            if values.size == 0:
                raise ValueError(f"{name}_map: got a table of means, which has no pixels; needs a "
                                 "sweep of frames")
            _tofsmith.write_pixel_map(
                _check.path(path, f"{name}_map"), values, name, bool(overwrite)
            )

    def __repr__(self) -> str:
        n, k = self.correlation.shape
        return (
            f"<CalibratedCorrelation: {n} x {k}, noise {self.noise_rms:.3g} per number from "
            f"{self.noise_source}, {self.dead.total} dead pixels>"
        )


@takes(DelaySweepOptions)
def read_delay_sweep(
    path: Path,
    camera: CameraLike,
    **options: Unpack[DelaySweepOptions],
) -> DelaySweep:
    """Reads a delay sweep: a text with delay and K values per row, frames (F, H, W, K) with their
    shifts, or an array (N, K) with equal steps over one period.

    Parameters
    ----------
    path : str or path
        .csv .txt .npy .npz
    camera : Camera or its name
        Its f0, N and taps are used.
    **options
        As in DelaySweepOptions.

    Raises
    ------
    OSError
        Naming the file and the position of the error.
    """
    handle = camera_of(camera)._handle
    return DelaySweep(**_tofsmith.read_delay_sweep(_check.path(path), handle, dict(options)))


@overload
def calibrate_correlation(
    sweep: Union[DelaySweep, Path],
    camera: CameraLike,
    *,
    dark: Optional[npt.ArrayLike] = None,
    black_level: Optional[float] = None,
    saturation_level: Optional[float] = None,
    target_distance_m: Optional[float] = None,
    geometry_m: Optional[npt.ArrayLike] = None,
    reference: None = None,
    reference_kind: Optional[str] = None,
    code: None = None,
    progress: Progress = None,
) -> CalibratedCorrelation: ...


@overload
def calibrate_correlation(
    sweep: Union[Path, npt.ArrayLike],
    camera: CameraLike,
    *,
    reference: Union[Path, npt.ArrayLike],
    reference_kind: Optional[str] = None,
    code: CodeLike,
    progress: Progress = None,
) -> CalibratedDepth: ...


def calibrate_correlation(
    sweep: Any,
    camera: CameraLike,
    *,
    dark: Optional[npt.ArrayLike] = None,
    black_level: Optional[float] = None,
    saturation_level: Optional[float] = None,
    target_distance_m: Optional[float] = None,
    geometry_m: Optional[npt.ArrayLike] = None,
    reference: Optional[Union[Path, npt.ArrayLike]] = None,
    reference_kind: Optional[str] = None,
    code: Optional[CodeLike] = None,
    progress: Progress = None,
) -> Union[CalibratedCorrelation, CalibratedDepth]:
    """Calibrates the correlation functions of a camera, and delay and gain of every pixel, from a
    flat target at known delays.

    Parameters
    ----------
    sweep : DelaySweep, str or path
        A path is read by read_delay_sweep() with default options.
    camera : Camera or its name
        Camera of the recording: range, taps, readout, exposures.
    dark : array_like, shape (F, H, W, K), optional
        Frames without active light, otherwise with the conditions of the sweep.
    black_level, saturation_level : float, optional
        Raw number without light (instead of `dark`), and number at which values are clipped; None:
        the camera's.
    target_distance_m : float, optional
        Distance of a flat target perpendicular to the axis. Its geometry is subtracted from the
        offset map, which requires the camera's lens.
    geometry_m : array_like, shape (H, W), optional
        Alternative: depth of the target in each pixel minus that on the axis [m].
    reference : str or path, or array_like, shape (H, W), (F, H, W) or (F,), optional
        Alternative to delays: true radial depth of the frames [m], NaN where unknown, or one
        distance per frame. `sweep` is then frames (F, H, W, K) or their file, and the result is a
        CalibratedDepth with the error of `code`.
    reference_kind : {"radial", "z"}, optional
        Reference depth along the ray, or along the axis (requires the camera's lens); None: as the
        file states, or radial.
    code : CodeSet, name or file, optional
        Code of the recording; required with a reference.
    progress : callable, optional

    Raises
    ------
    ValueError
        If delays leave a gap in the period, sizes differ, or no live pixel is left.

    Examples
    --------
    >>> sweep = read_delay_sweep("frames.npy", camera, shifts="shifts.txt")  # doctest: +SKIP
    >>> found = calibrate_correlation(sweep, camera)  # doctest: +SKIP
    >>> decoder = Decoder(found.decoding_table(camera))  # doctest: +SKIP
    >>> image = decoder.decode(raw, delay_offset_m=found.delay_offset_m)  # doctest: +SKIP
    """
    camera = camera_of(camera)
    if reference is not None:
        if code is None:
            raise ValueError("code: got None; needs the code that the camera used")
        return calibrate_depth(sweep, camera, reference, code, reference_kind, progress)
    if isinstance(sweep, (str, os.PathLike)):
        sweep = read_delay_sweep(sweep, camera)
    _check.instance(sweep, DelaySweep, "sweep")
    if target_distance_m is not None and geometry_m is not None:
        raise ValueError("geometry_m: got it together with target_distance_m; needs one of them")
    options = {
        "black_level": black_level,
        "saturation_level": saturation_level,
        "target_distance_m": _check.optional_number(target_distance_m, "target_distance_m"),
    }
    handle = _tofsmith.calibrate_correlation(
        _check.finite_array(sweep.delay_periods, "sweep.delay_periods", "(F,)"),
        _check.frames(sweep.frames, "sweep.frames"),
        sweep.notes,
        camera._handle,
        None if dark is None else _check.frames(dark, "dark"),
        None if geometry_m is None else _check.real_array(geometry_m, "geometry_m", "(H, W)"),
        options,
        _check.progress(progress),
    )
    return calibrated(CalibratedCorrelation, handle)


@dataclass(frozen=True)
class IdealCodeFit(_result_fields.IdealCodeFit):
    __doc__ = _result_fields.IdealCodeFit.__doc__
    _handle: _tofsmith.IdealCodeFit = field(repr=False, compare=False)
    _found: _tofsmith.CalibratedCorrelation = field(repr=False, compare=False)

    def camera(self, camera: CameraLike) -> Camera:
        """Returns the camera with the fitted response in both arms and the measured tap
        mismatch."""
        return Camera._of(self._handle.camera(camera_of(camera)._handle, self._found))

    def __repr__(self) -> str:
        return (
            f"<IdealCodeFit {self.code}: {100 * self.residual:.2f} % residual "
            f"({100 * self.ideal_residual:.2f} % without a response)>"
        )


def fit_ideal_codes(
    found: CalibratedCorrelation,
    camera: CameraLike,
    codes: Optional[Sequence[CodeLike]] = None,
) -> list[IdealCodeFit]:
    """Fits ideal codes, with a common response of both arms, to a measured table; smallest residual
    first.

    Parameters
    ----------
    found : CalibratedCorrelation
    camera : Camera or its name
    codes : sequence of CodeSet, names or files, optional
        Codes to fit. None: all built-in codes with K measurements.

    Raises
    ------
    ValueError
        If no code has K measurements.
    """
    _check.instance(found, CalibratedCorrelation, "found")
    camera = camera_of(camera)
    handles = None
    if codes is not None:
        ideal = camera.replace(light={"peak_factor": 1e6})
        handles = [code_of(code, ideal)._handle for code in codes]
    fits = _tofsmith.fit_ideal_codes(found._handle, camera._handle, handles)
    return [calibrated(IdealCodeFit, handle, _found=found._handle) for handle in fits]


def write_correlation_report(
    path: Path,
    found: CalibratedCorrelation,
    fits: Sequence[IdealCodeFit] = (),
    *,
    source: str = "a sweep",
    overwrite: bool = False,
) -> None:
    """Writes the page of `tofsmith calibrate correlation --report`: table, codes, harmonics, maps.

    Parameters
    ----------
    path : str or path
        .html
    found : CalibratedCorrelation
    fits : sequence of IdealCodeFit
        As returned by fit_ideal_codes(); empty: without codes.
    source : str
        Name of the sweep in the title.
    overwrite : bool

    Raises
    ------
    OSError
        If the page exists and `overwrite` is not set, or cannot be written.
    """
    _check.instance(found, CalibratedCorrelation, "found")
    handles = [_check.instance(fit, IdealCodeFit, "fits")._handle for fit in fits]
    _tofsmith.write_correlation_report(
        _check.path(path), found._handle, handles, _check.text(source, "source"), bool(overwrite)
    )

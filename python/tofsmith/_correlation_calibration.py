# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Correlation functions and pixel maps from a flat target at known delays; docs/calibration.md."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from typing import Any, Optional, Union, overload

import numpy as np
import numpy.typing as npt

from . import _check, _tofsmith
from ._camera import CameraLike, camera_of
from ._check import FloatArray, Path, Progress
from ._code import CodeLike
from ._decoding_table import DecodingTable
from ._depth_calibration import CalibratedDepth, calibrate_depth
from ._reports import Estimate


@dataclass(frozen=True)
class DelaySweep:
    """Frames of a flat target at known delays that run through a whole period, in the order in
    which they were taken.

    Attributes
    ----------
    delay_periods : ndarray, shape (F,)
        Of each frame, in periods of f0; any real.
    frames : ndarray, shape (F, H, W, K)
        Raw numbers; H = W = 1 for a table of means.
    notes : list of str
    """

    delay_periods: npt.NDArray[Any]
    frames: npt.NDArray[Any]
    notes: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class DeadPixels:
    """Pixels left out, each counted once: not a number in some frame, the same number in all,
    clipped in some, responding with less than a tenth of the usual."""

    not_a_number: int
    constant: int
    saturated: int
    low: int

    @property
    def total(self) -> int:
        return self.not_a_number + self.constant + self.saturated + self.low


@dataclass(frozen=True)
class CalibratedCorrelation:
    """What is known of a camera by a sweep.

    Attributes
    ----------
    correlation, standard_error : ndarray, shape (N, K)
        Of the usual pixel [raw numbers]: row n at depth_bin = n; and the error of each value.
    model_error_percent : float
        Twice the standard errors, in percent of the signal, root mean squares. A Decoder of
        decoding_table() tolerates it.
    ambient_gain, exposure_s, black_level : ndarray, shape (K,) or (0,)
        As of a measured table; empty: the camera's.
    taps : int
    delay_offset_m, gain : ndarray of float32, shape (H, W) or (0, 0)
        Of each pixel: by how much it decodes too far [m], mean 0, and its response, mean 1; NaN:
        dead. Decoder.decode() takes both. Of a table of means there are none.
    delay_error_m, gain_error : float
        Standard errors of a usual pixel's.
    dead : DeadPixels
    light_drift, level_drift : Estimate, optional
        Change of the light over the sweep, as a share, and of the level [raw numbers]; None: no
        delay was measured twice.
    drift_corrected : bool
    tap_mismatch : list of Estimate
        Of each exposure of two taps.
    noise_rms : float
        Of one raw number [raw numbers].
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
        """What a Decoder takes, on a camera that says range, exposure, noise and read-out."""
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
        """Writes what differs from pixel to pixel (.npy .npz .exr .pfm), for `tofsmith decode
        --offset-map --gain-map`.

        Raises
        ------
        ValueError
            Of a table of means, which has no pixels.
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


def read_delay_sweep(
    path: Path,
    camera: CameraLike,
    *,
    shifts: Optional[Path] = None,
    unit: str = "s",
    decimal: Optional[str] = None,
    table_axes: Optional[str] = None,
    tap_order: Optional[str] = None,
    keep_end_point: bool = False,
) -> DelaySweep:
    """A delay sweep from a text (delay and K values per row), a stack of frames (F, H, W, K) with
    its shifts, or an array (N, K) of equal steps of one period.

    Parameters
    ----------
    path : str or path
        .csv .txt .npy .npz
    camera : Camera or its name
        Gives f0, N and taps.
    shifts : str or path, optional
        Delay of each frame of a stack: a text of one column, or .npy.
    unit : {"s", "ms", "us", "ns", "ps", "m", "bin", "period"}
        Of the delays.
    decimal : {"auto", "point", "comma"}, optional
    table_axes : {"nk", "kn"}, optional
        Of an array.
    tap_order : {"blocked", "interleaved"}, optional
        How the columns of an array run through several taps.
    keep_end_point : bool
        The last row of an array that repeats the first is one of its own.

    Raises
    ------
    OSError
        Naming file and place of what does not fit.
    """
    options = {
        "shifts": None if shifts is None else _check.path(shifts, "shifts"),
        "unit": unit,
        "decimal": decimal,
        "table_axes": table_axes,
        "tap_order": tap_order,
        "keep_end_point": keep_end_point,
    }
    handle = camera_of(camera)._handle
    return DelaySweep(**_tofsmith.read_delay_sweep(_check.path(path), handle, options))


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
    reference_kind: str = "radial",
    code: None = None,
    progress: Progress = None,
) -> CalibratedCorrelation: ...


@overload
def calibrate_correlation(
    sweep: Union[Path, npt.ArrayLike],
    camera: CameraLike,
    *,
    reference: Union[Path, npt.ArrayLike],
    reference_kind: str = "radial",
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
    reference_kind: str = "radial",
    code: Optional[CodeLike] = None,
    progress: Progress = None,
) -> Union[CalibratedCorrelation, CalibratedDepth]:
    """Correlation functions of a camera, and delay and gain of every pixel, from a flat target at
    known delays.

    Parameters
    ----------
    sweep : DelaySweep, str or path
        A path: as read_delay_sweep() reads it without options.
    camera : Camera or its name
        The one that took it: range, taps, read-out, exposures.
    dark : array_like, shape (F, H, W, K), optional
        Frames with the light off, the room as in the sweep.
    black_level, saturation_level : float, optional
        Raw number without light, where there are no dark frames, and from which on numbers are
        clipped; None: the camera's.
    target_distance_m : float, optional
        Of a flat target square to the axis, whose slant is taken out of the offset map; needs the
        camera's lens.
    geometry_m : array_like, shape (H, W), optional
        Instead: depth of the target in each pixel less that on the axis [m].
    reference : str or path, or array_like, shape (H, W), (F, H, W) or (F,), optional
        Instead of delays: depth along the ray that the frames should show [m], NaN where it is not
        known, or a distance for each frame. `sweep` then is frames (F, H, W, K) or their file, and
        what comes back is a CalibratedDepth: the error of `code` against it.
    reference_kind : {"radial", "z"}
        The reference is depth along the ray, or along the axis, which the camera's lens turns.
    code : CodeSet, name or file, optional
        With a reference: what the camera played.
    progress : callable, optional

    Raises
    ------
    ValueError
        If delays leave a gap in the period, sizes disagree, or no live pixel is left.

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
            raise ValueError("code: got None; needs the code that the camera played")
        return calibrate_depth(sweep, camera, reference, code, reference_kind, progress)
    if isinstance(sweep, (str, os.PathLike)):
        sweep = read_delay_sweep(sweep, camera)
    _check.instance(sweep, DelaySweep, "sweep")
    if target_distance_m is not None and geometry_m is not None:
        raise ValueError("geometry_m: got it beside target_distance_m; needs one of them")
    if target_distance_m is not None:
        target_distance_m = _check.number(target_distance_m, "target_distance_m")
    options = {
        "black_level": black_level,
        "saturation_level": saturation_level,
        "target_distance_m": target_distance_m,
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
    fields = handle.fields()
    fields["dead"] = DeadPixels(**fields["dead"])
    for name in ("light_drift", "level_drift"):
        fields[name] = None if fields[name] is None else Estimate(*fields[name])
    fields["tap_mismatch"] = [Estimate(*pair) for pair in fields["tap_mismatch"]]
    return CalibratedCorrelation(**fields, _handle=handle)

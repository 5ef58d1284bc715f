# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Gain, read noise, black level and full well from pairs of frames; see docs/calibration.md."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Optional, Union, Unpack

import numpy.typing as npt

from . import _check, _tofsmith
from ._camera import Camera, CameraLike, camera_of
from ._check import Path
from ._code import CodeLike, code_of
from ._option_fields import PhotonTransferOptions
from ._options import takes
from ._reports import Estimate


@dataclass(frozen=True)
class PhotonTransferPoint:
    """Mean [DN] and temporal variance of one frame [DN^2] of one measurement in a pair of frames,
    and whether it is of the dark frames or too close to saturation. For differences: light of both
    buckets [DN] and variance of numbers with about the same light."""

    mean_dn: float
    variance_dn2: Estimate
    dark: bool
    saturated: bool


@dataclass(frozen=True)
class PhotonTransfer:
    """Noise of a sensor: variance [DN^2] = read_noise^2 / gain^2 + (mean - black) / gain + 1/12;
    for differences of two buckets 2 read_noise^2 / gain^2 + light / gain + 2/12.

    Attributes
    ----------
    gain_e_per_dn, read_noise_e, black_level_dn : Estimate
        [e/DN], [e], [DN]
    full_well_e : Estimate, optional
        [e], if reached below the converter's maximum.
    saturation_dn : float
        Highest number, or the number at which numbers are clipped.
    adc_bits : int
    buckets : int
        Buckets per raw number: 2 if differences are read.
    reduced_chi2 : float
        Misfit of the line: near 1 if the model is valid.
    points : list of PhotonTransferPoint
    notes : list of str
    """

    gain_e_per_dn: Estimate
    read_noise_e: Estimate
    black_level_dn: Estimate
    full_well_e: Optional[Estimate]
    saturation_dn: float
    adc_bits: int
    buckets: int
    reduced_chi2: float
    points: list[PhotonTransferPoint]
    notes: list[str]
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
    fields = handle.fields()
    for name in ("gain_e_per_dn", "read_noise_e", "black_level_dn", "full_well_e"):
        fields[name] = None if fields[name] is None else Estimate(*fields[name])
    fields["points"] = [
        PhotonTransferPoint(**point | {"variance_dn2": Estimate(*point["variance_dn2"])})
        for point in fields["points"]
    ]
    return PhotonTransfer(**fields, _handle=handle)

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
    """Mean [DN] and variance of one frame in time [DN^2] of one pair of frames of one measurement;
    whether of the dark frames, and whether too close to the limit to count. Of differences: the
    light that both buckets collected [DN], and the variance of those that collected about so
    much."""

    mean_dn: float
    variance_dn2: Estimate
    dark: bool
    saturated: bool


@dataclass(frozen=True)
class PhotonTransfer:
    """Noise of a sensor: variance [DN^2] = read_noise^2 / gain^2 + (mean - black) / gain + 1/12;
    where differences of two buckets are read, 2 read_noise^2 / gain^2 + light / gain + 2/12.

    Attributes
    ----------
    gain_e_per_dn, read_noise_e, black_level_dn : Estimate
        [e/DN], [e], [DN]
    full_well_e : Estimate, optional
        [e], if frames reach it before the converter's end.
    saturation_dn : float
        Highest number seen, or where numbers are clipped.
    adc_bits : int
    buckets : int
        That a raw number is of: 2 where differences are read.
    reduced_chi2 : float
        Of the fit: near 1 where the model holds.
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
        """The camera with the gain, read noise, black level, bits and full well found."""
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
    """Noise of a sensor from pairs of frames of the same light.

    Parameters
    ----------
    levels : array_like, shape (F, H, W, K), or a list of such
        Each two frames that follow one another saw the same light; several levels of it in one
        array or in several. Raw numbers of single taps, or differences.
    camera : Camera or its name
    dark : array_like, shape (F, H, W, K), optional
        Pairs of frames with the light off.
    code : CodeSet, name of a family or file, optional
        What was played: of cameras that read differences, whose shot noise follows from the light
        that the code collects where each pixel decodes to; with no other light in the room.
    **options
        As PhotonTransferOptions.

    Raises
    ------
    ValueError
        If frames are no pairs, sizes differ, the black level is unknown, the levels do not differ,
        or the camera reads differences, from whose mean shot noise does not follow, and no `code`
        is given.

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
        raise ValueError("code: got none; needs the code that was played, for the camera reads "
                         "differences, from whose mean shot noise does not follow"
                         if reads_differences else
                         "code: goes with cameras that read differences (sensor.readout)")
    played = None if code is None else code_of(code, camera)._handle
    dark_frames = None if dark is None else _check.frames(dark, "dark")
    handle = _tofsmith.photon_transfer(frames, dark_frames, camera._handle, played, dict(options))
    fields = handle.fields()
    for name in ("gain_e_per_dn", "read_noise_e", "black_level_dn", "full_well_e"):
        fields[name] = None if fields[name] is None else Estimate(*fields[name])
    fields["points"] = [
        PhotonTransferPoint(**point | {"variance_dn2": Estimate(*point["variance_dn2"])})
        for point in fields["points"]
    ]
    return PhotonTransfer(**fields, _handle=handle)

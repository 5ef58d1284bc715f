# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Calibration and correction of stray light of a lens; docs/calibration.md."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Optional

import numpy as np
import numpy.typing as npt

from . import _check, _tofsmith
from ._camera import CameraLike, camera_of
from ._check import Path, Progress, RawLike
from ._code import CodeLike
from ._decoding_table import DecodingTable, table_of
from ._reports import Estimate


@dataclass(frozen=True)
class CalibratedStrayLight:
    """Result of calibrate_stray_light().

    Attributes
    ----------
    kernel : ndarray of float32, shape (2 R + 1, 2 R + 1)
        Share of a pixel's light that is scattered to each other pixel, the centre being the pixel
        itself.
    radius_px, share : list of float, list of Estimate
        Distances, and the share scattered to each pixel at that distance.
    total : Estimate
        Share of all light that is scattered.
    target_pixels, pixels : int
        Pixels of the target, and around it.
    notes : list of str
    """

    kernel: npt.NDArray[np.float32]
    radius_px: list[float]
    share: list[Estimate]
    total: Estimate
    target_pixels: int
    pixels: int
    notes: list[str]
    _handle: _tofsmith.CalibratedStrayLight = field(repr=False, compare=False)

    def write(self, path: Path, *, overwrite: bool = False) -> None:
        """Writes the kernel (.npy .npz .exr .pfm), for `tofsmith decode --stray-light`."""
        self._handle.write(_check.path(path), bool(overwrite))

    def write_report(
        self, path: Path, *, source: str = "frames", overwrite: bool = False
    ) -> None:
        """Writes the page of `tofsmith calibrate stray-light --report` (.html)."""
        self._handle.write_report(
            _check.path(path), _check.text(source, "source"), bool(overwrite)
        )


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
    fields = handle.fields()
    fields["share"] = [Estimate(*share) for share in fields["share"]]
    fields["total"] = Estimate(*fields["total"])
    return CalibratedStrayLight(**fields, _handle=handle)


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

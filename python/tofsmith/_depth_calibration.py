# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""The depth error of a nominal code against reference depth; docs/calibration.md."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from typing import Optional, Union

import numpy as np
import numpy.typing as npt

from . import _check, _tofsmith
from ._camera import Camera, CameraLike, camera_of
from ._check import Path, Progress
from ._code import CodeLike, code_of
from ._decoding_table import DecodingTable
from ._files import read_raw
from ._results import Estimate, WithReport, result_of


@dataclass(frozen=True)
class CalibratedFrequency:
    """Calibration of one frequency of a code from reference depth.

    Attributes
    ----------
    frequency_hz : float
    offset_m : Estimate
        Constant excess depth of this frequency.
    contrast : Estimate
        Amplitude relative to that of the camera's model. The geometric mean of all frequencies is
        1.
    harmonics : dict of int to (Estimate, Estimate)
        Harmonics of the frequency beyond the camera's model, as shares of the fundamental's
        amplitude, in phase with its maximum and in quadrature. Only determined ones are listed.
    """

    frequency_hz: float
    offset_m: Estimate
    contrast: Estimate
    harmonics: dict[int, tuple[Estimate, Estimate]]


@dataclass(frozen=True)
class CalibratedDepth(WithReport):
    """Result of calibrate_correlation() with reference depth.

    Attributes
    ----------
    reversed : bool
        True if delay runs backwards, also in the table.
    frequencies : list of CalibratedFrequency
        One per frequency of the code; the table contains these values. Empty for a single
        frequency.
    terms : dict of str to Estimate
        For the known part of the range [m]: offset, cos 4, sin 4, row, row^2 column, log signal,
        ... A 95 % confidence interval is +- 1.96 standard errors.
    far_terms : list of str
        Terms used beyond the known part.
    known_share : float
        Share of the range that the reference covers.
    mean_error_m : float
        Mean error of the nominal depth, in [-range / 2, range / 2].
    rms_before_m : float
        Root mean square of this error around its mean, before the correction [m].
    rms_m, far_rms_m : float, optional
        Root mean square error after the correction on held-out blocks of pixels, and with the far
        terms on held-out parts of the range [m]. None: nothing could be held out.
    skipped_folds : int
        Number of the 2 folds of blocks and 4 of the range without data inside or outside.
    outlier_share : float
        Share of the pixels, which are ignored.
    model_error_percent : float, optional
        Model error [% of the signal] with which at most 1 % of the pixels with correct depth are
        inconsistent, in steps of 20 %. A Decoder of decoding_table() tolerates it. None if the code
        has no degrees of freedom.
    pixels : int
        Number of compared pixels.
    notes : list of str
    """

    reversed: bool
    frequencies: list[CalibratedFrequency]
    terms: dict[str, Estimate]
    far_terms: list[str]
    known_share: float
    mean_error_m: float
    rms_before_m: float
    rms_m: Optional[float]
    far_rms_m: Optional[float]
    skipped_folds: int
    outlier_share: float
    model_error_percent: Optional[float]
    pixels: int
    notes: list[str]
    _handle: _tofsmith.CalibratedDepth = field(repr=False, compare=False)

    def decoding_table(self, camera: CameraLike) -> DecodingTable:
        """Returns the nominal functions with the correction, which a Decoder subtracts from
        depth."""
        return DecodingTable._of(self._handle.decoding_table(camera_of(camera)._handle))

    def camera(self, camera: CameraLike) -> Camera:
        """Returns the camera with the calibrated offsets, contrasts and direction of delay."""
        return Camera._of(self._handle.camera(camera_of(camera)._handle))

    def write_table(self, path: Path, *, overwrite: bool = False) -> None:
        """Writes the table with its correction (.npz), for `tofsmith decode --code`."""
        self._handle.write_table(_check.path(path), bool(overwrite))


def calibrate_depth(
    frames: Union[Path, npt.ArrayLike],
    camera: CameraLike,
    reference: Union[Path, npt.ArrayLike],
    code: CodeLike,
    reference_kind: Optional[str] = None,
    progress: Progress = None,
) -> CalibratedDepth:
    """Implements calibrate_correlation() with a reference."""
    camera = camera_of(camera)
    if isinstance(frames, (str, os.PathLike)):
        frames = read_raw(frames)
    kind = None if reference_kind is None else _check.one_of(
        reference_kind, "reference_kind", ("radial", "z"))
    if isinstance(reference, (str, os.PathLike)):
        path = _check.path(reference, "reference")
        kind = _tofsmith.depth_kind_of(path, kind)
        images = _tofsmith.read_reference_depth(path)
    else:
        depth = np.asarray(reference, np.float32)
        if depth.ndim not in (1, 2, 3):
            raise ValueError(f"reference: got an array of {depth.ndim} axes; needs (H, W), "
                             "(F, H, W) or (F,)")
        if depth.ndim == 1:
            images = [np.full((1, 1), d, np.float32) for d in depth]
        else:
            images = [depth] if depth.ndim == 2 else list(depth)
    handle = _tofsmith.calibrate_depth(
        _check.frames(frames, "frames"),
        images,
        kind == "z",
        code_of(code, camera)._handle,
        camera._handle,
        _check.progress(progress),
    )
    fields = handle.fields()
    return result_of(
        CalibratedDepth, {**fields, "terms": dict(fields["terms"]), "_handle": handle})

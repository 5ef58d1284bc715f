# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Codes as files for waveform generators and pattern memories; see docs/formats.md."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Any, Optional

from . import _check, _tofsmith
from ._camera import Camera, CameraLike, camera_of
from ._check import Path
from ._code import CodeLike, code_of


@dataclass(frozen=True)
class WaveformFormat:
    """A file format of waveforms and what its hardware holds.

    Attributes
    ----------
    name, extension, description : str
    min_points, max_points, multiple_of : int
        Of a table.
    max_bits : int
        Of amplitude.
    variants : list of str
        Ways in which sources disagree about it, the default first.
    """

    name: str
    extension: str
    description: str
    min_points: int
    max_points: int
    multiple_of: int
    max_bits: int
    variants: list[str]


@dataclass(frozen=True)
class ExportedCode:
    """What export_waveforms() wrote.

    Attributes
    ----------
    files : list of pathlib.Path
        Tables, and in a directory manifest.json last.
    manifest : dict
        Format, clock, limits, and what each file holds, as in manifest.json.
    camera : Camera
        With the generators that play the tables: generator_loss(code, camera) says what they cost.
    notes : list of str
        What a user should know.
    """

    files: list[FilePath]
    manifest: dict[str, Any]
    camera: Camera
    notes: list[str]


def waveform_formats() -> list[WaveformFormat]:
    """All formats."""
    return [WaveformFormat(**values) for values in _tofsmith.waveform_formats()]


def export_waveforms(
    code: CodeLike,
    camera: CameraLike,
    output: Path,
    format: str,
    *,
    variant: Optional[str] = None,
    samples: Optional[int] = None,
    bits: Optional[int] = None,
    sample_rate_hz: Optional[float] = None,
    edge_grid_s: Optional[float] = None,
    periods: Optional[int] = None,
    low_v: Optional[float] = None,
    high_v: Optional[float] = None,
    overwrite: bool = False,
) -> ExportedCode:
    """Writes all waveforms of a code as tables of a generator or pattern memory.

    Parameters
    ----------
    code : CodeSet, name of a family or file
    camera : Camera or its name
    output : str or path
        A directory for the files, made if it is missing; or one file, of a format that holds all
        waveforms in one.
    format : str
        One of waveform_formats().
    variant : str, optional
        Of the format.
    samples : int, optional
        Points of the table per period.
    bits : int, optional
        Amplitude bits of the hardware.
    sample_rate_hz : float, optional
        Most points per second.
    edge_grid_s : float, optional
        Binary waveforms switch at multiples of this only [s].
    periods : int, optional
        That a table holds; as few as fit the format unless given.
    low_v, high_v : float, optional
        Output at no light and gain, and at the highest peak and a gain of 1 [V] (0, 1).
    overwrite : bool

    Raises
    ------
    ValueError
        Naming the option that breaks a rule of the format or of the hardware.
    OSError
        If a file exists and `overwrite` is not set, or cannot be written.
    """
    camera = camera_of(camera)
    options = {
        "variant": variant,
        "samples": samples,
        "bits": bits,
        "sample_rate_hz": sample_rate_hz,
        "edge_grid_s": edge_grid_s,
        "periods": periods,
        "low_v": low_v,
        "high_v": high_v,
    }
    handle = code_of(code, camera)._handle
    camera_handle, files, manifest, notes = _tofsmith.export_waveforms(
        handle, camera._handle, _check.path(output), _check.text(format, "format"), options,
        bool(overwrite)
    )
    made = Camera._of(camera_handle)
    return ExportedCode([FilePath(file) for file in files], json.loads(manifest), made, notes)

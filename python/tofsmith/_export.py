# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Export of codes to files for waveform generators and pattern memories; see docs/formats.md."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Any, Unpack

from . import _check, _tofsmith
from ._camera import Camera, CameraLike
from ._check import Path
from ._code import CodeLike, handles_of
from ._option_fields import ExportOptions
from ._options import takes


@dataclass(frozen=True)
class WaveformFormat:
    """A file format of waveforms and the limits of its hardware.

    Attributes
    ----------
    name, extension, description : str
    min_points, max_points, multiple_of : int
        Limits on the number of points of a table.
    max_bits : int
        Amplitude resolution.
    variants : list of str
        Variants on which sources disagree, the default first.
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
    """Result of export_waveforms().

    Attributes
    ----------
    files : list of pathlib.Path
        Tables; in a directory, followed by manifest.json.
    manifest : dict
        Format, clock, limits, and content of each file, as in manifest.json.
    camera : Camera
        Camera with the generators of the tables, for generator_loss(code, camera).
    notes : list of str
        Warnings for the user.
    """

    files: list[FilePath]
    manifest: dict[str, Any]
    camera: Camera
    notes: list[str]


def waveform_formats() -> list[WaveformFormat]:
    """Returns all formats."""
    return [WaveformFormat(**values) for values in _tofsmith.waveform_formats()]


@takes(ExportOptions)
def export_waveforms(
    code: CodeLike,
    camera: CameraLike,
    output: Path,
    format: str,
    *,
    overwrite: bool = False,
    **options: Unpack[ExportOptions],
) -> ExportedCode:
    """Writes all waveforms of a code as tables for a generator or pattern memory.

    Parameters
    ----------
    code : CodeSet, name of a family or file
    camera : Camera or its name
    output : str or path
        Directory for the files, created if missing; or one file, for formats that store all
        waveforms in one file.
    format : str
        Name of one of waveform_formats().
    overwrite : bool
    **options
        As in ExportOptions.

    Raises
    ------
    ValueError
        Naming the option that violates a rule of the format or hardware.
    OSError
        If a file exists and `overwrite` is not set, or cannot be written.
    """
    camera_handle, files, manifest, notes = _tofsmith.export_waveforms(
        *handles_of(code, camera), _check.path(output), _check.text(format, "format"),
        dict(options), bool(overwrite)
    )
    made = Camera._of(camera_handle)
    return ExportedCode([FilePath(file) for file in files], json.loads(manifest), made, notes)

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Codes as files for waveform generators and pattern memories; see docs/formats.md."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Any, Unpack

from . import _check, _tofsmith
from ._camera import Camera, CameraLike, camera_of
from ._check import Path
from ._code import CodeLike, code_of
from ._option_fields import ExportOptions
from ._options import takes


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
    overwrite : bool
    **options
        As ExportOptions.

    Raises
    ------
    ValueError
        Naming the option that breaks a rule of the format or of the hardware.
    OSError
        If a file exists and `overwrite` is not set, or cannot be written.
    """
    camera = camera_of(camera)
    handle = code_of(code, camera)._handle
    camera_handle, files, manifest, notes = _tofsmith.export_waveforms(
        handle, camera._handle, _check.path(output), _check.text(format, "format"), dict(options),
        bool(overwrite)
    )
    made = Camera._of(camera_handle)
    return ExportedCode([FilePath(file) for file in files], json.loads(manifest), made, notes)

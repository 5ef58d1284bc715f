# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Results and options common to the decoding of recordings and streams."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Any, Optional

from . import _check, _tofsmith
from ._check import Path
from ._filter import FilterLike, TimeFilterLike, filter_options, time_filter_options


@dataclass(frozen=True)
class DecodedRecording:
    """Result of decoding a recording.

    Attributes
    ----------
    files : list of pathlib.Path
        One per frame; for a stack one per plane.
    outputs : list of str
        Planes written.
    frames : list of dict
        Number of pixels per PixelStatus, by name, for every frame; 0 if `outputs` does not include
        status.
    first_frame : int
        Number of the first decoded frame in the recording.
    height, width, measurements : int
        Size of every frame.
    seconds : float
        Duration of decoding [s].
    notes : list of str
        Warnings: e.g. raw numbers interpreted as electrons, no pixel with a depth.
    """

    files: list[FilePath]
    outputs: list[str]
    frames: list[dict[str, int]]
    first_frame: int
    height: int
    width: int
    measurements: int
    seconds: float
    notes: list[str]


@dataclass(frozen=True)
class DecodedStream:
    """Result of decoding a stream.

    Attributes
    ----------
    frames : int
        Number of decoded frames.
    statuses : dict
        Number of pixels per PixelStatus, by name; 0 if `outputs` does not include status.
    height, width : int
        Size of every frame.
    seconds : float
        Time until the last frame was passed on, including waiting [s].
    """

    frames: int
    statuses: dict[str, int]
    height: int
    width: int
    seconds: float


def request_options(
    options: Mapping[str, Any],
    *,
    raw_format: Optional[Path],
    time_filter: Optional[TimeFilterLike],
    filter: Optional[FilterLike],
    rays: Optional[Path],
) -> dict[str, Any]:
    """Converts options of recordings and streams for the library."""
    return {
        **options,
        "raw_format": raw_format,
        "time_filter": None if time_filter is None else time_filter_options(time_filter),
        "filter": None if filter is None else filter_options(filter),
        "rays": rays,
    }


def mixed_word(mixed: Optional[str]) -> str:
    """Returns the word; "" for None."""
    return "" if mixed is None else _check.one_of(mixed, "mixed", tuple(_tofsmith.mixed_pixels()))

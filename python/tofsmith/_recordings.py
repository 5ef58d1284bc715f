# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""What decoding of recordings and streams shares: what came of them, and how to ask for it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Any, Optional

from . import _check, _tofsmith
from ._check import Path
from ._decoded_planes import plane_words
from ._filter import FilterLike, TimeFilterLike, filter_options, time_filter_options


@dataclass(frozen=True)
class DecodedRecording:
    """What became of a recording.

    Attributes
    ----------
    files : list of pathlib.Path
        Of every frame; of a stack, of every plane.
    outputs : list of str
        The planes written.
    frames : list of dict
        How many pixels of every frame have which PixelStatus, by its name; all 0 where `outputs`
        were asked for without status.
    first_frame : int
        Number of the first of them in the recording.
    height, width, measurements : int
        Of every frame.
    seconds : float
        That decoding took [s].
    notes : list of str
        What should be known: raw numbers taken as electrons, no pixel that has a depth.
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
    """What became of a stream.

    Attributes
    ----------
    frames : int
        Decoded and handed on.
    statuses : dict
        How many of their pixels have which PixelStatus, by its name; all 0 unless status is among
        the `outputs`.
    height, width : int
        Of every frame.
    seconds : float
        Until the last was handed on, waiting for them included [s].
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
    """Options of recordings and streams, as the library takes them."""
    words = {plane: word for word, plane in plane_words.items()}
    outputs = options.get("outputs")
    return {
        **options,
        "outputs": None if outputs is None else [words.get(plane, plane) for plane in outputs],
        "raw_format": raw_format,
        "time_filter": None if time_filter is None else time_filter_options(time_filter),
        "filter": None if filter is None else filter_options(filter),
        "rays": rays,
    }


def mixed_word(mixed: Optional[str]) -> str:
    """The word, "" for none."""
    return "" if mixed is None else _check.one_of(mixed, "mixed", tuple(_tofsmith.mixed_pixels()))

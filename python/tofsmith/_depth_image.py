# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""What a decoder says about every pixel."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import IntEnum
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from . import _check
from ._notebook import depth_picture


class PixelStatus(IntEnum):
    """Outcome of a pixel; if several apply, the first of invalid, saturated, no_return, low_signal,
    inconsistent, ambiguous. mixed occurs only where mixed pixels are searched for."""

    ok = 0
    invalid = 1
    no_return = 2
    saturated = 3
    low_signal = 4
    ambiguous = 5
    mixed = 6
    inconsistent = 7


class ReturnStatus(IntEnum):
    """How many returns a pixel shows."""

    none = 0
    single = 1
    two = 2
    unresolved = 3


#: Planes by name, in the order in which they are shown.
plane_types: dict[str, type[np.generic]] = {
    "bin": np.int32,
    "depth_m": np.float32,
    "signal_e_per_s": np.float32,
    "ambient_e_per_s": np.float32,
    "confidence": np.float32,
    "predicted_standard_deviation_m": np.float32,
    "status": np.uint8,
    "residual": np.float32,
    "delay_m": np.float32,
    "ratio": np.float32,
    "returns": np.uint8,
}
multipath_planes = ("delay_m", "ratio", "returns")
usual_planes = tuple(
    p for p in plane_types if p not in ("bin", "residual") and p not in multipath_planes)


#: Words that recordings and `tofsmith decode --outputs` have for some of them.
plane_words = {
    "depth": "depth_m",
    "signal": "signal_e_per_s",
    "ambient": "ambient_e_per_s",
    "deviation": "predicted_standard_deviation_m",
    "delay": "delay_m",
}


@dataclass(eq=False, repr=False)
class DepthImage:
    """What a decoder says about every pixel; all planes are (H, W) or (F, H, W), None if not asked
    for. Pixels without depth (invalid, no_return) hold NaN in every plane of floats.

    Attributes
    ----------
    depth_m : ndarray of float32
        Distance along the ray [m], in [0, range).
    signal_e_per_s, ambient_e_per_s : ndarray of float32
        S and A [e/s]; A is NaN where differences hide it.
    confidence : ndarray of float32
        That no far-off depth is the true one, in [0, 1].
    predicted_standard_deviation_m : ndarray of float32
        Of depth around the right peak [m].
    status : ndarray of uint8
        PixelStatus.
    residual : ndarray of float32
        Chi-square per degree of freedom of the measurements around the decoded light; NaN if the
        code leaves no degree of freedom.
    bin : ndarray of int32
        The best bin in [0, N); -1 where a measurement is NaN or infinite.
    delay_m, ratio : ndarray of float32
        Of a second return (two-return, tail); NaN where there is none.
    returns : ndarray of uint8
        ReturnStatus (two-return, tail).
    """

    depth_m: Optional[npt.NDArray[np.float32]] = None
    signal_e_per_s: Optional[npt.NDArray[np.float32]] = None
    ambient_e_per_s: Optional[npt.NDArray[np.float32]] = None
    confidence: Optional[npt.NDArray[np.float32]] = None
    predicted_standard_deviation_m: Optional[npt.NDArray[np.float32]] = None
    status: Optional[npt.NDArray[np.uint8]] = None
    residual: Optional[npt.NDArray[np.float32]] = None
    bin: Optional[npt.NDArray[np.int32]] = None
    delay_m: Optional[npt.NDArray[np.float32]] = None
    ratio: Optional[npt.NDArray[np.float32]] = None
    returns: Optional[npt.NDArray[np.uint8]] = None

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, DepthImage):
            return NotImplemented
        mine, others = self.planes(), other.planes()
        return mine.keys() == others.keys() and all(
            np.array_equal(plane, others[name], equal_nan=plane.dtype.kind == "f")
            for name, plane in mine.items())

    __hash__ = None  # type: ignore[assignment]  # its planes may be written to

    def __repr__(self) -> str:
        planes = self.planes()
        if not planes:
            return "<DepthImage without planes>"
        shape = " x ".join(str(n) for n in next(iter(planes.values())).shape)
        parts = []
        if self.depth_m is not None and np.isfinite(self.depth_m).any():
            parts.append(f"{np.nanmin(self.depth_m):.4g} .. {np.nanmax(self.depth_m):.4g} m")
        if self.status is not None and self.status.size:
            parts.append(f"{np.mean(self.status == PixelStatus.ok):.1%} ok")
        return f"<DepthImage {shape}: {', '.join([*parts, *planes])}>"

    def _repr_html_(self) -> str:
        return depth_picture(self, self.depth_m)

    def planes(self) -> dict[str, npt.NDArray[Any]]:
        """The planes there are, by name."""
        named = ((name, getattr(self, name)) for name in plane_types)
        return {name: plane for name, plane in named if plane is not None}


def plane_names(planes: Iterable[str], is_multipath: bool) -> tuple[str, ...]:
    if isinstance(planes, str):
        raise TypeError(f"planes: got the text '{planes}'; needs a list of names")
    known = tuple(p for p in plane_types if is_multipath or p not in multipath_planes)
    names = tuple(_check.one_of(plane_words.get(p, p), "planes", known) for p in planes)
    if not names:
        raise ValueError("planes: got none; needs at least one of " + ", ".join(known))
    return names


def planes_of(out: DepthImage, planes: Optional[Iterable[str]]) -> DepthImage:
    _check.instance(out, DepthImage, "out")
    if planes is not None:
        raise ValueError("planes: goes without out, whose planes are written")
    for name, plane in out.planes().items():
        if not isinstance(plane, np.ndarray):
            raise TypeError(f"out.{name}: got {_check.shown(plane)}; needs a numpy.ndarray")
    if not out.planes():
        raise ValueError("out: got no planes; needs at least one array")
    return out

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Results of decoding per pixel."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from . import _check
from ._decoded_planes import (DecodedPlanes, PixelStatus, multipath_planes, plane_synonyms,
                              plane_types, plane_words)
from ._notebook import depth_picture


@dataclass(eq=False, repr=False)
class DepthImage(DecodedPlanes):
    __doc__ = DecodedPlanes.__doc__

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, DepthImage):
            return NotImplemented
        mine, others = self.planes(), other.planes()
        return mine.keys() == others.keys() and all(
            np.array_equal(plane, others[name], equal_nan=plane.dtype.kind == "f")
            for name, plane in mine.items())

    __hash__ = None  # type: ignore[assignment]  # planes are mutable

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
        """Returns the existing planes by name."""
        named = ((name, getattr(self, name)) for name in plane_types)
        return {name: plane for name, plane in named if plane is not None}


def plane_names(planes: Iterable[str], is_multipath: bool) -> tuple[str, ...]:
    if isinstance(planes, str):
        raise TypeError(f"planes: got the text '{planes}'; needs a list of names")
    known = tuple(p for p in plane_types if is_multipath or p not in multipath_planes)
    other_names = {**plane_words, **plane_synonyms}
    names = tuple(_check.one_of(other_names.get(p, p), "planes", known) for p in planes)
    if not names:
        raise ValueError("planes: got none; needs at least one of " + ", ".join(known))
    return names


def planes_of(out: DepthImage, planes: Optional[Iterable[str]]) -> DepthImage:
    _check.instance(out, DepthImage, "out")
    if planes is not None:
        raise ValueError("planes: cannot be combined with out, whose planes are written")
    for name, plane in out.planes().items():
        if not isinstance(plane, np.ndarray):
            raise TypeError(f"out.{name}: got {_check.shown(plane)}; needs a numpy.ndarray")
    if not out.planes():
        raise ValueError("out: got no planes; needs at least one array")
    return out

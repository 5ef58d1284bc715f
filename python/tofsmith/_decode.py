# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""From raw measurements to depth."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from . import _check, _tofsmith
from ._camera import CameraLike
from ._check import FloatArray, Progress
from ._code import CodeLike
from ._decoding_table import DecodingTable
from ._depth_image import (
    DepthImage,
    multipath_planes,
    plane_names,
    plane_types,
    planes_of,
    usual_planes,
)


class Decoder:
    """Depth from raw measurements. Immutable, safe to use from many threads at once.

    Parameters
    ----------
    code : CodeSet, DecodingTable, name of a family or file
        A DecodingTable is used as it is, without a camera.
    camera : Camera or its name
    method : {"zncc", "ml", "unwrap", "two-return", "tail"}
        zncc for any code; ml by maximum likelihood, slower; unwrap for sinusoids of one or more
        frequencies; two-return and tail where light comes back twice or trails off, for codes of
        many independent means.
    low_signal_sigma : float, optional
        low_signal below so many standard deviations of the signal (3).
    minimum_confidence : float, optional
        ambiguous below this probability (0.9).
    unwrap_weights : {"variance", "frequency"}, optional
        Of unwrap.
    multipath : dict, optional
        Of two-return and tail: threshold, shortest_delay_m, longest_delay_m, tail_m, and prior, a
        dict of single_probability, mean_delay_m, largest_ratio; see docs/multipath.md.

    Raises
    ------
    ValueError
        If the method cannot decode the code, or an option breaks a rule.

    Examples
    --------
    >>> decoder = Decoder("hamiltonian-k4", "paper-10f0")
    >>> decoder.decode(np.ones((2, 3, 4), np.float32)).depth_m.shape
    (2, 3)
    """

    def __init__(
        self,
        code: CodeLike | DecodingTable,
        camera: Optional[CameraLike] = None,
        *,
        method: str = "zncc",
        low_signal_sigma: Optional[float] = None,
        minimum_confidence: Optional[float] = None,
        unwrap_weights: Optional[str] = None,
        multipath: Optional[Mapping[str, Any]] = None,
    ) -> None:
        if isinstance(code, DecodingTable):
            table = code
        elif camera is None:
            raise TypeError("camera: got None; needs a tofsmith.Camera or its name")
        else:
            table = DecodingTable.of_code(code, camera)
        self._method = _check.one_of(method, "method", tuple(_tofsmith.decode_methods()))
        options = {
            "method": method,
            "low_signal_sigma": low_signal_sigma,
            "minimum_confidence": minimum_confidence,
            "unwrap_weights": unwrap_weights,
            "multipath": None if multipath is None else dict(multipath),
        }
        self._handle = _tofsmith.Decoder(table._handle, options)

    @property
    def method(self) -> str:
        return self._method

    @property
    def table(self) -> DecodingTable:
        return DecodingTable._of(self._handle.table())

    def decode(
        self,
        raw: npt.NDArray[Any],
        *,
        layout: str = "interleaved",
        planes: Optional[Iterable[str]] = None,
        out: Optional[DepthImage] = None,
        delay_offset_m: Optional[npt.ArrayLike] = None,
        gain: Optional[npt.ArrayLike] = None,
        progress: Progress = None,
    ) -> DepthImage:
        """Decodes one frame or a stack on all threads. Raw numbers are read where they are,
        whatever the strides.

        Parameters
        ----------
        raw : ndarray of float32, float64, uint16 or uint8 (int16 is copied)
            (H, W, K) or (F, H, W, K); planar: (K, H, W) or (F, K, H, W). Electrons, or counts where
            the camera has an ADC. NaN and infinity make a pixel invalid.
        layout : {"interleaved", "planar"}
            Never guessed.
        planes : iterable of str, optional
            Names of planes of DepthImage; others are not computed. None: all but bin.
        out : DepthImage, optional
            Planes to write into: C order, of the frame's shape; instead of `planes`.
        delay_offset_m, gain : array_like, shape (H, W), optional
            By how much each pixel decodes too far [m], and its response over a usual one's; NaN
            marks a dead pixel.
        progress : callable, optional
            Called with (fraction, step); False stops.

        Returns
        -------
        DepthImage
            `out`, if given.

        Raises
        ------
        ValueError
            For another dtype or shape.
        Interrupted
            If `progress` says so; Ctrl-C raises KeyboardInterrupt.

        Notes
        -----
        The same bits for any number of threads and any layout.
        """
        array = _raw_array(raw)
        is_planar = _check.one_of(layout, "layout", ("interleaved", "planar")) == "planar"
        image = self._new_planes(array, is_planar, planes) if out is None else planes_of(
            out, planes)
        callback = _check.progress(progress)
        maps = [
            None if m is None else np.asarray(_check.real_array(m, name, "(H, W)"), np.float32)
            for m, name in ((delay_offset_m, "delay_offset_m"), (gain, "gain"))
        ]
        self._handle.decode(array, is_planar, image.planes(), maps[0], maps[1], callback)
        return image

    def decode_depth_bins(self, measurements: npt.ArrayLike) -> FloatArray:
        """Positions in [0, N) [bins], refined between bins, of many pixels: (.., K) to (..); one
        thread. NaN where a measurement is NaN or infinite."""
        array = np.asarray(measurements)
        if array.ndim < 1 or array.dtype.kind not in "fiu":
            raise ValueError(f"measurements: got {_check.shown(array)}; needs numbers of shape "
                             "(.., K)")
        flat = array.reshape(-1, array.shape[-1]) if array.size else array.reshape(0, 1)
        return self._handle.decode_depth_bins(flat).reshape(array.shape[:-1])

    def _new_planes(
        self, raw: npt.NDArray[Any], is_planar: bool, planes: Optional[Iterable[str]]
    ) -> DepthImage:
        is_multipath = self._method in ("two-return", "tail")
        if planes is None:
            names = usual_planes + (multipath_planes if is_multipath else ())
        else:
            names = plane_names(planes, is_multipath)
        if raw.ndim not in (3, 4):
            shapes = "(K, H, W) or (F, K, H, W)" if is_planar else "(H, W, K) or (F, H, W, K)"
            raise ValueError(f"raw: got shape {raw.shape}; needs {shapes}")
        shape = raw.shape[:-3] + raw.shape[-2:] if is_planar else raw.shape[:-1]
        made: dict[str, Any] = {name: np.empty(shape, plane_types[name]) for name in names}
        return DepthImage(**made)


def _raw_array(raw: Any) -> npt.NDArray[Any]:
    if not isinstance(raw, np.ndarray):
        raise TypeError(f"raw: got {_check.shown(raw)}; needs a numpy.ndarray")
    return raw.astype(np.float32) if raw.dtype == np.int16 else raw


def decode(
    raw: npt.NDArray[Any],
    code: CodeLike | DecodingTable,
    camera: Optional[CameraLike] = None,
    *,
    method: str = "zncc",
    layout: str = "interleaved",
    planes: Optional[Iterable[str]] = None,
    progress: Progress = None,
) -> DepthImage:
    """Decoder(code, camera, method=method).decode(raw, ..): keep a Decoder for many frames."""
    decoder = Decoder(code, camera, method=method)
    return decoder.decode(raw, layout=layout, planes=planes, progress=progress)



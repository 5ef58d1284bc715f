# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""From raw measurements to depth."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import IntEnum
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from . import _check, _tofsmith
from ._camera import CameraLike, camera_of
from ._check import FloatArray, Progress
from ._code import CodeLike, code_of


class PixelStatus(IntEnum):
    """What became of a pixel; where several apply, the first of invalid, saturated, no_return,
    low_signal, ambiguous."""

    ok = 0
    invalid = 1
    no_return = 2
    saturated = 3
    low_signal = 4
    ambiguous = 5


class ReturnStatus(IntEnum):
    """How many returns a pixel shows."""

    none = 0
    single = 1
    two = 2
    unresolved = 3


_types: dict[str, type[np.generic]] = {
    "bin": np.int32,
    "depth_m": np.float32,
    "signal_e_per_s": np.float32,
    "ambient_e_per_s": np.float32,
    "confidence": np.float32,
    "predicted_standard_deviation_m": np.float32,
    "status": np.uint8,
    "delay_m": np.float32,
    "ratio": np.float32,
    "returns": np.uint8,
}
_multipath_planes = ("delay_m", "ratio", "returns")
_usual_planes = tuple(p for p in _types if p != "bin" and p not in _multipath_planes)


@dataclass
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
    bin: Optional[npt.NDArray[np.int32]] = None
    delay_m: Optional[npt.NDArray[np.float32]] = None
    ratio: Optional[npt.NDArray[np.float32]] = None
    returns: Optional[npt.NDArray[np.uint8]] = None

    def planes(self) -> dict[str, npt.NDArray[Any]]:
        """The planes there are, by name."""
        named = ((name, getattr(self, name)) for name in _types)
        return {name: plane for name, plane in named if plane is not None}


class DecodingTable:
    """Everything a decoder needs to know of a code on a camera.

    See Also
    --------
    DecodingTable.of_code, DecodingTable.of_measured
    """

    _handle: _tofsmith.DecodingTable

    def __init__(self) -> None:
        raise TypeError(
            "DecodingTable: use DecodingTable.of_code(code, camera) or "
            "DecodingTable.of_measured(correlation, camera)"
        )

    @classmethod
    def _of(cls, handle: _tofsmith.DecodingTable) -> DecodingTable:
        table = cls.__new__(cls)
        table._handle = handle
        return table

    @classmethod
    def of_code(cls, code: CodeLike, camera: CameraLike) -> DecodingTable:
        """The table of a code on a camera."""
        camera = camera_of(camera)
        handle = code_of(code, camera)._handle
        return cls._of(_tofsmith.DecodingTable.of_code(handle, camera._handle))

    @classmethod
    def of_measured(
        cls,
        correlation: npt.ArrayLike,
        camera: Optional[CameraLike] = None,
        *,
        range_m: Optional[float] = None,
        taps: int = 1,
        ambient: Optional[str] = None,
    ) -> DecodingTable:
        """The table of measured correlation functions.

        Parameters
        ----------
        correlation : array_like, shape (N, K)
            chi up to one common factor, row n at depth_bin = n, the end point left out, the taps of
            an exposure side by side.
        camera : Camera or its name, optional
            Gives range, exposure, noise, saturation and read-out. None: equal exposures, raw
            numbers without read noise.
        range_m : float, optional
            Depth of the whole table [m]; needed without a camera.
        taps : int
            Columns per exposure.
        ambient : {"equal", "mean", "none"}, optional
            What constant light adds: the same to all columns (the default), as much as the mean of
            the column, or nothing.

        Raises
        ------
        ValueError
            If depths cannot be told apart, or table and camera do not fit.
        """
        table = _check.finite_array(correlation, "correlation", "(N, K)")
        if camera is None:
            if range_m is None:
                raise ValueError("range_m: got None; needs the depth of the table in metres, or a "
                                 "camera that says it")
            if ambient is not None or taps != 1:
                raise ValueError("camera: got None; ambient and taps need the camera")
            metres = _check.number(range_m, "range_m")
            return cls._of(_tofsmith.DecodingTable.of_correlation(table, metres))
        options = {"taps": taps, "ambient": ambient}
        made = _tofsmith.DecodingTable.of_measured(table, camera_of(camera)._handle, options)
        if range_m is not None:
            made = made.with_range(_check.number(range_m, "range_m"))
        return cls._of(made)

    @property
    def correlation(self) -> FloatArray:
        """chi, (N, K)."""
        return self._handle.correlation()

    @property
    def ambient_gain(self) -> FloatArray:
        """kappa (K,)."""
        return self._handle.ambient_gain()

    @property
    def exposure_s(self) -> FloatArray:
        """T [s] (K,)."""
        return self._handle.exposure_s()

    @property
    def range_m(self) -> float:
        """Depth of a whole period [m]."""
        return self._handle.range_m()

    def ambiguous_depths(self) -> FloatArray:
        """Pairs of depths that look the same [m], (pairs, 2); decoders answer with the first."""
        return self._handle.ambiguous_depths()


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
        image = self._new_planes(array, is_planar, planes) if out is None else _planes_of(
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
            names = _usual_planes + (_multipath_planes if is_multipath else ())
        else:
            names = _plane_names(planes, is_multipath)
        if raw.ndim not in (3, 4):
            shapes = "(K, H, W) or (F, K, H, W)" if is_planar else "(H, W, K) or (F, H, W, K)"
            raise ValueError(f"raw: got shape {raw.shape}; needs {shapes}")
        shape = raw.shape[:-3] + raw.shape[-2:] if is_planar else raw.shape[:-1]
        return DepthImage(**{name: np.empty(shape, _types[name]) for name in names})


def _raw_array(raw: Any) -> npt.NDArray[Any]:
    if not isinstance(raw, np.ndarray):
        raise TypeError(f"raw: got {_check.shown(raw)}; needs a numpy.ndarray")
    return raw.astype(np.float32) if raw.dtype == np.int16 else raw


def _plane_names(planes: Iterable[str], is_multipath: bool) -> tuple[str, ...]:
    if isinstance(planes, str):
        raise TypeError(f"planes: got the text '{planes}'; needs a list of names")
    known = tuple(p for p in _types if is_multipath or p not in _multipath_planes)
    names = tuple(_check.one_of(p, "planes", known) for p in planes)
    if not names:
        raise ValueError("planes: got none; needs at least one of " + ", ".join(known))
    return names


def _planes_of(out: DepthImage, planes: Optional[Iterable[str]]) -> DepthImage:
    _check.instance(out, DepthImage, "out")
    if planes is not None:
        raise ValueError("planes: goes without out, whose planes are written")
    for name, plane in out.planes().items():
        if not isinstance(plane, np.ndarray):
            raise TypeError(f"out.{name}: got {_check.shown(plane)}; needs a numpy.ndarray")
    if not out.planes():
        raise ValueError("out: got no planes; needs at least one array")
    return out


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



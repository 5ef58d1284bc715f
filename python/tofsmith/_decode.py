# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""From raw measurements to depth."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path as FilePath
from typing import Any, BinaryIO, Optional, Union, Unpack

import numpy as np
import numpy.typing as npt

from . import _check, _tofsmith
from ._camera import CameraLike, camera_of
from ._check import FloatArray, Path, Progress, RawLike
from ._code import CodeLike
from ._decoding_table import DecodingTable, table_of
from ._decoded_planes import multipath_planes, plane_types, usual_planes
from ._depth_image import DepthImage, plane_names, planes_of
from ._filter import Filter, FilterLike, TimeFilterLike, filter_options
from ._notebook import table_picture
from ._option_fields import DecodeOptions, DecodeRequest, MultipathOptions, StreamOptions
from ._options import takes
from ._recordings import (
    DecodedRecording,
    DecodedStream,
    mixed_word,
    request_options,
)
from ._scene import lens_dict


@takes(DecodeOptions)
class Decoder:
    """Decodes raw measurements to depth. Immutable and thread-safe.

    Parameters
    ----------
    code : CodeSet, DecodingTable, name of a family or file
        A DecodingTable is used unchanged. Files are read by DecodingTable.load().
    camera : Camera or its name
        Required unless `code` is a DecodingTable. With a DecodingTable, only the camera's lens is
        used.
    method : {"zncc", "ml", "unwrap", "two-return", "tail"}
        zncc and ml support any code; ml (maximum likelihood) is slower. unwrap supports sinusoids
        of one or more frequencies. two-return and tail are for multipath, and require codes with
        many independent measurements.
    unwrap_weights : {"variance", "frequency"}, optional
        Weights of the frequencies, for unwrap.
    device : str, optional
        OpenCL device for averaging, filtering and decoding. "cpu" uses no device; "gpu" uses the
        first GPU; "auto" uses the first GPU for frames with a spatial filter, and the CPU for
        others. Any other text is the number or part of the name of a device. Only zncc runs on
        devices. See docs/gpu.md.
    multipath : dict, optional
        For two-return and tail: keys of MultipathOptions; see docs/multipath.md.
    **options
        As in DecodeOptions.

    Raises
    ------
    ValueError
        If the method does not support the code, or an option is invalid.
    OSError
        If there is no such device, or it fails.

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
        unwrap_weights: Optional[str] = None,
        multipath: Union[MultipathOptions, Mapping[str, Any], None] = None,
        device: str = "cpu",
        **options: Unpack[DecodeOptions],
    ) -> None:
        table = table_of(code, camera)
        lens = None if camera is None else camera_of(camera).lens
        self._lens = None if lens is None else lens_dict(lens)
        self._inputs = table._inputs
        self._method = _check.one_of(method, "method", tuple(_tofsmith.decode_methods()))
        given: dict[str, Any] = {
            **options,
            "method": method,
            "unwrap_weights": unwrap_weights,
            "multipath": None if multipath is None else dict(multipath),
            "device": device,
        }
        self._handle = _tofsmith.Decoder(table._handle, given)
        self._table = table
        self._options = given

    def __copy__(self) -> Decoder:
        return self  # immutable

    def __deepcopy__(self, memo: object) -> Decoder:
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        return _decoder_with_lens, (self._table, self._options, self._lens)

    def __repr__(self) -> str:
        samples, measurements = self._table.correlation.shape
        return (f"<Decoder {self._method}: K = {measurements}, N = {samples}, range "
                f"{self._table.range_m:.4g} m>")

    def _repr_html_(self) -> str:
        return table_picture(self, self._table.correlation, self._table.range_m)

    @property
    def method(self) -> str:
        return self._method

    @property
    def device(self) -> str:
        """Name of the decoding device, or cpu."""
        return self._handle.device()

    @property
    def table(self) -> DecodingTable:
        return self._table

    def decode(
        self,
        raw: RawLike,
        *,
        layout: str = "interleaved",
        planes: Optional[Iterable[str]] = None,
        out: Optional[DepthImage] = None,
        averaged: Optional[npt.ArrayLike] = None,
        delay_offset_m: Optional[npt.ArrayLike] = None,
        gain: Optional[npt.ArrayLike] = None,
        filter: Optional[FilterLike | Filter] = None,
        mixed: Optional[str] = None,
        min_depth_m: Optional[float] = None,
        max_depth_m: Optional[float] = None,
        progress: Progress = None,
    ) -> DepthImage:
        """Decodes one frame or a stack on all threads. Raw numbers with any strides are not copied.

        Parameters
        ----------
        raw : ndarray, or a list of them
            float32, float64, uint16 or uint8 (other integers are copied), (H, W, K) or (F, H, W,
            K); planar: (K, H, W) or (F, K, H, W). A list has one array (H, W) or (F, H, W) per
            measurement, in order. Values are electrons, or counts if the camera has an ADC. NaN and
            infinity make a pixel invalid.
        layout : {"interleaved", "planar"}
            Not inferred from the shape.
        planes : iterable of str, optional
            Planes of DepthImage to compute. None: the default planes.
        out : DepthImage, optional
            Image to write to, instead of `planes`. Its planes are computed; they must be in C order
            and have the frame's shape.
        averaged : float, or array_like of shape (H, W) or (F, H, W), optional
            Number of measurements averaged into each pixel, > 0, which reduces the noise variance.
            Required for averaged frames and the output of Filter.apply(). Instead of Filter.apply()
            and `averaged`, prefer `filter`: it accounts for the correlated noise after "normal" and
            "strong", without which confidence is up to 0.12 too high.
        delay_offset_m, gain : array_like, shape (H, W), or float, optional
            Excess depth of each pixel [m], and its relative response; NaN marks a dead pixel.
        filter : {"light", "normal", "strong"}, dict or Filter, optional
            Averages pixels of the same depth before decoding. A dict contains options of Filter,
            including "strength"; a Filter must be made for the same code and camera.
        mixed : {"label", "snap", "drop"}, optional
            Detects pixels at depth edges that see two surfaces and sets their status to mixed:
            label keeps their depth, snap replaces it by that of the nearest pixel of the brighter
            surface, drop removes it. With `filter`, frames are filtered again without these pixels.
            See docs/filtering.md.
        min_depth_m, max_depth_m : float, optional
            Smallest and largest radial depth after all corrections [m]: only depths between them
            are candidates, and other pixels are too_near or too_far. None: the camera's working
            distance, or the whole range. See docs/decoding.md.
        progress : callable, optional
            Called with (fraction, step); returning False cancels.

        Returns
        -------
        DepthImage
            `out`, if given.

        Raises
        ------
        ValueError
            For an invalid dtype or shape.
        Interrupted
            If `progress` cancels; Ctrl-C raises KeyboardInterrupt.

        Notes
        -----
        Results are identical for any number of threads and any layout.
        """
        array, is_planar = _check.raw_array(raw, layout)
        image = self._new_planes(array, is_planar, planes) if out is None else planes_of(
            out, planes)
        callback = _check.progress(progress)
        size = array.shape[-2:] if is_planar else array.shape[-3:-1]
        maps = [
            None if m is None else np.asarray(_check.real_array(
                np.full(size, m) if np.ndim(m) == 0 else m, name, "(H, W)"), np.float32)
            for m, name in ((delay_offset_m, "delay_offset_m"), (gain, "gain"))
        ]
        means = _check.means(averaged, array, is_planar)
        applied = None if filter is None else self._filter(filter)._handle
        self._handle.decode(array, is_planar, image.planes(), means, maps[0], maps[1],
                            mixed_word(mixed), _check.optional_number(min_depth_m, "min_depth_m"),
                            _check.optional_number(max_depth_m, "max_depth_m"), applied, callback)
        return image

    def _filter(self, filter: FilterLike | Filter) -> Filter:
        if isinstance(filter, Filter):
            return filter
        options = filter_options(filter)
        return Filter(self.table, strength=options.pop("strength"), options=options)

    @takes(DecodeRequest)
    def decode_recording(
        self,
        raw: Path | Sequence[Path],
        output: Path,
        *,
        raw_format: Optional[Path] = None,
        time_filter: Optional[TimeFilterLike] = None,
        filter: Optional[FilterLike] = None,
        rays: Optional[Path] = None,
        overwrite: bool = False,
        progress: Progress = None,
        **options: Unpack[DecodeRequest],
    ) -> DecodedRecording:
        """Decodes a recording of any length to files, with constant memory, as `tofsmith decode`.

        Parameters
        ----------
        raw : str or path, or a list of them
            .npy, .npz or .h5, (H, W, K) or (F, H, W, K), or a dump described by `raw_format`. A
            list has one file per measurement, in order: (H, W) or (F, H, W), or grey images (.png
            .tiff .pgm).
        output : str or path
            .npy .pfm .png (16 bits, mm): depth only; .npz: one array per plane; .exr: one channel
            per plane; .ply, .pcd (organized): points with planes as scalars. For several
            frames, file names contain the frame number: name-03.npz.
        raw_format : str or path, optional
            A .raw.toml file; see docs/raw_formats.md.
        time_filter : int or dict, optional
            Averages previous frames while the scene is static, as TimeFilter: max_frames, or a dict
            with keys of TimeFilterOptions.
        filter : {"light", "normal", "strong"} or dict, optional
            Averages measurements of the same depth before decoding, as Filter: a strength, or a
            dict with "strength" ("normal") and keys of FilterOptions.
        rays : str or path, optional
            Rays for points and z-depth, instead of the camera's lens (.npy): x/z and y/z (H, W, 2),
            or directions (H, W, 3); pixels with NaN are invalid.
        overwrite : bool
            Replace existing files, except inputs.
        progress : callable, optional
            Called with (fraction, step); returning False cancels.
        **options
            As in DecodeRequest.

        Returns
        -------
        DecodedRecording

        Raises
        ------
        ValueError
            For an invalid request, naming the argument, before any output is written.
        OSError
            If a file cannot be read or written or exists, or a frame requires more than
            `memory_mb`.
        Interrupted
            If `progress` cancels; finished frames are kept.

        Notes
        -----
        Files are identical for any number of threads and any memory.
        """
        given = request_options(options, raw_format=raw_format, time_filter=time_filter,
                                filter=filter, rays=rays)
        given |= {"overwrite": bool(overwrite), "other_inputs": self._inputs}
        values = self._handle.decode_recording(
            _check.paths(raw, "raw"), _check.path(output, "output"), self._lens, given,
            _check.progress(progress))
        values["files"] = [FilePath(file) for file in values["files"]]
        return DecodedRecording(**values)

    @takes(StreamOptions)
    def decode_stream(
        self,
        source: BinaryIO,
        sink: Union[BinaryIO, Callable[[dict[str, npt.NDArray[Any]]], object]],
        *,
        raw_format: Path,
        time_filter: Optional[TimeFilterLike] = None,
        filter: Optional[FilterLike] = None,
        rays: Optional[Path] = None,
        progress: Progress = None,
        **options: Unpack[StreamOptions],
    ) -> DecodedStream:
        """Decodes frames from a pipe, socket or running camera, as `tofsmith decode - -o -`. Every
        frame is passed on before the next is read; memory is limited to a few frames.

        Parameters
        ----------
        source : binary file object
            Stream that contains a header and frames, as described by `raw_format`: e.g. `stdout` of
            subprocess, sys.stdin.buffer or socket.makefile("rb"). It must block until data is
            available.
        sink : callable, or binary file object
            Called with the planes of each frame, a dict of arrays (H, W) with the names in
            `outputs`; returning False stops. A file object receives the bytes of these planes in
            sequence, little endian: uint8 for status and returns, int32 for bin, and float32 for
            all others.
        raw_format : str or path
            A .raw.toml file; see docs/raw_formats.md.
        time_filter, filter, rays
            As in decode_recording().
        progress : callable, optional
            Called with (fraction, step); returning False cancels.
        **options
            As in StreamOptions.

        Returns
        -------
        DecodedStream

        Raises
        ------
        ValueError
            For an invalid request, or a stream that does not block.
        OSError
            If the stream ends before the first frame or within a frame, or a file cannot be read.
        Interrupted
            If `progress` cancels. Exceptions of `source` and `sink` are passed on.

        Notes
        -----
        Results are identical to the output of decode_recording().

        Examples
        --------
        >>> camera = subprocess.Popen(["v4l2-ctl", ...], stdout=subprocess.PIPE)  # doctest: +SKIP
        >>> decoder.decode_stream(camera.stdout, lambda planes: show(planes["depth"]),
        ...                       raw_format="sensor.raw.toml")  # doctest: +SKIP
        """
        if not (hasattr(source, "readinto") or hasattr(source, "read")):
            raise TypeError(f"source: got {_check.shown(source)}; needs a binary file object")
        write = getattr(sink, "write", None)
        take = sink if write is None and callable(sink) else None
        if write is None and take is None:
            raise TypeError(f"sink: got {_check.shown(sink)}; needs a callable or a binary file "
                            "object")
        given = request_options(options, raw_format=_check.path(raw_format, "raw_format"),
                                time_filter=time_filter, filter=filter, rays=rays)
        return DecodedStream(**self._handle.decode_stream(
            source, take, write, self._lens, given,
            _check.progress(progress)))

    def decode_depth_bins(self, measurements: npt.ArrayLike) -> FloatArray:
        """Returns the positions of measurements of shape (..., K), as an array of shape (...).
        Positions are in [0, N) [bins] and interpolated between bins; NaN if a measurement is NaN
        or infinite. Single-threaded."""
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


def _decoder_with_lens(
    table: DecodingTable, options: dict[str, Any], lens: Optional[dict[str, Any]]
) -> Decoder:
    """Restores a pickled decoder."""
    decoder = Decoder(table, **options)
    decoder._lens = lens
    return decoder


def decode(
    raw: RawLike,
    code: CodeLike | DecodingTable,
    camera: Optional[CameraLike] = None,
    *,
    method: str = "zncc",
    layout: str = "interleaved",
    planes: Optional[Iterable[str]] = None,
    filter: Optional[FilterLike] = None,
    mixed: Optional[str] = None,
    min_depth_m: Optional[float] = None,
    max_depth_m: Optional[float] = None,
    progress: Progress = None,
) -> DepthImage:
    """Decodes as Decoder(code, camera, method=method).decode(raw, ...).

    Create a Decoder to decode many frames.
    """
    decoder = Decoder(code, camera, method=method)
    return decoder.decode(raw, layout=layout, planes=planes, filter=filter, mixed=mixed,
                          min_depth_m=min_depth_m, max_depth_m=max_depth_m, progress=progress)

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
    """Depth from raw measurements. Immutable, safe to use from many threads at once.

    Parameters
    ----------
    code : CodeSet, DecodingTable, name of a family or file
        A DecodingTable is used as it is. A file as DecodingTable.load() takes it.
    camera : Camera or its name
        Needed unless `code` is a DecodingTable, for which it only says the lens.
    method : {"zncc", "ml", "unwrap", "two-return", "tail"}
        zncc for any code; ml by maximum likelihood, slower; unwrap for sinusoids of one or more
        frequencies; two-return and tail where light comes back twice or trails off, for codes of
        many independent means.
    unwrap_weights : {"variance", "frequency"}, optional
        Of unwrap.
    device : str, optional
        OpenCL device that averages, filters and decodes: "cpu" (none); "gpu", the first one;
        "auto", the first GPU for frames with a spatial filter, else the CPU; or a number or part
        of a name. Only zncc runs on devices. See docs/gpu.md.
    multipath : dict, optional
        For two-return and tail: keys of MultipathOptions; see docs/multipath.md.
    **options
        As DecodeOptions.

    Raises
    ------
    ValueError
        If the method cannot decode the code, or an option breaks a rule.
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
        """Name of the device that decodes, or cpu."""
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
        progress: Progress = None,
    ) -> DepthImage:
        """Decodes one frame or a stack on all threads. Raw numbers are read where they are,
        whatever the strides.

        Parameters
        ----------
        raw : ndarray, or a list of them
            float32, float64, uint16 or uint8 (other whole numbers are copied), (H, W, K) or
            (F, H, W, K); planar: (K, H, W) or (F, K, H, W); a list has one array a measurement, in
            their order, (H, W) or (F, H, W) each. Electrons, or counts where the camera has an ADC.
            NaN and infinity make a pixel invalid.
        layout : {"interleaved", "planar"}
            Never guessed.
        planes : iterable of str, optional
            Names of planes of DepthImage; others are not computed. None: the usual ones.
        out : DepthImage, optional
            Planes to write into: C order, of the frame's shape; instead of `planes`.
        averaged : float, or array_like of shape (H, W) or (F, H, W), optional
            Of how many equal measurements the numbers of each pixel are the mean, > 0, so that
            their noise is so much smaller: of frames averaged by hand, or of Filter.apply(). For
            the latter `filter` is better: it accounts for the direction of the noise that "normal"
            and "strong" leave, without which confidence is up to 0.12 too high.
        delay_offset_m, gain : array_like, shape (H, W), or float, optional
            By how much each pixel decodes too far [m], and its response over a usual one's; NaN
            marks a dead pixel.
        filter : {"light", "normal", "strong"}, dict or Filter, optional
            Pixels of the same depth are added before they are decoded, as by Filter. A dict holds
            its options, with "strength" among them; a Filter must be of the same code and camera.
        mixed : {"label", "snap", "drop"}, optional
            Finds pixels at edges of depth that see two surfaces and gives them the status mixed:
            label keeps their depth, snap gives them that of the nearest pixel of the surface with
            more light, drop leaves them none. With `filter`, frames are filtered once more without
            them. Needs depth, predicted standard deviation and status among the planes. See
            docs/filtering.md.
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
                            mixed_word(mixed), applied, callback)
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
        """Decodes a recording of any length into files, in memory that does not grow with it, as
        `tofsmith decode` does.

        Parameters
        ----------
        raw : str or path, or a list of them
            .npy, .npz or .h5, (H, W, K) or (F, H, W, K), or a dump that `raw_format` describes. A list
            has one file per measurement, in their order, (H, W) or (F, H, W) each, or grey images
            (.png .tiff .pgm).
        output : str or path
            .npy .pfm .png (16 bits, mm): depth alone; .npz: an array of each plane; .exr: a channel
            of each; .ply, .pcd (organized): points with planes as scalars. Files of several frames
            get numbers: name-03.npz.
        raw_format : str or path, optional
            A .raw.toml file; see docs/raw_formats.md.
        time_filter : int or dict, optional
            Averages the frames before, or means of frames, as long as they stay the same, as
            TimeFilter does: max_frames, or a dict with keys of TimeFilterOptions.
        filter : {"light", "normal", "strong"} or dict, optional
            Averages measurements of the same depth before decoding, as Filter does: a strength, or a
            dict of "strength" ("normal") and keys of FilterOptions.
        rays : str or path, optional
            Rays of points and z as the camera's maker gives them, in place of its lens (.npy): (H,
            W, 2) of x/z and y/z, or (H, W, 3) of directions; pixels of NaN are invalid.
        overwrite : bool
            Replace files that are there; never an input.
        progress : callable, optional
            Called with (fraction, step); False stops.
        **options
            As DecodeRequest.

        Returns
        -------
        DecodedRecording

        Raises
        ------
        ValueError
            For a request that cannot be, naming the argument, before anything is written.
        OSError
            If a file cannot be read or written, exists, or a frame needs more than `memory_mb`.
        Interrupted
            If `progress` says so; frames that are finished keep their files.

        Notes
        -----
        The same bytes for any number of threads and any memory.
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
        """Decodes frames as they come, each handed on before the next is read, in the memory of a
        few frames, as `tofsmith decode - -o -` does: from a pipe, a socket, a running camera.

        Parameters
        ----------
        source : binary file object
            Its header, then frame after frame, as `raw_format` describes them: what subprocess
            gives as `stdout`, sys.stdin.buffer, socket.makefile("rb"). It must wait for data.
        sink : callable, or binary file object
            Called with the planes of each frame, a dict of arrays (H, W) by the words of `outputs`;
            False stops. A file object gets the bytes of these planes, one after another: float32,
            status and returns uint8, bin int32, little end first.
        raw_format : str or path
            A .raw.toml file; see docs/raw_formats.md.
        time_filter, filter, rays
            As decode_recording() takes them.
        progress : callable, optional
            Called with (fraction, step); False stops.
        **options
            As StreamOptions.

        Returns
        -------
        DecodedStream

        Raises
        ------
        ValueError
            For a request that cannot be, or a stream that does not wait.
        OSError
            If the stream ends within a frame or ahead of the first, or a file cannot be read.
        Interrupted
            If `progress` says so. What `source` and `sink` raise passes on.

        Notes
        -----
        The same numbers as decode_recording() gives.

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


def _decoder_with_lens(
    table: DecodingTable, options: dict[str, Any], lens: Optional[dict[str, Any]]
) -> Decoder:
    """A pickled decoder."""
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
    progress: Progress = None,
) -> DepthImage:
    """Decoder(code, camera, method=method).decode(raw, ..): keep a Decoder for many frames."""
    decoder = Decoder(code, camera, method=method)
    return decoder.decode(raw, layout=layout, planes=planes, filter=filter, mixed=mixed,
                          progress=progress)

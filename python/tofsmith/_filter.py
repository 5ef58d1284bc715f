# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Spatial and temporal filtering of raw measurements, before decoding."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Optional, Union, Unpack

import numpy as np
import numpy.typing as npt

from . import _check, _tofsmith
from ._camera import CameraLike
from ._check import Progress, RawLike
from ._code import CodeLike
from ._decoding_table import DecodingTable, table_of
from ._option_fields import FilterOptions, TimeFilterOptions
from ._options import takes

#: A strength, or a dict of "strength" and fields of FilterOptions.
FilterLike = Union[str, Mapping[str, Any]]


def filter_options(filter: FilterLike) -> dict[str, Any]:
    """Converts a FilterLike to a dict."""
    if isinstance(filter, str):
        return {"strength": filter}
    if not isinstance(filter, Mapping):
        raise TypeError(f"filter: got {_check.shown(filter)}; needs one of "
                        f"{', '.join(_tofsmith.filter_strengths())}, or a dict of options")
    return {"strength": "normal", **filter}


#: max_frames, or a dict of it and other fields of TimeFilterOptions.
TimeFilterLike = Union[int, Mapping[str, Any]]


def time_filter_options(time_filter: TimeFilterLike) -> dict[str, Any]:
    """Converts a TimeFilterLike to a dict."""
    if not isinstance(time_filter, Mapping):
        return {"max_frames": _check.whole(time_filter, "time_filter", 1)}
    if "max_frames" not in time_filter:
        raise ValueError(f"time_filter: got {_check.shown(time_filter)}; needs max_frames")
    return dict(time_filter)


def _frames(
    raw: RawLike, averaged: Optional[npt.ArrayLike], layout: str
) -> tuple[npt.NDArray[Any], bool, Optional[npt.NDArray[Any]]]:
    """Returns raw numbers, whether they are planar, and the number of averaged measurements."""
    array, is_planar = _check.raw_array(raw, layout)
    return array, is_planar, _check.means(averaged, array, is_planar)


class _OfTable:
    """Base of filters, with a table and options."""

    _handle: Union[_tofsmith.Filter, _tofsmith.TimeFilter]

    @property
    def table(self) -> DecodingTable:
        return DecodingTable._of(self._handle.table())

    @property
    def options(self) -> dict[str, Any]:
        """The fields of FilterOptions or TimeFilterOptions by name."""
        return self._handle.options()


class Filter(_OfTable):
    """Averages the raw measurements of neighbouring pixels at the same depth, before decoding.
    Immutable and thread-safe.

    After projecting out ambient light, the measurement vectors of one depth are parallel for any
    albedo, so that they can be averaged without bias. A test that accounts for the noise decides
    whether two pixels are averaged. See docs/filtering.md.

    Parameters
    ----------
    code : CodeSet, DecodingTable, name of a family or file
        As in Decoder.
    camera : Camera or its name
        Required unless `code` is a DecodingTable.
    strength : {"normal", "light", "strong"}
        light averages over 5 x 5 pixels, and is several times as fast as normal. normal averages
        over 25 x 25 pixels, and once more along the estimated slopes. strong repeats the pass along
        slopes.
    options : dict, optional
        For experts: keys of FilterOptions, which override the values of the strength.
    device : str, optional
        OpenCL device of the filter, as for Decoder. See docs/gpu.md.

    Raises
    ------
    ValueError
        For an unknown strength or an invalid option.
    OSError
        If there is no such device, or the device fails.

    Examples
    --------
    >>> filter = Filter("hamiltonian-k4", "paper-10f0", strength="light")
    >>> raw, averaged = filter.apply(np.full((20, 30, 4), 1000, np.uint16))
    >>> raw.shape, averaged.shape
    ((20, 30, 4), (20, 30))
    >>> Decoder(filter.table).decode(raw, averaged=averaged).depth_m.shape
    (20, 30)
    """

    def __init__(
        self,
        code: CodeLike | DecodingTable,
        camera: Optional[CameraLike] = None,
        *,
        strength: str = "normal",
        options: Union[FilterOptions, Mapping[str, Any], None] = None,
        device: str = "cpu",
    ) -> None:
        _check.one_of(strength, "strength", tuple(_tofsmith.filter_strengths()))
        values = {} if options is None else dict(options)
        self._handle: _tofsmith.Filter = _tofsmith.Filter(
            table_of(code, camera)._handle, {**values, "strength": strength}, device)

    @property
    def device(self) -> str:
        """Name of the OpenCL device of the filter, or cpu."""
        return self._handle.device()

    def apply(
        self,
        raw: RawLike,
        *,
        averaged: Optional[npt.ArrayLike] = None,
        layout: str = "interleaved",
        progress: Progress = None,
    ) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]:
        """Filters one frame, or each of a stack, on all threads.

        Parameters
        ----------
        raw : ndarray
            As in Decoder.decode(), unprocessed. Pixels that are invalid or saturated do not change
            and do not affect others.
        averaged : float, or array_like of shape (H, W) or (F, H, W), optional
            Number of measurements averaged in each pixel, if the numbers are already means.
        layout : {"interleaved", "planar"}
            Not inferred from the shape.
        progress : callable, optional
            Called with (fraction, step); returning False cancels.

        Returns
        -------
        raw : ndarray of float32, shape (H, W, K) or (F, H, W, K)
            Raw numbers for any decoder.
        averaged : ndarray of float32, shape (H, W) or (F, H, W)
            Effective number of averaged measurements (variance reduction), for `averaged` of
            Decoder.decode().

        Raises
        ------
        ValueError
            For an unsupported dtype or shape.
        Interrupted
            If `progress` cancels.

        Notes
        -----
        Results are identical for any number of threads and any layout.
        """
        return self._handle.apply(*_frames(raw, averaged, layout), _check.progress(progress))


@takes(TimeFilterOptions)
class TimeFilter(_OfTable):
    """Averages the raw measurements of each pixel over frames as long as they do not change, before
    decoding. Averaging restarts where the scene changes, so that motion is not smeared. Frames wait
    for later ones only with `look_ahead`. Stores the current mean; not thread-safe.

    Three tests that account for the noise detect changes: of the pixel, of its neighbourhood, and
    of the mean change of the neighbourhood. See docs/filtering.md.

    Parameters
    ----------
    code, camera
        As in Filter.
    **options
        As in TimeFilterOptions. With `look_ahead`, end() returns the last frames.

    Raises
    ------
    ValueError
        For an invalid option.

    Examples
    --------
    >>> filter = TimeFilter("hamiltonian-k4", "paper-10f0", max_frames=30)
    >>> raw, averaged = filter.add(np.full((20, 30, 4), 1000, np.uint16))
    >>> raw, averaged = filter.add(np.full((20, 30, 4), 1000, np.uint16))
    >>> float(averaged[0, 0])
    2.0
    >>> Decoder(filter.table).decode(raw, averaged=averaged).depth_m.shape
    (20, 30)
    """

    def __init__(
        self,
        code: CodeLike | DecodingTable,
        camera: Optional[CameraLike] = None,
        **options: Unpack[TimeFilterOptions],
    ) -> None:
        self._handle: _tofsmith.TimeFilter = _tofsmith.TimeFilter(
            table_of(code, camera)._handle, dict(options))

    def add(
        self,
        raw: RawLike,
        *,
        averaged: Optional[npt.ArrayLike] = None,
        layout: str = "interleaved",
        progress: Progress = None,
    ) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]:
        """Adds the next frame, or the frames of a stack in order, on all threads.

        Parameters
        ----------
        raw : ndarray
            As in Decoder.decode(), unprocessed, with the size of the earlier frames. Averaging
            restarts for pixels that are invalid or saturated.
        averaged, layout, progress
            As in Filter.apply().

        Returns
        -------
        raw : ndarray of float32, shape (H, W, K) or (F, H, W, K)
            Raw numbers for any decoder. With `look_ahead`, this is always a stack. It contains the
            frames for which enough later frames were added, and is empty at first.
        averaged : ndarray of float32, shape (H, W) or (F, H, W)
            As from Filter.apply().

        Raises
        ------
        ValueError, Interrupted
            As from Filter.apply().
        """
        return self._handle.add(*_frames(raw, averaged, layout), _check.progress(progress))

    def end(
        self, *, progress: Progress = None
    ) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]:
        """Returns the frames that still wait for later ones, as stacks in the format of add(). Must
        be called after the last frame. The stacks are empty without `look_ahead`. The next frame
        starts a new sequence and may have any size.
        """
        return self._handle.end(_check.progress(progress))

    def forget(self) -> None:
        """Starts a new sequence. The next frame may have any size."""
        self._handle.forget()


def merge_exposures(
    raw: RawLike,
    exposures: Sequence[float],
    code: CodeLike | DecodingTable,
    camera: Optional[CameraLike] = None,
    *,
    averaged: Optional[npt.ArrayLike] = None,
    layout: str = "interleaved",
) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]:
    """Merges frames of one scene at several exposures (HDR), before decoding. Each pixel is the
    average of the frames in which it is not saturated, weighted by their noise and scaled to the
    shortest exposure. See docs/recordings.md.

    Parameters
    ----------
    raw : ndarray, shape (F, H, W, K)
        As in Decoder.decode(), one frame per exposure.
    exposures : sequence of float, F of them
        Relative to the shortest, which is the camera's, e.g. (1, 4, 16).
    code : CodeSet, DecodingTable, name of a family or file
        As in Decoder.
    camera : Camera or its name
        Required unless `code` is a DecodingTable.
    averaged : float, or array_like of shape (F, H, W), optional
        Number of measurements averaged in each pixel, if the numbers are already means.
    layout : {"interleaved", "planar"}
        Not inferred from the shape.

    Returns
    -------
    raw : ndarray of float32, shape (H, W, K)
        Raw numbers for any decoder; pixels saturated in all exposures remain saturated.
    averaged : ndarray of float32, shape (H, W)
        Effective number of averaged measurements of the shortest exposure (variance reduction), for
        `averaged` of Decoder.decode().

    Raises
    ------
    ValueError
        For another shape, or if the shortest exposure is not 1.

    Examples
    --------
    >>> numbers, averaged = merge_exposures(frames, (1, 4, 16), "hamiltonian-k4",
    ...                                     camera)  # doctest: +SKIP
    >>> image = decoder.decode(numbers, averaged=averaged)  # doctest: +SKIP
    """
    return _tofsmith.merge_exposures(
        table_of(code, camera)._handle, *_frames(raw, averaged, layout),
        [_check.number(exposure, "exposures") for exposure in exposures])

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Measurements of the same depth, in space and time, added before they are decoded."""

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
    """The dict of a FilterLike."""
    if isinstance(filter, str):
        return {"strength": filter}
    if not isinstance(filter, Mapping):
        raise TypeError(f"filter: got {_check.shown(filter)}; needs one of "
                        f"{', '.join(_tofsmith.filter_strengths())}, or a dict of options")
    return {"strength": "normal", **filter}


#: max_frames, or a dict of it and other fields of TimeFilterOptions.
TimeFilterLike = Union[int, Mapping[str, Any]]


def time_filter_options(time_filter: TimeFilterLike) -> dict[str, Any]:
    """The dict of a TimeFilterLike."""
    if not isinstance(time_filter, Mapping):
        return {"max_frames": _check.whole(time_filter, "time_filter", 1)}
    if "max_frames" not in time_filter:
        raise ValueError(f"time_filter: got {_check.shown(time_filter)}; needs max_frames")
    return dict(time_filter)


def _frames(
    raw: RawLike, averaged: Optional[npt.ArrayLike], layout: str
) -> tuple[npt.NDArray[Any], bool, Optional[npt.NDArray[Any]]]:
    """Raw numbers, whether they are planar, and of how many measurements they are the mean."""
    array, is_planar = _check.raw_array(raw, layout)
    return array, is_planar, _check.means(averaged, array, is_planar)


class _OfTable:
    """What filters know."""

    _handle: Union[_tofsmith.Filter, _tofsmith.TimeFilter]

    @property
    def table(self) -> DecodingTable:
        return DecodingTable._of(self._handle.table())

    @property
    def options(self) -> dict[str, Any]:
        """The fields of FilterOptions or TimeFilterOptions by name."""
        return self._handle.options()


class Filter(_OfTable):
    """Adds the raw measurements of pixels that see the same depth, before anything is decoded.
    Immutable, safe to use from many threads at once.

    Without ambient light, measurements of one depth are parallel whatever the albedo, so that they
    may be added without bias; whether two pixels may be is a test that knows the noise of each. See
    docs/filtering.md.

    Parameters
    ----------
    code : CodeSet, DecodingTable, name of a family or file
        As Decoder takes it.
    camera : Camera or its name
        Needed unless `code` is a DecodingTable.
    strength : {"normal", "light", "strong"}
        normal adds over 25 x 25 pixels, and once more along the slopes found; light over 5 x 5
        pixels, several times as fast; strong goes along the slopes twice.
    options : dict, optional
        For experts: keys of FilterOptions, in place of the values of the strength.
    device : str, optional
        OpenCL device that filters, as for Decoder. See docs/gpu.md.

    Raises
    ------
    ValueError
        For another strength, or an option that breaks a rule.
    OSError
        If there is no such device, or it fails.

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
        """Name of the device that filters, or cpu."""
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
            As Decoder.decode() takes it, as it leaves the sensor. Pixels that are invalid or
            saturated stay as they are and are added to none.
        averaged : float, or array_like of shape (H, W) or (F, H, W), optional
            Of how many measurements each pixel's numbers are the mean, where they are.
        layout : {"interleaved", "planar"}
            Never guessed.
        progress : callable, optional
            Called with (fraction, step); False stops.

        Returns
        -------
        raw : ndarray of float32, shape (H, W, K) or (F, H, W, K)
            Raw numbers as any decoder takes them.
        averaged : ndarray of float32, shape (H, W) or (F, H, W)
            Of how many measurements each is the mean, in variance: Decoder.decode()'s `averaged`.

        Raises
        ------
        ValueError
            For another dtype or shape.
        Interrupted
            If `progress` says so.

        Notes
        -----
        The same bits for any number of threads and any layout.
        """
        return self._handle.apply(*_frames(raw, averaged, layout), _check.progress(progress))


@takes(TimeFilterOptions)
class TimeFilter(_OfTable):
    """Adds the raw measurements of each pixel, frame after frame, as long as they stay the same,
    before anything is decoded. What changes starts anew, so that nothing smears. No frame waits for
    a later one, unless it is to look ahead. Keeps the frame so far; not for several threads at once.

    Whether something changed is a test of the pixel, of those around it, and of what they share,
    that knows the noise of each. See docs/filtering.md.

    Parameters
    ----------
    code : CodeSet, DecodingTable, name of a family or file
        As Decoder takes it.
    camera : Camera or its name
        Needed unless `code` is a DecodingTable.
    **options
        As TimeFilterOptions. With `look_ahead`, end() gives the frames that still wait after the last.

    Raises
    ------
    ValueError
        For an option that breaks a rule.

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
        """Adds the next frame, or those of a stack one after another, on all threads.

        Parameters
        ----------
        raw : ndarray
            As Decoder.decode() takes it, as it leaves the sensor, as large as the frames before.
            Pixels that are invalid or saturated stay as they are and start anew.
        averaged : float, or array_like of shape (H, W) or (F, H, W), optional
            Of how many measurements each pixel's numbers are the mean, where they are.
        layout : {"interleaved", "planar"}
            Never guessed.
        progress : callable, optional
            Called with (fraction, step); False stops.

        Returns
        -------
        raw : ndarray of float32, shape (H, W, K) or (F, H, W, K)
            Raw numbers as any decoder takes them. With `look_ahead` always a stack, of those frames
            for which enough later ones have come: none of the first.
        averaged : ndarray of float32, shape (H, W) or (F, H, W)
            Of how many measurements each is the mean, in variance: Decoder.decode()'s `averaged`.

        Raises
        ------
        ValueError
            For another dtype or shape.
        Interrupted
            If `progress` says so.

        Notes
        -----
        The same bits for any number of threads and any layout.
        """
        return self._handle.add(*_frames(raw, averaged, layout), _check.progress(progress))

    def end(
        self, *, progress: Progress = None
    ) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]:
        """After the last frame: stacks of those that still wait for later ones, as add() gives them;
        none without `look_ahead`. The next frame is the first again, of any size.
        """
        return self._handle.end(_check.progress(progress))

    def forget(self) -> None:
        """The next frame is the first again, of any size."""
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
    """Merges frames of one scene at several exposures (HDR) into one of the shortest, before
    anything is decoded: in each pixel those that are not saturated there, by their noise. See
    docs/recordings.md.

    Parameters
    ----------
    raw : ndarray, shape (F, H, W, K)
        As Decoder.decode() takes it, a frame of each exposure.
    exposures : sequence of float, F of them
        Over the shortest, which is the camera's: such as (1, 4, 16).
    code : CodeSet, DecodingTable, name of a family or file
        As Decoder takes it.
    camera : Camera or its name
        Needed unless `code` is a DecodingTable.
    averaged : float, or array_like of shape (F, H, W), optional
        Of how many measurements each pixel's numbers are the mean, where they are.
    layout : {"interleaved", "planar"}
        Never guessed.

    Returns
    -------
    raw : ndarray of float32, shape (H, W, K)
        Raw numbers as any decoder takes them; pixels saturated in all exposures stay so.
    averaged : ndarray of float32, shape (H, W)
        Of how many of the shortest exposure each is the mean, in variance: Decoder.decode()'s
        `averaged`.

    Raises
    ------
    ValueError
        For another shape, or exposures of which the shortest is not 1.

    Examples
    --------
    >>> numbers, averaged = merge_exposures(frames, (1, 4, 16), "hamiltonian-k4",
    ...                                     camera)  # doctest: +SKIP
    >>> image = decoder.decode(numbers, averaged=averaged)  # doctest: +SKIP
    """
    return _tofsmith.merge_exposures(
        table_of(code, camera)._handle, *_frames(raw, averaged, layout),
        [_check.number(exposure, "exposures") for exposure in exposures])

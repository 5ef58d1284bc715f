# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Files of raw frames, depth, measured tables and point clouds."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Optional

import numpy as np
import numpy.typing as npt

from . import _check, _tofsmith
from ._check import FloatArray, Path


def read_raw(
    path: Path,
    *,
    measurements: Optional[int] = None,
    layout: str = "interleaved",
    raw_format: Optional[Path] = None,
    dataset: str = "",
) -> npt.NDArray[np.float32]:
    """Reads raw frames from .npy, .npz or .h5, or from a dump described by a .raw.toml file.

    Parameters
    ----------
    path : str or path
    measurements : int, optional
        K of the code; other values are rejected.
    layout : {"interleaved", "planar"}
        Layout of the file; not inferred from the shape.
    raw_format : str or path, optional
        A .raw.toml file, see docs/raw_formats.md.
    dataset : str
        Array of an .npz or data set of an .h5; "": the one named "raw", or the only one.

    Returns
    -------
    ndarray of float32, shape (F, H, W, K)

    Raises
    ------
    OSError
        Naming file and position, the value found and the value expected.
    """
    return _tofsmith.read_raw(
        _check.path(path),
        None if measurements is None else _check.whole(measurements, "measurements", 1),
        _check.text(layout, "layout"),
        None if raw_format is None else _check.path(raw_format, "raw_format"),
        _check.text(dataset, "dataset"),
    )


def write_raw(path: Path, raw: npt.ArrayLike, *, overwrite: bool = False) -> None:
    """Writes (H, W, K) or (F, H, W, K) as float32 to .npy or .npz.

    Raises
    ------
    OSError
        If the file exists and `overwrite` is not set, or cannot be written.
    """
    array = np.asarray(raw)
    axes = "(H, W, K)" if array.ndim == 3 else "(F, H, W, K)"
    frames = np.asarray(_check.real_array(array, "raw", axes), np.float32)
    _tofsmith.write_raw(_check.path(path), frames.reshape(-1, *frames.shape[-3:]), bool(overwrite))


def read_depth(path: Path) -> npt.NDArray[np.float32]:
    """Reads depth [m] (H, W), NaN without return; .npy .npz .exr .pfm .png (16 bits, mm)."""
    return _tofsmith.read_depth(_check.path(path))


def write_depth(path: Path, depth_m: npt.ArrayLike, *, overwrite: bool = False) -> None:
    """Writes depth [m] (H, W) by extension: .npy .npz .exr .pfm .png (16 bits, mm)."""
    depth = np.asarray(_check.real_array(depth_m, "depth_m", "(H, W)"), np.float32)
    _tofsmith.write_depth(_check.path(path), depth, bool(overwrite))


def write_points(
    path: Path,
    points_m: npt.ArrayLike,
    scalars: Optional[Mapping[str, npt.ArrayLike]] = None,
    *,
    overwrite: bool = False,
) -> None:
    """Writes a point cloud as .ply, without points that are not finite.

    Parameters
    ----------
    path : str or path
    points_m : array_like, shape (..., 3)
        x, y, z [m].
    scalars : dict of array_like, shape (...), optional
        Additional numbers per point, such as {"intensity": image.signal_e_per_s}.
    overwrite : bool
    """
    points = np.asarray(points_m)
    if points.ndim < 2 or points.shape[-1] != 3 or points.dtype.kind not in "fiu":
        raise ValueError(f"points_m: got {_check.shown(points)}; needs numbers of shape (.., 3)")
    flat = points.reshape(-1, 3).astype(np.float32)
    kept = np.isfinite(flat).all(axis=1)
    columns = {}
    for name, values in (scalars or {}).items():
        column = np.asarray(values)
        if column.shape != points.shape[:-1]:
            raise ValueError(
                f"scalars['{name}']: got shape {column.shape}; needs {points.shape[:-1]}"
            )
        columns[name] = column.reshape(-1)[kept].astype(np.float32)
    _tofsmith.write_points(_check.path(path), flat[kept], columns, bool(overwrite))


def read_correlation_functions(path: Path) -> FloatArray:
    """Reads correlation functions (N, K) from a text, .npy or .npz (corrfs), as design target."""
    return _tofsmith.read_correlation_functions(_check.path(path))


def read_measured_table(
    path: Path,
    *,
    taps: int = 1,
    tap_order: Optional[str] = None,
    table_axes: Optional[str] = None,
    keep_end_point: bool = False,
) -> tuple[FloatArray, list[str]]:
    """Reads a measured correlation table (N, K) from a text, .npy or .npz, with notes on its
    interpretation, for DecodingTable.of_measured().

    Parameters
    ----------
    path : str or path
    taps : int
    tap_order : {"blocked", "interleaved"}, optional
        Required for several taps.
    table_axes : {"nk", "kn"}, optional
        Axes of an array: (N, K) or (K, N).
    keep_end_point : bool
        Keep a last sample that equals the first.
    """
    count = _check.whole(taps, "taps", 1, 64)
    return _tofsmith.read_measured_table(
        _check.path(path), count, tap_order, table_axes, bool(keep_end_point)
    )


def read_impulse_response(
    path: Path, time_step_s: Optional[float] = None
) -> tuple[FloatArray, float]:
    """Reads a measured impulse response from a text or .npy: samples (T,) and time step [s].

    Examples
    --------
    >>> samples, step = read_impulse_response("response.csv")  # doctest: +SKIP
    >>> response = {"kind": "file", "samples": samples, "time_step_s": step}  # doctest: +SKIP
    >>> camera = camera.replace(light={"impulse_response": response})  # doctest: +SKIP
    """
    step = _check.optional_number(time_step_s, "time_step_s")
    return _tofsmith.read_impulse_response(_check.path(path), step)

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Checks of user arguments. Errors name the argument, the value and the requirement."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import Any, Optional, TypeVar, Union

import numpy as np
import numpy.typing as npt

Kind = TypeVar("Kind")
Path = Union[str, "os.PathLike[str]"]
#: Called regularly with the completed fraction and the current step; returning False cancels.
Progress = Optional[Callable[[float, str], Optional[bool]]]
FloatArray = npt.NDArray[np.float64]
#: Raw numbers in one array, or one array per measurement.
RawLike = Union[npt.NDArray[Any], Sequence[npt.NDArray[Any]]]


def shown(value: object) -> str:
    """Describes a value for error messages."""
    if isinstance(value, np.ndarray):
        return f"an array of shape {value.shape} and dtype {value.dtype}"
    text = repr(value)
    return f"{type(value).__name__} {text if len(text) <= 60 else text[:60] + '..'}"


def instance(value: object, kind: type[Kind], name: str) -> Kind:
    """Returns `value`, which must be of class `kind`."""
    if isinstance(value, kind):
        return value
    raise TypeError(f"{name}: got {shown(value)}; needs a tofsmith.{kind.__name__}")


def path(value: Path, name: str = "path") -> str:
    """Returns the name of a file."""
    try:
        text = os.fspath(value)
    except TypeError:
        raise TypeError(f"{name}: got {shown(value)}; needs the name of a file") from None
    if not isinstance(text, str) or "\0" in text:
        raise TypeError(f"{name}: got {shown(value)}; needs the name of a file as text")
    return text


def paths(value: Any, name: str) -> list[str]:
    """Returns the names of one or more files."""
    if isinstance(value, (list, tuple)):
        return [path(file, f"{name}[{k}]") for k, file in enumerate(value)]
    return [path(value, name)]


def text(value: object, name: str) -> str:
    if isinstance(value, str):
        return value
    raise TypeError(f"{name}: got {shown(value)}; needs a text")


def whole(value: Any, name: str, least: int, most: int = 2**31 - 1) -> int:
    """Returns an integer in a range; also accepts NumPy numbers and floats such as 1e4."""
    if isinstance(value, (float, np.floating)) and float(value).is_integer():
        value = int(value)
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, (int, np.integer)):
        raise TypeError(f"{name}: got {shown(value)}; needs a whole number")
    if not least <= value <= most:
        raise ValueError(f"{name}: got {int(value)}; needs a whole number from {least} to {most}")
    return int(value)


def number(value: Any, name: str) -> float:
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, (int, float, np.number)):
        raise TypeError(f"{name}: got {shown(value)}; needs a number")
    if not np.isreal(value) or not np.isfinite(value):
        raise ValueError(f"{name}: got {value}; needs a finite number")
    return float(value)


def optional_number(value: Any, name: str) -> Optional[float]:
    return None if value is None else number(value, name)


def numbers(value: Any, name: str) -> Optional[list[float]]:
    """Returns a list of numbers; converts a single number to a list and keeps None."""
    if value is None:
        return None
    several = [value] if np.ndim(value) == 0 else list(value)
    return [number(each, name) for each in several]


def one_of(value: object, name: str, words: tuple[str, ...]) -> str:
    if isinstance(value, str) and value in words:
        return value
    raise ValueError(f"{name}: got {shown(value)}; needs one of {', '.join(words)}")


def without_mask(value: Any) -> Any:
    """Replaces masked numbers by NaN, converting integers to floats if necessary. Returns other
    values unchanged."""
    if not isinstance(value, np.ma.MaskedArray):
        return value
    mask = np.broadcast_to(np.asarray(value.mask), value.shape)
    if not mask.any():
        return value.data
    numbers = np.array(value.data, np.result_type(value.dtype, np.float32))
    numbers[mask] = np.nan
    return numbers


def real_array(value: Any, name: str, axes: str) -> npt.NDArray[Any]:
    """Returns an array of real numbers with the number of axes in `axes`, such as "(N, K)"."""
    if isinstance(value, (str, os.PathLike)):
        raise TypeError(f"{name}: got {shown(value)}; needs real numbers, {axes}, not the "
                        "name of a file (read_depth(), read_raw() and numpy.load() read them)")
    array: npt.NDArray[Any] = np.asanyarray(without_mask(value))
    if array.dtype.kind not in "fiu":
        raise ValueError(f"{name}: got dtype {array.dtype}; needs real numbers, such as float64")
    count = 0 if axes == "()" else axes.rstrip(",)").count(",") + 1
    if array.ndim != count:
        raise ValueError(f"{name}: got shape {array.shape}; needs {axes}")
    if array.size == 0:
        raise ValueError(f"{name}: got shape {array.shape}, which is empty; needs {axes}")
    return array


def means(averaged: Any, raw: npt.NDArray[Any], is_planar: bool) -> Optional[npt.NDArray[Any]]:
    """Returns the number of measurements averaged into each pixel of `raw`; None: one."""
    if averaged is not None and np.ndim(averaged) == 0 and raw.ndim in (3, 4):
        shape = raw.shape[:-3] + raw.shape[-2:] if is_planar else raw.shape[:-1]
        return np.full(shape, number(averaged, "averaged"), np.float32)
    axes = "(H, W)" if raw.ndim == 3 else "(F, H, W)"
    return None if averaged is None else real_array(averaged, "averaged", axes)


def finite_array(value: Any, name: str, axes: str) -> FloatArray:
    """As real_array(), for finite numbers, as float64."""
    array = np.asarray(real_array(value, name, axes), dtype=np.float64)
    if not np.isfinite(array).all():
        index = tuple(int(i) for i in np.argwhere(~np.isfinite(array))[0])
        place = index[0] if len(index) == 1 else index
        raise ValueError(f"{name}: got {array[index]} at {place}; needs finite numbers")
    return array


def frames(value: Any, name: str) -> npt.NDArray[np.float32]:
    """Returns raw frames as float32. Numbers that are not finite are kept: they mark dead
    pixels."""
    return np.asarray(real_array(value, name, "(F, H, W, K)"), dtype=np.float32)


def progress(value: Progress) -> Progress:
    if value is None or callable(value):
        return value
    raise TypeError(
        f"progress: got {shown(value)}; needs a function of (fraction, step), or None"
    )


def raw_array(raw: Any, layout: str) -> tuple[npt.NDArray[Any], bool]:
    """Returns raw numbers without copying, and whether they are planar. A list with one array per
    measurement is stacked. int8, int16 and float16 become float32, larger integers float64."""
    is_planar = one_of(layout, "layout", ("interleaved", "planar")) == "planar"
    if isinstance(raw, (list, tuple)):
        raw, is_planar = _together(raw), True
    raw = _numpy_array(raw, "raw", "a numpy.ndarray, or a list of them, one per measurement")
    if raw.dtype in (np.int8, np.int16, np.float16):
        raw = raw.astype(np.float32)
    elif raw.dtype.kind in "iu" and raw.dtype.itemsize > 2:
        raw = raw.astype(np.float64)
    return raw, is_planar


def _numpy_array(value: Any, name: str, needed: str) -> npt.NDArray[Any]:
    """Converts array-likes (torch, xarray, ...) to NumPy, with NaN for masked numbers."""
    value = without_mask(value)
    if not isinstance(value, np.ndarray) and hasattr(value, "__array__"):
        value = np.asarray(value)
    if isinstance(value, np.ndarray):
        return value
    if isinstance(value, (str, os.PathLike)):
        needed += f"; read_raw({os.fspath(value)!r}) reads one"
    raise TypeError(f"{name}: got {shown(value)}; needs {needed}")


def _together(given: Sequence[Any]) -> npt.NDArray[Any]:
    """Stacks arrays (H, W) to (K, H, W), or (F, H, W) to (F, K, H, W)."""
    arrays = [_numpy_array(a, f"raw[{k}]", "a numpy.ndarray") for k, a in enumerate(given)]
    for k, array in enumerate(arrays):
        if array.ndim not in (2, 3):
            raise ValueError(f"raw[{k}]: got shape {array.shape}; needs (H, W) or (F, H, W), "
                             "because each array contains one measurement")
        if (array.shape, array.dtype) != (arrays[0].shape, arrays[0].dtype):
            raise ValueError(f"raw[{k}]: got {array.dtype} of shape {array.shape}; needs "
                             f"{arrays[0].dtype} of shape {arrays[0].shape}, as raw[0]")
    if not arrays:
        raise ValueError("raw: got no arrays; needs one per measurement")
    return np.stack(arrays, axis=-3)

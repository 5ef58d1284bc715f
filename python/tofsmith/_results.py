# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Conversion of the compiled module's results to classes."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from functools import cache
from typing import Any, NamedTuple, TypeVar, Union, get_args, get_origin, get_type_hints

from . import _check
from ._check import Path

Kind = TypeVar("Kind")
#: Annotated types of a class by the names of its members.
_types_of: Callable[[type], dict[str, Any]] = cache(get_type_hints)


class Estimate(NamedTuple):
    """A value and its standard error."""

    value: float
    standard_error: float


def result_of(kind: type[Kind], values: Mapping[str, Any]) -> Kind:
    """Returns an object of a dataclass from values of the compiled module, which are converted to
    the annotated types: dicts to dataclasses, pairs to Estimate, handles to the classes that
    contain them."""
    types = _types_of(kind)
    return kind(**{name: _converted(types[name], value) for name, value in values.items()})


def calibrated(kind: type[Kind], handle: Any, **others: Any) -> Kind:
    """Returns the result of a calibration, which keeps its handle."""
    return result_of(kind, {**handle.fields(), "_handle": handle, **others})


def _converted(kind: Any, value: Any) -> Any:
    origin, items = get_origin(kind), get_args(kind)
    if value is None:
        return None
    if origin is Union:
        return _converted(items[0], value)
    if origin is list:
        return [_converted(items[0], item) for item in value]
    if origin is dict:
        return {key: _converted(items[1], item) for key, item in value.items()}
    if origin is tuple and Ellipsis not in items:
        return tuple(map(_converted, items, value))
    if kind is Estimate:
        return Estimate(*value)
    if isinstance(kind, type) and dataclasses.is_dataclass(kind) and isinstance(value, dict):
        return result_of(kind, value)
    return kind._of(value) if hasattr(kind, "_of") else value


class WithReport:
    """Base of calibrations with a report page."""

    _handle: Any

    def write_report(
        self, path: Path, *, source: str = "frames", overwrite: bool = False
    ) -> None:
        """Writes the page of `tofsmith calibrate ... --report` (.html), with `source` in its
        title."""
        self._handle.write_report(
            _check.path(path), _check.text(source, "source"), bool(overwrite)
        )

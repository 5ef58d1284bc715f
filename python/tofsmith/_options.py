# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Functions whose keyword options are described in C++."""

from __future__ import annotations

import difflib
import functools
import inspect
import re
import textwrap
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

from ._option import Option
from ._option_fields import OPTIONS

Kind = TypeVar("Kind", bound=Callable[..., Any])


def takes(kind: type[Any]) -> Callable[[Kind], Kind]:
    """Decorator for a function or class whose `**options` are keys of a dict of _option_fields.
    Adds the options to the signature and, replacing the entry `**options`, to the docstring.
    Rejects other names."""
    options = OPTIONS[kind]

    def decorate(target: Any) -> Any:
        if not isinstance(target, type):
            return _with_options(target, options)
        setattr(target, "__init__", _with_options(getattr(target, "__init__"), options))
        target.__doc__ = _documented(target.__doc__, options)
        return target

    return decorate


def _with_options(function: Any, options: Sequence[Option]) -> Any:
    signature = inspect.signature(function)
    own = [p for p in signature.parameters.values() if p.kind is not p.VAR_KEYWORD]
    added = [
        inspect.Parameter(option.name, inspect.Parameter.KEYWORD_ONLY, default=option.default,
                          annotation="str" if option.kind.startswith("{") else option.kind)
        for option in options
    ]
    known = {parameter.name for parameter in own + added}

    @functools.wraps(function)
    def checked(*arguments: Any, **named: Any) -> Any:
        for name in named:
            if name not in known:
                near = difflib.get_close_matches(name, known, 1)
                raise TypeError(f"{function.__qualname__.removesuffix('.__init__')}() got an "
                                f"unexpected keyword argument '{name}'"
                                + (f"; did you mean {near[0]}?" if near else ""))
        return function(*arguments, **named)

    setattr(checked, "__signature__", signature.replace(parameters=own + added))
    checked.__doc__ = _documented(function.__doc__, options)
    return checked


def _documented(text: str | None, options: Sequence[Option]) -> str | None:
    """Replaces the entry `**options` of the docstring by the options."""
    if text is None:
        return None

    def entries(match: re.Match[str]) -> str:
        indent = match.group(1)
        lines = []
        for option in options:
            lines.append(f"{indent}{option.name} : {option.kind}, optional")
            lines += textwrap.wrap(option.text, 88, initial_indent=indent + " " * 4,
                                   subsequent_indent=indent + " " * 4)
        return "\n".join(lines) + "\n"

    return re.sub(r"^( *)\*\*options\n(?:\1 +.*\n)*", entries, text, flags=re.MULTILINE)

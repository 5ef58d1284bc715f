# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Description of one keyword option."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Option:
    """A keyword option: name, type in words, default and description."""

    name: str
    kind: str
    default: Any
    text: str

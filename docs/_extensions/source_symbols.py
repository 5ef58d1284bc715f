# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Links from pages into the code: which file, and the line on which a named symbol is defined.

A page writes [`Decoder::rank`](../include/tofsmith/decode/decoder.hpp): a plain link for whoever
reads the file as it is, and on the site the line. Lines are looked up, never written by hand.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Iterator, NamedTuple, Optional

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"


class SourceLink(NamedTuple):
    page: Path
    target: str
    symbol: Optional[str]  # None for a link to a whole file


def line_of(text: str, symbol: str) -> Optional[int]:
    """Returns the line (from 1) that defines a C++ or Python symbol, qualified or not."""
    name = re.escape(re.split(r"::|\.", symbol)[-1])
    owner = re.escape(symbol.replace(".", "::")) if "::" in symbol else None
    patterns = [
        rf"^\S.*\b{owner}\s*\(" if owner else None,  # a member defined outside its class
        rf"^\s*(def|class|struct|enum class|enum|using|concept|namespace)\s+{name}\b(?!.*;$)",
        rf"^\s*using\s+{name}\b",
        rf"^[A-Za-z\[].*\b{name}\s*\(.*[^;]$",  # a function at the left margin
        rf"^\s*[A-Za-z_\[~][^=;(/]*[\s*&]{name}\s*[({{;=]",  # a member or a declaration
        rf"^\s*{name}\b",
    ]
    lines = text.splitlines()
    for pattern in filter(None, patterns):
        for number, line in enumerate(lines, 1):
            if not re.match(r"\s*(return|//|else)\b|\s*//", line) and re.search(pattern, line):
                return number
    return None


def is_source(target: str) -> bool:
    """Returns true if a link's target is a file of the repository outside the pages."""
    return target.startswith("../") and ".md" not in target


def links_of(page: Path) -> Iterator[SourceLink]:
    """Returns the links of a page to source files."""
    for text, target in re.findall(r"\[([^\[\]]+)\]\(([^)\s]+)\)", page.read_text()):
        if is_source(target):
            yield SourceLink(page, target, symbol_in(text))


def symbol_in(text: str) -> Optional[str]:
    """Returns the symbol in a link's text, if the text is code and not a file name."""
    match = re.fullmatch(r"`([A-Za-z_][\w:.]*?)(\(\))?`", text)
    return match[1] if match and not re.search(r"\.(hpp|cpp|py|sh|toml)$|/", match[1]) else None


def problem_with(link: SourceLink) -> Optional[str]:
    """Returns a sentence that describes the fault of a link to source code, or None."""
    file = (link.page.parent / link.target).resolve()
    if not file.exists():
        return f"{link.page.name}: {link.target}: there is no such file"
    if link.symbol and line_of(file.read_text(), link.symbol) is None:
        return f"{link.page.name}: {link.target} does not define {link.symbol}"
    return None

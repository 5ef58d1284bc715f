# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Makes tofsmith/_decoded_planes.py, the planes of a decoded frame, from their description in C++.

    make_decoded_planes.py KEYS_PROGRAM OUTPUT
"""

import json
import subprocess
import sys
import textwrap

HEADER = '''# Made by make_decoded_planes.py of the description of the planes in C++. Do not edit.
"""Planes of a decoded frame."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import Optional

import numpy as np
import numpy.typing as npt


@dataclass(eq=False, repr=False)
class DecodedPlanes:
    """The planes of a decoded frame, (H, W) or (F, H, W) each; None if not requested. Pixels
    without depth (invalid, no_return, too_near, too_far) hold NaN in every plane of floats.

    Attributes
    ----------
'''


STATUSES = {
    "PixelStatus": """\
Outcome of a pixel; if several apply, the first of invalid, saturated, no_return, low_signal,
    inconsistent, too_near, too_far, ambiguous. mixed occurs only if mixed pixels are searched for,
    too_near and too_far only with depth limits.""",
    "ReturnStatus": "Number of returns in a pixel.",
}


def status_text(name, words):
    members = "".join(f"    {word} = {code}\n" for code, word in enumerate(words))
    return f'\n\nclass {name}(IntEnum):\n    """{STATUSES[name]}"""\n\n{members}'


def attribute_text(plane):
    text = plane["help"][0].upper() + plane["help"][1:]
    text += f" [{plane['unit']}]." if plane["unit"] else "."
    lines = textwrap.wrap(text, 88, initial_indent=" " * 8, subsequent_indent=" " * 8,
                          break_on_hyphens=False)
    return "\n".join([f"    {plane['member']} : ndarray of {plane['type']}", *lines, ""])


def members_with(mark, planes):
    return tuple(plane["member"] for plane in planes if plane[mark])


def main():
    program, output = sys.argv[1:]
    printed = subprocess.run([program], check=True, capture_output=True, text=True).stdout
    described = json.loads(printed)
    planes = described["planes"]
    text = HEADER + "".join(map(attribute_text, planes)) + '    """\n\n'
    for plane in planes:
        text += f"    {plane['member']}: Optional[npt.NDArray[np.{plane['type']}]] = None\n"
    text += "".join(status_text(*status) for status in described["statuses"].items())
    types = "".join(f"    {plane['member']!r}: np.{plane['type']},\n" for plane in planes)
    words = "".join(f"    {plane['word']!r}: {plane['member']!r},\n" for plane in planes)
    text += f"""

plane_types: dict[str, type[np.generic]] = {{
{types}}}
#: Words that recordings and `tofsmith decode --outputs` have for planes.
plane_words = {{
{words}}}
#: Other names of planes.
plane_synonyms = {described["plane_synonyms"]!r}
usual_planes = {members_with("is_usual", planes)!r}
multipath_planes = {members_with("is_multipath", planes)!r}
"""
    with open(output, "w", encoding="utf-8") as file:
        file.write(text)


if __name__ == "__main__":
    main()

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Makes tofsmith/_camera_fields.py, the classes of a camera's parts, from the description of its
keys.

    make_camera_fields.py KEYS_PROGRAM OUTPUT
"""

import json
import subprocess
import sys
import textwrap

HEADER = '''# Made by make_camera_fields.py of the description of the keys in C++. Do not edit.
"""Parts of a camera. Attributes are the keys of a camera file; optional ones are None if absent."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional, Union
'''

# Tables whose class is not named after the last word of their key.
CLASS_NAMES = {"raw": "RawMarkers", "operating.multipath": "OperatingMultipath",
               "operating.interference": "OperatingInterference",
               "lens.pinhole": "Lens", "lens.blur": "LensBlur", "light.square": "SquareLight",
               "temperature.sensor": "SensorTemperature"}
TYPES = {"boolean": "bool", "integer": "int", "number": "float", "text": "str", "choice": "str",
         "path": "str", "numbers": "tuple[float, ...]", "integers": "tuple[int, ...]",
         "raw_numbers": "tuple[float, ...]", "number_pair": "tuple[float, float]",
         "number_or_list": "Union[float, tuple[float, ...]]", "number_or_word": "Union[float, str]"}
# Members that are present without a default: an empty list is the same as none.
EMPTY = {"raw_numbers": "()", "integers": "()"}


def class_name(table):
    return CLASS_NAMES.get(table) or table.split(".")[-1].title().replace("_", "")


def literal(value):
    return repr(tuple(value)) if isinstance(value, list) else repr(value)


def attribute(key):
    """(name, annotation, default or None if it is required, documentation) of a key."""
    name = key["key"].split(".")[-1]
    if key["type"] == "table":
        optional = name != "impulse_response"
        kind = class_name(key["key"])
        return (name, f"Optional[{kind}]" if optional else kind,
                "None" if optional else f"{kind}()", key["help"] + ".")
    kind = TYPES[key["type"]]
    facts = [f"{key['help']}" + (f" [{key['unit']}]" if key["unit"] else "")]
    if "words" in key:
        *most, last = key["words"]
        listed = " or ".join(filter(None, [", ".join(most), last]))
        facts.append(listed if key["type"] == "choice" else "")
    facts += [key["range"], f"only with {key['condition']}" if key["condition"] else ""]
    text = "; ".join(filter(None, facts)) + "."
    default = key["default"]
    if default is None and key["type"] in EMPTY:
        return name, kind, EMPTY[key["type"]], text
    if key["example"] and not key["condition"] and key["type"] != "choice":
        return name, kind, None, text
    if default is None or key["type"] == "path":
        return name, f"Optional[{kind}]", "None", text
    return name, kind, literal(default), text


def class_text(name, help_text, keys):
    attributes = [attribute(key) for key in keys]
    if name == "ImpulseResponse":
        help_text = "Impulse response of a light source or a sensor"
    elif name == "Generator":
        help_text = "Waveform generator of a light source or a sensor"
    lines = ["", "", "@dataclass(frozen=True)", f"class {name}:", f'    """{help_text}.', "",
             "    Attributes", "    ----------"]
    for member, annotation, _, text in attributes:
        lines.append(f"    {member} : {annotation}")
        lines += textwrap.wrap(text, 88, initial_indent=" " * 8, subsequent_indent=" " * 8)
    lines += ['    """', ""]
    for member, annotation, default, _ in attributes:
        lines.append(f"    {member}: {annotation}" + ("" if default is None else f" = {default}"))
    return "\n".join(lines) + "\n"


def main():
    program, output = sys.argv[1:]
    printed = subprocess.run([program], check=True, capture_output=True, text=True).stdout
    keys = json.loads(printed)["camera"]
    tables = {key["key"]: key["help"] for key in keys if key["type"] == "table"}
    parts = {}  # by class: help and keys
    for key in keys:
        table = key["key"].rpartition(".")[0]
        if not table:
            continue
        part = f"{table}.{key['part']}" if key["part"] else table
        help_text, members = parts.setdefault(class_name(part), (tables[table], []))
        if not any(key["key"].split(".")[-1] == known["key"].split(".")[-1] for known in members):
            members.append(key)
    # A class must come before the classes that contain it.
    order = sorted(parts, key=lambda name: any(key["type"] == "table" for key in parts[name][1]))
    text = HEADER + "".join(class_text(name, *parts[name]) for name in order)
    with open(output, "w", encoding="utf-8") as file:
        file.write(text)


if __name__ == "__main__":
    main()

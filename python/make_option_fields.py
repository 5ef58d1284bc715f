# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Makes tofsmith/_option_fields.py, the options of functions, from their descriptions in C++.

    make_option_fields.py KEYS_PROGRAM OUTPUT
"""

import json
import subprocess
import sys
import textwrap

HEADER = '''# Made by make_option_fields.py of the descriptions of the options in C++. Do not edit.
"""Options of functions: dicts whose keys may be absent. None selects the default."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Optional, TypedDict, Union

from ._check import Path
from ._option import Option
'''

# Classes of structs that are fields of other structs.
NESTED = {"factorize": "FactorizeOptions", "optimize": "OptimizeOptions",
          "search": "ChipSearchOptions", "decoding": "MultipathOptions", "prior": "ReturnPrior"}
# Fields that are separate arguments of functions, by struct.
ELSEWHERE = {"CaptureOptions": {"signal_e_per_s", "ambient_e_per_s"},
             "RequirementOptions": {"error_m"}, "ExportOptions": {"format"},
             "SceneSource": {"scene"}, "MultipathOptions": {"status_thresholds"},
             "DecodeRequest": {"time_filter", "filter", "raw_format"}}
# Classes for functions with a part of the fields of a struct.
PARTS = {"StreamOptions": ("DecodeRequest", {"layout", "dataset", "all_points", "frame", "stack",
                                             "memory_mb"})}
# Classes for functions with the fields of several structs.
JOINED = {"TableOptions": ("CodeFileOptions", "DecodingTableOptions"),
          "TrainingSetOptions": ("TrainingSetOptions", "CaptureOptions"),
          "UploadOptions": ("UploadSelection", "UploadRequest")}
# Texts that name files.
FILES = {"image", "ambient_image"}
TYPES = {"boolean": "bool", "integer": "int", "number": "float", "text": "str", "choice": "str",
         "path": "Path", "integer[]": "Union[int, Sequence[int]]",
         "number[]": "Union[float, Sequence[float]]", "text[]": "Sequence[str]",
         "integer[2]": "tuple[int, int]", "number[2]": "tuple[float, float]",
         "choice[]": "Sequence[str]"}


def annotation(field):
    if field["name"] in FILES:
        return "Path"
    if field["type"] == "table":
        return f"Union[{NESTED[field['name']]}, Mapping[str, Any]]"
    return TYPES[field["type"]]


def documentation(field):
    """One sentence with the meaning, default, range and condition of a field."""
    text = field["help"][0].upper() + field["help"][1:]
    default = field["if_absent"]
    if not default and field["default"] not in (None, "", []):
        default = str(field["default"])
    text += f" (default: {default})" if default else ""
    conditions = [field["range"], field["only_with"] and f"only with {field['only_with']}"]
    return "; ".join([text, *filter(None, conditions)]) + "."


def short_type(field):
    """The type in documentation: "int", "dict"."""
    if field["type"] == "table":
        return f"dict of {NESTED[field['name']]}"
    if field["type"] == "choice":
        return "{" + ", ".join(f'"{word}"' for word in field["words"]) + "}"
    return {"path": "str or path", "text": "str or path" if field["name"] in FILES
            else "str", "integer[]": "int or sequence of int",
            "number[]": "float or sequence of float", "text[]": "sequence of str",
            "choice[]": "sequence of str"}.get(field["type"], annotation(field))


def class_text(name, fields):
    lines = ["", "", f"class {name}(TypedDict, total=False):",
             '    """Keyword options, or a dict of them.', "", "    Attributes", "    ----------"]
    for field in fields:
        lines.append(f"    {field['name']} : {short_type(field)}")
        lines += textwrap.wrap(documentation(field), 88, initial_indent=" " * 8,
                               subsequent_indent=" " * 8)
    lines += ['    """', ""]
    lines += [f"    {field['name']}: Optional[{annotation(field)}]" for field in fields]
    return "\n".join(lines) + "\n"


def option_text(field):
    default = field["default"] if field["type"] != "table" else None
    return (f"        Option({field['name']!r}, {short_type(field)!r}, {default!r},\n"
            + textwrap.indent("\n".join(
                repr(part + " ") for part in textwrap.wrap(documentation(field), 76)), " " * 15)
            + "),\n")


def structs_in(name, fields):
    """Each struct with its fields, nested structs first."""
    for field in fields:
        if "fields" in field and field["name"] in NESTED:
            yield from structs_in(NESTED[field["name"]], field["fields"])
    yield name, [field for field in fields if field["name"] not in ELSEWHERE.get(name, ())]


def main():
    program, output = sys.argv[1:]
    printed = subprocess.run([program], check=True, capture_output=True, text=True).stdout
    structs = {}
    for name, fields in json.loads(printed)["options"].items():
        structs.update(structs_in(name, fields))
    for name, (struct, without) in PARTS.items():
        structs[name] = [field for field in structs[struct] if field["name"] not in without]
    for name, together in JOINED.items():
        structs[name] = [field for struct in together for field in structs[struct]]
    text = HEADER + "".join(class_text(*struct) for struct in structs.items())
    text += "\n\nOPTIONS: dict[type[Any], tuple[Option, ...]] = {\n"
    for name, fields in structs.items():
        text += f"    {name}: (\n{''.join(map(option_text, fields))}    ),\n"
    with open(output, "w", encoding="utf-8") as file:
        file.write(text + "}\n")


if __name__ == "__main__":
    main()

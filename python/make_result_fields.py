# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Makes tofsmith/_result_fields.py, the classes of results, from their descriptions in C++.

    make_result_fields.py KEYS_PROGRAM OUTPUT
"""

import itertools
import json
import re
import subprocess
import sys
import textwrap
from typing import NamedTuple

HEADER = '''# Made by make_result_fields.py from the descriptions of results in C++. Do not edit.
"""Results. Classes with methods are derived from these in other modules."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Optional

import numpy as np
import numpy.typing as npt

from ._camera_fields import ImpulseResponse
from ._check import FloatArray
from ._results import Estimate
'''

TYPES = {"boolean": "bool", "integer": "int", "number": "float", "text": "str", "choice": "str",
         "estimate": "Estimate", "integer[]": "list[int]", "number[]": "list[float]",
         "text[]": "list[str]", "estimate[]": "list[Estimate]", "image": "npt.NDArray[np.float32]",
         "matrix": "FloatArray", "response": "ImpulseResponse", "path": "FilePath"}
# Types of fields of structs in a list: one array or list per field.
COLUMNS = {"boolean": "npt.NDArray[np.bool_]", "integer": "npt.NDArray[np.int64]",
           "number": "FloatArray", "estimate": "FloatArray", "text": "list[str]"}
# Types in documentation, if different.
WORDS = {"FloatArray": "ndarray", "FilePath": "pathlib.Path",
         "npt.NDArray[np.int64]": "ndarray of int64",
         "npt.NDArray[np.float32]": "ndarray of float32"}


class Attribute(NamedTuple):
    names: list  # two for a number and its standard error
    annotation: str
    text: str

    def kind(self):
        """The type in documentation: "list of str", "float, optional"."""
        words = WORDS.get(self.annotation, self.annotation)
        words = re.sub(r"^Optional\[(.*)\]$", r"\1, optional", words)
        return re.sub(r"^list\[(.*)\]", r"list of \1", words)


# Attributes that are functions or properties of the camera in C++.
ADDED = {
    "DepthErrorReport": [
        Attribute(["kind"], "str",
                  "Error used for ranking, the camera's `operating.error`: linear or circular.")],
    "RobustnessReport": [
        Attribute(["worst_calibrated_m", "worst_uncalibrated_m"], "Estimate",
                  "Largest error of the perturbations and of the camera as described, with a "
                  "decoder that knows the perturbation, and with one that does not [m].")],
}


def documentation(field):
    text = field["help"][:1].upper() + field["help"][1:]
    if field.get("error") and not field["as_object"]:
        text += ", and its standard error" if text else "Value and standard error"
    if field["unit"] and text:
        meaning, mark, remark = text.partition(";")
        text = f"{meaning} [{field['unit']}]{mark}{remark}"
    return text and text + "."


def columns_of(fields, known):
    """One attribute per field of the structs in a list."""
    for field in fields:
        if "fields" in field:
            yield from columns_of(field["fields"], known)
            continue
        names = [name for name in (field["name"], field.get("error")) if name]
        if field["type"] == "text":
            names = [name + "s" for name in names]
        names = ["point_" + name if name in known else name for name in names]
        text = documentation({**field, "as_object": False})
        yield Attribute(names, COLUMNS[field["type"]], text)


def attributes_of(fields, class_of):
    """Attributes of a result, as fields_dict() in field_dicts.hpp converts its fields."""
    known = {field["name"] for field in fields}
    for field in fields:
        names = [field["name"]]
        if field["type"] == "table[]" and not field["as_object"]:
            yield from columns_of(field["fields"], known)
            continue
        kind = class_of(field["fields"]) if "fields" in field else TYPES[field["type"]]
        if field["type"] == "table[]":
            kind = f"list[{kind}]"
        elif field["type"] == "estimate" and not field["as_object"]:
            names, kind = [name for name in (field["name"], field["error"]) if name], "float"
        if field["optional"]:
            kind = f"Optional[{kind}]"
        yield Attribute(names, kind, documentation(field))


def class_text(name, help_text, attributes):
    lines = ["", "", "@dataclass(frozen=True)", f"class {name}:"]
    lines += textwrap.wrap(f'"""{help_text}.', 96, initial_indent=" " * 4,
                           subsequent_indent=" " * 4)
    lines += ["", "    Attributes", "    ----------"]
    for (kind, text), group in itertools.groupby(attributes, lambda each: (each.kind(), each.text)):
        lines.append(f"    {', '.join(name for each in group for name in each.names)} : {kind}")
        lines += textwrap.wrap(text, 88, initial_indent=" " * 8, subsequent_indent=" " * 8)
    lines += ['    """', ""]
    lines += [f"    {name}: {each.annotation}" for each in attributes for name in each.names]
    return "\n".join(lines) + "\n"


def main():
    program, output = sys.argv[1:]
    printed = subprocess.run([program], check=True, capture_output=True, text=True).stdout
    results = json.loads(printed)["results"]

    def class_of(fields):
        return next(result["name"] for result in results if result["fields"] == fields)

    text = HEADER
    for result in results:
        attributes = [*attributes_of(result["fields"], class_of), *ADDED.get(result["name"], ())]
        text += class_text(result["name"], result["help"], attributes)
    with open(output, "w", encoding="utf-8") as file:
        file.write(text)


if __name__ == "__main__":
    main()

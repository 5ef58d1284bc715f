#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Packs a page into one file that needs no other: styles, modules, workers, WebAssembly.

    pack.py --page index.html [--worker glue.js ...] [--wasm engine.wasm] [--licence FILE ...] \
            [--cpp] -o packed.html

Modules become functions in the order of their imports, so that one classic script contains all of
them. Two forms are supported: `import {a, b as c} from './x.js';` and `export` before a
declaration. File names of modules must be unique.
"""

import argparse
import base64
import gzip
import os
import re
import sys
from pathlib import Path

IMPORT = re.compile(r"^import \{([^}]*)\} from '(\.[\w./]+)';\n", re.M)
EXPORT = re.compile(r"^export ((?:async )?function\*?|class|const|let) (\w+)", re.M)


def module_order(path, done, pending):
    """Adds the modules that a module needs to `done`, the module itself last."""
    if path in done:
        return
    if path in pending:
        names = [one.name for one in [*pending, path]]
        raise SystemExit(f"pack.py: import cycle: {' -> '.join(names)}")
    text = path.read_text()
    for _, needed in IMPORT.findall(text):
        module_order((path.parent / needed).resolve(), done, [*pending, path])
    done[path] = text


def as_function(name, text):
    """A module as a function that returns its exports."""
    def variable(file):
        return "module_" + re.sub(r"\W", "_", Path(file).stem)

    def taken(match):
        names = re.sub(r"(\w+) as (\w+)", r"\1: \2", " ".join(match[1].split()))
        return f"const {{{names}}} = {variable(match[2])};\n"

    exported = [found[1] for found in EXPORT.findall(text)]
    body = EXPORT.sub(r"\1 \2", IMPORT.sub(taken, text))
    left = re.search(r"^(?:import|export)\b.*", body, re.M)
    if left:
        raise SystemExit(f"pack.py: {name}: cannot pack '{left[0]}'")
    return f"const {variable(name)} = (() => {{\n{body}\nreturn {{{', '.join(exported)}}};\n}})();\n"


def embedded(text):
    """Text that may be part of a script element: nothing in it ends the element."""
    return re.sub(r"<(?=/script|!--|script)", r"\\x3c", text, flags=re.I)


def engine_parts(workers, wasm, licences):
    """Script elements with the workers, the WebAssembly module and the licences."""
    worker = embedded("\n".join(path.read_text() for path in workers))
    held = embedded("\n\n".join(f"== {path.parent.name}\n\n{path.read_text()}" for path in licences))
    engine = base64.b64encode(gzip.compress(wasm.read_bytes(), 9, mtime=0)).decode() if wasm else ""
    return (f'<script type="text/plain" id="lab-worker">{worker}</script>\n'
            f'<script type="text/plain" id="lab-wasm">{engine}</script>\n'
            f'<script type="text/plain" id="lab-licences">{held}</script>\n')


def packed_page(page, parts=""):
    """The page as one text; `parts` precede its script."""
    def script(match):
        modules = {}
        module_order((page.parent / match[1]).resolve(), modules, [])
        code = "".join(as_function(path.name, text) for path, text in modules.items())
        return f"{parts}<script>\n'use strict';\n{embedded(code)}</script>"

    text = re.sub(r'<link rel="stylesheet" href="([\w./]+)">',
                  lambda m: f"<style>\n{(page.parent / m[1]).read_text()}</style>", page.read_text())
    text, count = re.subn(r'<script type="module" src="([\w./]+)"></script>', script, text)
    if count != 1:
        raise SystemExit(f'pack.py: {page}: {count} elements <script type="module" src=...>; expected 1')
    return text


def as_cpp(text):
    """A C++ source file whose function viewer_page() returns the text."""
    pieces = [text[i:i + 8000] for i in range(0, len(text), 8000)]
    literal = "\n".join(f'R"__page__({piece})__page__"' for piece in pieces)
    return ('#include "report/viewer.hpp"\n\nnamespace tofsmith {\n\n'
            "std::string_view viewer_page() {\n  static constexpr char page[] =\n"
            f"{literal};\n  return {{page, sizeof page - 1}};\n}}\n\n}}  // namespace tofsmith\n")


def main():
    """Writes the packed page to a temporary file and renames it."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--page", type=Path, required=True, help="HTML file of the page")
    parser.add_argument("--worker", type=Path, action="append", default=[],
                        help="classic script of the worker; several are joined in this order")
    parser.add_argument("--wasm", type=Path, help="the engine")
    parser.add_argument("--licence", type=Path, action="append", default=[],
                        help="terms of a part of the engine, in a folder of its name")
    parser.add_argument("--cpp", action="store_true", help="write C++ source instead of HTML")
    parser.add_argument("-o", "--output", type=Path, required=True)
    arguments = parser.parse_args()
    parts = ""
    if arguments.worker:
        parts = engine_parts(arguments.worker, arguments.wasm, arguments.licence)
    page = packed_page(arguments.page, parts)
    partial = arguments.output.with_name(arguments.output.name + ".partial")
    partial.write_text(as_cpp(page) if arguments.cpp else page)
    os.replace(partial, arguments.output)
    return 0


if __name__ == "__main__":
    sys.exit(main())

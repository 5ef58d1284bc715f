#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Packs the lab into one page that needs nothing else: styles, modules, workers, WebAssembly.

    pack.py --worker glue.js [--worker more.js ..] [--wasm engine.wasm] [--licence FILE ..]
            -o lab.html

Modules become functions in the order of their imports, so that one classic script holds them all. For
that they keep to two forms: `import {a, b as c} from './x.js';` and `export` before a declaration.
"""

import argparse
import base64
import gzip
import os
import re
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
IMPORT = re.compile(r"^import \{([^}]*)\} from '\./([\w.]+)';\n", re.M)
EXPORT = re.compile(r"^export ((?:async )?function\*?|class|const|let) (\w+)", re.M)


def module_order(folder, name, done, under_way):
    """The modules that a module needs, itself last."""
    if name in done:
        return
    if name in under_way:
        raise SystemExit(f"pack.py: imports run in a circle: {' -> '.join([*under_way, name])}")
    text = (folder / name).read_text()
    for _, needed in IMPORT.findall(text):
        module_order(folder, needed, done, [*under_way, name])
    done[name] = text


def as_function(name, text):
    """A module as a function of its own that returns what it exports."""
    def variable(file):
        return "module_" + re.sub(r"\W", "_", file.removesuffix(".js"))

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
    """Text that may stand in a script element: nothing in it ends the element."""
    return re.sub(r"<(?=/script|!--|script)", r"\\x3c", text, flags=re.I)


def packed_page(folder, workers, wasm, licences):
    """The page as one text."""
    page = (folder / "index.html").read_text()
    page = re.sub(r'<link rel="stylesheet" href="([\w.]+)">',
                  lambda m: f"<style>\n{(folder / m[1]).read_text()}</style>", page)

    def script(match):
        modules = {}
        module_order(folder, match[1], modules, [])
        code = "".join(as_function(name, text) for name, text in modules.items())
        return f"<script>\n'use strict';\n{embedded(code)}</script>"

    worker = embedded("\n".join(path.read_text() for path in workers))
    held = embedded("\n\n".join(f"== {path.parent.name}\n\n{path.read_text()}" for path in licences))
    engine = base64.b64encode(gzip.compress(wasm.read_bytes(), 9, mtime=0)).decode() if wasm else ""
    parts = (f'<script type="text/plain" id="lab-worker">{worker}</script>\n'
             f'<script type="text/plain" id="lab-wasm">{engine}</script>\n'
             f'<script type="text/plain" id="lab-licences">{held}</script>\n')
    page, count = re.subn(r'<script type="module" src="([\w.]+)"></script>',
                          lambda m: parts + script(m), page)
    if count != 1:
        raise SystemExit("pack.py: index.html needs exactly one <script type=\"module\" src=..>")
    return page


def main():
    """Writes the page beside its place and moves it there."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--page", type=Path, default=HERE, help="folder of index.html")
    parser.add_argument("--worker", type=Path, action="append", required=True,
                        help="classic script of the worker; several are joined in this order")
    parser.add_argument("--wasm", type=Path, help="the engine")
    parser.add_argument("--licence", type=Path, action="append", default=[],
                        help="terms of what the engine holds, in a folder of its name")
    parser.add_argument("-o", "--output", type=Path, required=True)
    arguments = parser.parse_args()
    page = packed_page(arguments.page, arguments.worker, arguments.wasm, arguments.licence)
    partial = arguments.output.with_name(arguments.output.name + ".partial")
    partial.write_text(page)
    os.replace(partial, arguments.output)
    return 0


if __name__ == "__main__":
    sys.exit(main())

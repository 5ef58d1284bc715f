#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""pack.py packs all parts into the page and rejects unsupported imports.

    pack_test.py PACK
"""

import base64
import gzip
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PACK = Path(sys.argv.pop(1)).resolve()
INDEX = '<link rel="stylesheet" href="a.css"><script type="module" src="main.js"></script>'


class Pack(unittest.TestCase):
    def packed(self, **files):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            given = {"index.html": INDEX, "a.css": "p {}", "worker.js": "work();", "engine.wasm": "wasm"}
            given.update({key.replace("_", "."): text for key, text in files.items()})
            for file, text in given.items():
                (folder / file).write_text(text)
            (folder / "library").mkdir()
            (folder / "library" / "copyright").write_text("Free to all.")
            done = subprocess.run(
                [sys.executable, PACK, "--page", folder / "index.html", "--worker", folder / "worker.js", "--wasm",
                 folder / "engine.wasm", "--licence",
                 folder / "library" / "copyright", "-o", folder / "lab.html"], capture_output=True,
                text=True)
            page = folder / "lab.html"
            return done.returncode, done.stderr, page.read_text() if page.exists() else None

    def test_everything_is_in_one_page(self):
        status, _, page = self.packed(
            main_js="import {a as b,\n  C} from './x.js';\n\nb(new C(), '</script>');\n",
            x_js="import {y} from './y.js';\nexport const a = y;\nexport class C {}\n",
            y_js="export async function y() {}\n", worker_js="say('</script>');")
        self.assertEqual(status, 0)
        self.assertEqual(page.count("</script>"), 4)
        self.assertIn('id="lab-licences">== library\n\nFree to all.<', page)
        self.assertNotRegex(page, r"(?m)^(import|export)\b|src=|href=")
        self.assertLess(page.index("module_y ="), page.index("module_x ="))
        self.assertIn("const {a: b, C} = module_x;", page)
        wasm = re.search(r'id="lab-wasm">([^<]*)<', page)[1]
        self.assertEqual(gzip.decompress(base64.b64decode(wasm)), b"wasm")

    def test_a_page_as_cpp_returns_its_text(self):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            for file, text in {"index.html": INDEX, "a.css": "p {}", "main.js": "begin();\n"}.items():
                (folder / file).write_text(text)
            subprocess.run([sys.executable, PACK, "--page", folder / "index.html", "--cpp", "-o",
                            folder / "page.cpp"], check=True)
            source = (folder / "page.cpp").read_text()
        pieces = re.findall(r'R"__page__\((.*?)\)__page__"', source, re.S)
        self.assertIn("begin();", "".join(pieces))
        self.assertNotIn("lab-worker", source)

    def test_the_same_input_gives_the_same_bytes(self):
        self.assertEqual(self.packed(main_js="begin();\n"), self.packed(main_js="begin();\n"))

    def test_cycles_and_other_forms_are_rejected(self):
        for main, other, word in (
            ("import {a} from './x.js';\n", "import {m} from './main.js';\nexport const a = 1;\n", "cycle"),
            ("import * as x from './x.js';\n", "export const a = 1;\n", "cannot pack"),
            ("import {a} from './x.js';\n", "export default 1;\n", "cannot pack"),
        ):
            status, message, page = self.packed(main_js=main, x_js=other)
            self.assertNotEqual(status, 0)
            self.assertIn(word, message)
            self.assertIsNone(page)


if __name__ == "__main__":
    unittest.main()

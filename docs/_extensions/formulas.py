# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Draws formulas with KaTeX, which is copied to the pages: they need no network."""

from pathlib import Path
from shutil import copy

from docutils import nodes

KATEX = Path("/usr/share/javascript/katex")  # Debian's libjs-katex


def write_inline(self, node):
    self.body.append(f'<span class="formula">{self.encode(node.astext())}</span>')
    raise nodes.SkipNode


def write_block(self, node):
    self.body.append(self.starttag(node, "div", CLASS="formula display"))
    self.body.append(f"{self.encode(node.astext())}</div>\n")
    raise nodes.SkipNode


def load_on_pages_with_formulas(app, page, template, context, document):
    if document is None or not any(document.findall(is_formula)):
        return
    app.add_css_file("katex/katex.min.css")
    app.add_js_file("katex/katex.min.js", defer="defer")
    app.add_js_file("formulas.js", defer="defer")


def is_formula(node):
    return isinstance(node, (nodes.math, nodes.math_block))


def copy_katex(app, error):
    if error or app.builder.format != "html":
        return
    target = Path(app.outdir) / "_static" / "katex"
    (target / "fonts").mkdir(parents=True, exist_ok=True)
    for file in ("katex.min.js", "katex.min.css"):
        copy(KATEX / file, target)
    for font in (KATEX / "fonts").glob("*.woff2"):
        copy(font, target / "fonts")


def setup(app):
    app.add_html_math_renderer("katex", (write_inline, None), (write_block, None))
    app.connect("html-page-context", load_on_pages_with_formulas)
    app.connect("build-finished", copy_katex)
    return {"version": "1", "parallel_read_safe": True}

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Adds the source files that pages link to, and resolves each link to a line."""

from __future__ import annotations

from pathlib import Path

from docutils import nodes
from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers import TextLexer, get_lexer_for_filename
from pygments.util import ClassNotFound
from sphinx import addnodes
from sphinx.util import logging

import source_symbols

logger = logging.getLogger(__name__)


def page_of(file: Path) -> str:
    return f"sources/{file.relative_to(source_symbols.ROOT)}"


def lead_links_to_lines(app, document):
    """Shows linked source files; MyST would offer them for download."""
    for node in list(document.findall(addnodes.download_reference)):
        target = node["reftarget"]
        if not source_symbols.is_source(target):
            continue
        page = Path(app.env.doc2path(app.env.docname))
        code = any(node.findall(nodes.literal))
        symbol = source_symbols.symbol_in(f"`{node.astext()}`") if code else None
        link = source_symbols.SourceLink(page, target, symbol)
        problem = source_symbols.problem_with(link)
        if problem:
            logger.warning(problem, location=node)
            continue
        file = (page.parent / target).resolve()
        app.env.tofsmith_sources.add(file)
        uri = app.builder.get_relative_uri(app.env.docname, page_of(file))
        if link.symbol:
            uri += f"#line-{source_symbols.line_of(file.read_text(), link.symbol)}"
        reference = nodes.reference("", "", *node.children, refuri=uri, internal=True)
        node.replace_self(reference)


def pages_of_sources(app):
    formatter = HtmlFormatter(linenos="inline", linespans="line")
    for file in sorted(app.env.tofsmith_sources):
        name = file.relative_to(source_symbols.ROOT)
        try:
            lexer = get_lexer_for_filename(file.name)
        except ClassNotFound:
            lexer = TextLexer()
        body = highlight(file.read_text(), lexer, formatter)
        yield page_of(file), {"title": str(name), "body": f"<h1>{name}</h1>{body}"}, "page.html"


def setup(app):
    app.connect("env-before-read-docs",
                lambda app, env, docnames: setattr(env, "tofsmith_sources", set()))
    app.connect("doctree-read", lead_links_to_lines, priority=400)
    app.connect("html-collect-pages", pages_of_sources)
    return {"version": "1", "parallel_read_safe": False}

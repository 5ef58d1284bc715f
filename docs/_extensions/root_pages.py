# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Makes pages from the Markdown files in the root of the repository and adapts links to them."""

import re
from pathlib import Path

import source_symbols

PAGES = {"README.md": "readme.md", "CHANGELOG.md": "changelog.md", "CONTRIBUTING.md": "contributing.md"}


def moved(target: str) -> str:
    """Returns a link's target relative to generated/ instead of the root."""
    path, mark, place = target.partition("#")
    if "://" in target or not path:
        return target
    path = PAGES.get(path) or (path.replace("docs/", "../", 1) if path.startswith("docs/")
                               else f"../../{path}")
    return path + mark + place


def write_pages(app):
    folder = Path(app.srcdir) / "generated"
    folder.mkdir(exist_ok=True)
    for file, page in PAGES.items():
        text = (source_symbols.ROOT / file).read_text()
        text = re.sub(r"\]\(([^)\s]+)\)", lambda match: f"]({moved(match[1])})", text)
        (folder / page).write_text(text.replace("# tofsmith\n", "# README\n", 1))


def lead_links_to_pages(app, docname, source):
    if not docname.startswith("generated/"):
        for file, page in PAGES.items():
            source[0] = source[0].replace(f"](../{file}", f"](generated/{page}")


def setup(app):
    app.connect("builder-inited", write_pages)
    app.connect("source-read", lead_links_to_pages)
    return {"version": "1", "parallel_read_safe": True}

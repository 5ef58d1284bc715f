# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Copies the lab built by scripts/lab.sh to the site and links to it from its page."""

import shutil
from pathlib import Path

from docutils import nodes

PLACE = "_static/lab_page.html"


def add_link(app, doctree, docname):
    if docname != "lab" or not app.config.tofsmith_lab:
        return
    link = nodes.reference("", "Open the lab in this browser.", refuri=PLACE, internal=False)
    next(iter(doctree.findall(nodes.section))).insert(1, nodes.paragraph("", "", link))


def copy_page(app, exception):
    if exception is None and app.config.tofsmith_lab:
        shutil.copyfile(app.config.tofsmith_lab, Path(app.outdir) / PLACE)


def setup(app):
    app.add_config_value("tofsmith_lab", "", "env")
    app.connect("doctree-resolved", add_link)
    app.connect("build-finished", copy_page)
    return {"version": "1", "parallel_read_safe": True}

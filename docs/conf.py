# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Configures Sphinx for scripts/docs.sh; `tofsmith` must be importable."""

import sys
from pathlib import Path

import tofsmith

sys.path.insert(0, str(Path(__file__).parent / "_extensions"))

project = "tofsmith"
author = "The tofsmith authors"
copyright = "2026, The tofsmith authors"
version = release = tofsmith.__version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "numpydoc",
    "command_pages",
    "root_pages",
    "formulas",
    "source_links",
    "lab_page",
]
exclude_patterns = ["_extensions", "Doxyfile"]
highlight_language = "none"  # indented blocks are commands and formulas alike
nitpicky = True
smartquotes = False  # they turn --option into a dash
toc_object_entries = False

myst_enable_extensions = ["dollarmath", "deflist"]
myst_heading_anchors = 3

autosummary_generate = True
autodoc_typehints = "none"  # docstrings state types, shapes and units
autodoc_member_order = "bysource"
numpydoc_show_class_members = False

html_theme = "sphinx_rtd_theme"
html_theme_options = {"navigation_depth": 3, "style_external_links": True}
html_title = f"tofsmith {version}"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_show_sourcelink = False
html_copy_source = False
html_show_search_summary = False  # it fetches pages, which browsers block for local files
templates_path = ["_templates"]

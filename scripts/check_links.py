# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Checks the links of HTML pages: python3 check_links.py DIRECTORY

Linked files and anchors must exist; external addresses must be well-formed https. Nothing is
downloaded.
"""

import os
import sys
from functools import lru_cache
from html.parser import HTMLParser
from urllib.parse import unquote, urlsplit

# Doxygen 1.9.4 links to this heading but omits it if all nested classes are private.
LEFT_OUT = "#nested-classes"


class Page(HTMLParser):
    """Anchors and links of a page."""

    def __init__(self, path):
        super().__init__()
        self.places, self.links = {"", "top"}, []
        with open(path, encoding="utf-8", errors="replace") as file:
            self.feed(file.read())

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name == "id" or (name == "name" and tag == "a"):
                self.places.add(value)
            elif name in ("href", "src") and value:
                self.links.append((value, self.getpos()[0]))

    handle_startendtag = handle_starttag


@lru_cache(maxsize=None)
def page_at(path):
    return Page(path)


def problem_with(link, path):
    """Problem with a link from the page at a path, or None."""
    parts = urlsplit(link)
    if link == LEFT_OUT or parts.scheme in ("data", "mailto", "javascript"):
        return None
    if parts.scheme or parts.netloc:
        if parts.scheme == "https" and "." in parts.netloc and " " not in link:
            return None
        return "is no https address"
    target = os.path.normpath(os.path.join(os.path.dirname(path), unquote(parts.path)))
    if not parts.path:
        target = path
    if os.path.isdir(target):
        target = os.path.join(target, "index.html")
    if not os.path.isfile(target):
        return "leads to no file"
    place = unquote(parts.fragment)
    if target.endswith(".html") and place not in page_at(target).places:
        return "leads to no place on that page"
    return None


def main(folder):
    paths = [os.path.join(at, name) for at, _, names in os.walk(folder) for name in names
             if name.endswith(".html")]
    problems = [f"{path}:{line}: {link}: {problem}"
                for path in sorted(paths) for link, line in page_at(path).links
                if (problem := problem_with(link, path))]
    count = sum(len(page_at(path).links) for path in paths)
    print("\n".join([*problems, f"{len(paths)} pages, {count} links, {len(problems)} broken"]))
    return 1 if problems or not paths else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: check_links.py DIRECTORY")
    sys.exit(main(sys.argv[1]))

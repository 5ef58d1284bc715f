# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Checks that files, symbols, commands and Python names mentioned on pages exist. Does not require
Sphinx.

    pages_test.py TOFSMITH DOCS
"""

import os
import re
import subprocess
import sys
import unittest
from pathlib import Path

TOOL = os.path.abspath(sys.argv.pop(1))
DOCS = Path(sys.argv.pop(1)).resolve()
sys.path.insert(0, str(DOCS / "_extensions"))

import command_help  # noqa: E402
import source_symbols  # noqa: E402

PAGES = sorted(DOCS.glob("*.md"))


class Pages(unittest.TestCase):
    def test_links_into_the_code_lead_to_the_named_symbol(self):
        links = [link for page in PAGES for link in source_symbols.links_of(page)]
        self.assertGreater(len(links), 50)
        self.assertEqual([p for p in map(source_symbols.problem_with, links) if p], [])

    def test_a_missing_name_is_detected(self):
        link = source_symbols.SourceLink(DOCS / "model.md", "../src/core/units.cpp", "no_such_name")
        self.assertIn("does not define no_such_name", source_symbols.problem_with(link))
        self.assertIn("no such file", source_symbols.problem_with(link._replace(target="../x.cpp")))

    def test_links_between_files_are_valid(self):
        root = [DOCS.parent / name for name in ("README.md", "CONTRIBUTING.md")]
        for page in [*PAGES, *root]:
            for target in re.findall(r"\]\(([^)\s#]+)[^)]*\)", page.read_text()):
                if "://" not in target:
                    self.assertTrue((page.parent / target).exists(), f"{page.name}: {target}")

    def test_every_page_is_reachable_from_the_first(self):
        listed = set(re.findall(r"^([a-z_]+)$", (DOCS / "index.md").read_text(), re.M))
        self.assertEqual({page.stem for page in PAGES} - {"index"} - listed, set())

    def test_help_of_every_command_is_parsed(self):
        commands = {tuple(c.words): c for c in command_help.all_commands(TOOL)}
        self.assertIn(("sweep", "merge"), commands)
        self.assertIn(("decode",), commands)
        for words, command in commands.items():
            text = subprocess.run([TOOL, *words, "--help-all"], capture_output=True, text=True).stdout
            shown = set(re.findall(r"^  (?:-\w,)?(--[\w-]+)", text, re.M))
            found = {name for entries in command.sections.values() for entry in entries
                     for name in entry.names if name.startswith("--")}
            self.assertEqual(shown, found, command.name)
        output = {e.names[-1]: e for e in commands[("decode",)].sections["Options"]}["--output"]
        self.assertEqual((output.names, output.required), (["-o", "--output"], True))

    def test_options_used_on_pages_exist(self):
        known = {name for command in command_help.all_commands(TOOL)
                 for entries in command.sections.values() for entry in entries
                 for name in entry.names}
        for page in PAGES:
            for line in re.findall(r"^\s*tofsmith (?:[^\n]*\\\n)*[^\n]*", page.read_text(), re.M):
                for option in re.findall(r"(?<=\s)--[a-z][\w-]*", line.split(" #")[0]):
                    self.assertIn(option, known, f"{page.name}: {line}")

    def test_the_python_reference_is_complete(self):
        package = (DOCS.parent / "python" / "tofsmith" / "__init__.py").read_text()
        names = set(re.findall(r'^    "(\w+)",$', package, re.M))
        listed = set(re.findall(r"^   (\w+)$", (DOCS / "python_reference.md").read_text(), re.M))
        self.assertEqual(names - listed, set())
        self.assertEqual(listed - names, {"figures", "instruments", "paper", "plot"})


if __name__ == "__main__":
    unittest.main()

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Theory pages begin with commands that run and print the output shown below them. Numbers may
differ by 25 % plus 0.3, since processors round differently.

    theory_test.py TOFSMITH DOCS
"""

import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TOOL = os.path.abspath(sys.argv.pop(1))
DOCS = Path(sys.argv.pop(1)).resolve()
PAGES = ("bounds", "calibration", "decoding", "exhaustive_search", "filtering", "measured_tables", "model", "montecarlo",
         "multipath", "optimize", "paper", "robustness")
NUMBER = re.compile(r"[+-]?\d+(?:\.\d+)?(?:e[+-]?\d+)?")


def blocks_of(page):
    """Returns pairs of commands and their shown output, in order."""
    text = (DOCS / f"{page}.md").read_text(encoding="utf-8")
    return re.findall(r"^```bash\n(.*?)^```\n+```text\n(.*?)^```$", text, re.M | re.S)


def same(shown, printed):
    """Returns whether a line is printed as shown: the same words, and similar numbers."""
    if shown.endswith(".."):
        shown = shown[:-2].rstrip()
        printed = printed[:len(shown)]
    if NUMBER.sub("#", shown).split() != NUMBER.sub("#", printed).split():
        return False
    pairs = zip(map(float, NUMBER.findall(shown)), map(float, NUMBER.findall(printed)))
    return all(abs(a - b) <= 0.25 * abs(a) + 0.3 for a, b in pairs)


def first_not_printed(shown, printed):
    """Returns the first shown line that is not printed, or None. `..` alone matches any lines."""
    lines, at, any_line = printed.splitlines(), 0, False
    for line in shown.splitlines():
        if line == "..":
            any_line = True
            continue
        while at < len(lines) and any_line and not same(line, lines[at]):
            at += 1
        if at == len(lines) or not same(line, lines[at]):
            return line
        at, any_line = at + 1, False
    return None


class Theory(unittest.TestCase):
    def test_pages_begin_with_commands(self):
        for page in PAGES:
            head = (DOCS / f"{page}.md").read_text(encoding="utf-8").split("\n## ")[0]
            self.assertIn("```bash\n", head, page)

    def test_commands_print_the_shown_output(self):
        environment = dict(os.environ, PATH=f"{os.path.dirname(TOOL)}:/usr/bin:/bin")
        for page in PAGES:
            with tempfile.TemporaryDirectory(prefix="tofsmith-theory-") as directory:
                for commands, shown in blocks_of(page):
                    done = subprocess.run(["bash", "-e"], input=commands, cwd=directory, env=environment,
                                          text=True, capture_output=True, timeout=100)
                    self.assertEqual(done.returncode, 0, f"{page}: {commands}\n{done.stderr}")
                    self.assertIsNone(first_not_printed(shown, done.stdout),
                                      f"{page}: {commands} prints\n{done.stdout}")

    def test_other_output_is_detected(self):
        self.assertIsNone(first_not_printed("a 1.0\n..\nd 4 ..\n", "a  1.1\nb\nc\nd 4 and more\n"))
        self.assertEqual(first_not_printed("a 1.0\n", "a 2.0\n"), "a 1.0")
        self.assertEqual(first_not_printed("a\nc\n", "a\nb\nc\n"), "c")


if __name__ == "__main__":
    unittest.main()

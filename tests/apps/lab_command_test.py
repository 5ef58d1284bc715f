# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""`tofsmith lab` copies the installed page, or reports that it is missing."""

import os
import shutil
import subprocess
import unittest

from command_line import TOOL, CommandLineTest

PAGE = b"<!doctype html>\n<title>The lab</title>\n"


class Lab(CommandLineTest):
    def installed(self, *arguments):
        done = subprocess.run([self.path("usr/bin/tofsmith"), *arguments], cwd=self.directory,
                              capture_output=True, text=True, timeout=60)
        return done.returncode, done.stdout, done.stderr

    def setUp(self):
        super().setUp()
        os.makedirs(self.path("usr/bin"))
        os.makedirs(self.path("usr/share/tofsmith"))
        shutil.copy(TOOL, self.path("usr/bin/tofsmith"))

    def test_copies_the_installed_page_and_replaces_nothing(self):
        self.write("usr/share/tofsmith/lab.html", PAGE)
        self.assertEqual(self.installed("lab", "-o", "page.html")[0::2], (0, ""))
        self.assertEqual(self.bytes_of("page.html"), PAGE)
        self.write("page.html", "mine")
        code, out, error = self.installed("lab", "-o", "page.html")
        self.assertEqual((code, out), (1, ""))
        self.assertIn("--force", error)
        self.assertEqual(self.bytes_of("page.html"), b"mine")
        self.assertEqual(self.installed("lab", "-o", "page.html", "--force")[0], 0)
        self.assertEqual(self.bytes_of("page.html"), PAGE)

    def test_explains_how_to_build_a_missing_page(self):
        code, out, error = self.installed("lab", "-o", "page.html")
        self.assertEqual((code, out), (1, ""))
        self.assertIn("scripts/lab.sh", error)
        self.assertFalse(os.path.exists(self.path("page.html")))

    def test_an_empty_page_is_treated_as_missing(self):
        self.write("usr/share/tofsmith/lab.html", b"")
        self.assertEqual(self.installed("lab")[0], 1)
        self.assertFalse(os.path.exists(self.path("lab.html")))


if __name__ == "__main__":
    unittest.main()

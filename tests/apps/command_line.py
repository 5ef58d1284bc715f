# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""What the tests of the command line share: run the tool as a user does, in an empty directory."""

import json
import os
import subprocess
import sys
import tempfile
import unittest

TOOL = os.path.abspath(sys.argv.pop(1))


class CommandLineTest(unittest.TestCase):
    """Every test has a directory of its own; relative names are in it."""

    def setUp(self):
        directory = tempfile.TemporaryDirectory(prefix="tofsmith-test-")
        self.addCleanup(directory.cleanup)
        self.directory = directory.name

    def path(self, name):
        return os.path.join(self.directory, name)

    def files(self):
        """Every file and directory, hidden ones too."""
        return sorted(
            os.path.relpath(os.path.join(folder, name), self.directory)
            for folder, folders, files in os.walk(self.directory)
            for name in folders + files)

    def write(self, name, text):
        with open(self.path(name), "wb") as file:
            file.write(text if isinstance(text, bytes) else text.encode())
        return name

    def bytes_of(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def start(self, *arguments, **options):
        """Without progress, which a slow machine would tell."""
        return subprocess.Popen([TOOL, "--quiet", *arguments], cwd=self.directory,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)

    def run_tool(self, *arguments, **options):
        """Exit code, standard output, standard error."""
        process = self.start(*arguments, **options)
        out, error = process.communicate(timeout=60)
        return process.returncode, out, error.decode(errors="replace")

    def do(self, *arguments, **options):
        """Runs what must succeed and be silent on standard error; gives standard output."""
        code, out, error = self.run_tool(*arguments, **options)
        self.assertEqual((code, error), (0, ""), arguments)
        return out.decode()

    def do_json(self, *arguments):
        """The same with --json: exactly one JSON document."""
        return json.loads(self.do(*arguments, "--json"))

    def refuse(self, arguments, *words, code=1):
        """Runs what must fail: nothing on standard output, every word in the message, no file
        appears, none changes."""
        def content():
            return [(f, self.bytes_of(f) if os.path.isfile(self.path(f)) else None)
                    for f in self.files()]
        before = content()
        exit_code, out, error = self.run_tool(*arguments)
        with self.subTest(arguments=arguments, message=error):
            self.assertEqual(exit_code, code)
            self.assertEqual(out, b"")
            self.assertTrue(error.startswith("tofsmith: "))
            for word in words:
                self.assertIn(word, error)
            self.assertTrue(before == content(), "files changed")
        return error

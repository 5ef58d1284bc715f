# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Every command that writes files writes the same bytes in a locale with a decimal comma.

    locale_test.py TOFSMITH LOCALE_SHIM LOCALES
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

from command_line import TOOL
from writing_commands import COMMANDS, make_inputs

SHIM, LOCALES = (os.path.abspath(sys.argv.pop(1)) for _ in range(2))
GERMAN = {"LD_PRELOAD": SHIM, "LOCPATH": LOCALES, "TOFSMITH_TEST_LOCALE": "de_DE.UTF-8"}
QUICK = [command for command in COMMANDS if not command.is_slow]


def without_times(text):
    """Replaces measured times and rates; a number with a decimal comma stays."""
    return re.sub(r"\b\d+(\.\d+)?(?= (ms|us|s|frames/s|Mpixel/s|items/s)\b)", "N", text)


def contents(path):
    """Returns the content of a file, or of every file of a directory by its path within."""
    if not os.path.isdir(path):
        with open(path, "rb") as file:
            return file.read()
    return {os.path.relpath(os.path.join(folder, name), path): contents(os.path.join(folder, name))
            for folder, _, names in os.walk(path) for name in names}


class Locale(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.work = tempfile.mkdtemp(prefix="tofsmith-test-")
        cls.addClassCleanup(shutil.rmtree, cls.work)
        cls.inputs = os.path.join(cls.work, "inputs")
        os.mkdir(cls.inputs)
        make_inputs(TOOL, cls.inputs)

    def outputs_of(self, command, environment):
        directory = os.path.join(self.work, "run")
        shutil.copytree(self.inputs, directory)
        self.addCleanup(shutil.rmtree, directory, ignore_errors=True)
        done = subprocess.run([TOOL, "--quiet", *command.arguments, "--force"], cwd=directory,
                              env={**os.environ, **environment}, capture_output=True, text=True,
                              timeout=120, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        found = {name: contents(os.path.join(directory, name))
                 for name in command.outputs
                 if name not in command.timed and not name.endswith(".sqlite")}  # stores contain
                                                                                 # times
        shutil.rmtree(directory)
        return without_times(done.stdout), found

    def test_the_locale_has_a_decimal_comma(self):
        done = subprocess.run(
            [sys.executable, "-c", "import ctypes; s = ctypes.create_string_buffer(9); "
             "ctypes.CDLL(None).snprintf(s, 9, b'%.1f', ctypes.c_double(1.5)); print(s.value)"],
            env={**os.environ, **GERMAN}, capture_output=True, text=True, check=False)
        self.assertEqual((done.stdout, done.stderr), ("b'1,5'\n", ""))

    def test_every_command_writes_the_same_bytes(self):
        for command in QUICK:
            with self.subTest(command=command.name):
                self.assertEqual(self.outputs_of(command, GERMAN), self.outputs_of(command, {}))


if __name__ == "__main__":
    unittest.main()

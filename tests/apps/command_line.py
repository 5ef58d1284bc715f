# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Base of command-line tests: runs the tool as a user does, in an empty directory."""

import json
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest

TOOL = os.path.abspath(sys.argv.pop(1))


class CommandLineTest(unittest.TestCase):
    """Every test has its own directory, to which file names are relative."""

    def setUp(self):
        directory = tempfile.TemporaryDirectory(prefix="tofsmith-test-")
        self.addCleanup(directory.cleanup)
        self.directory = directory.name

    def path(self, name):
        return os.path.join(self.directory, name)

    def files(self):
        """Returns all files and directories, including hidden ones."""
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

    def wait_for(self, name):
        for _ in range(1200):
            if os.path.exists(self.path(name)):
                return
            time.sleep(0.05)
        self.fail(f"{name} did not appear")

    def with_camera(self, arguments):
        """Adds the camera of the paper, for which the numbers in tests are valid, unless an option
        or a file next to the raw frames specifies a camera."""
        if not arguments or "--camera" in arguments:
            return arguments
        command, first = arguments[0], os.fsdecode(arguments[1]) if arguments[1:] else ""
        if command == "decode":
            recorded = os.path.splitext(first)[0] + ".camera.toml"
            needs_camera = not os.path.exists(self.path(recorded))
        elif command == "codes":
            needs_camera = first and not first.startswith("-")
        elif command == "require":
            needs_camera = first.startswith("-")
        else:
            needs_camera = command in ("calibrate", "evaluate", "export", "multipath", "simulate",
                                       "upload")
        return (*arguments, "--camera", "paper-10f0") if needs_camera else arguments

    def start(self, *arguments, **options):
        """Runs without progress output, which depends on the speed of the machine."""
        return subprocess.Popen([TOOL, "--quiet", *self.with_camera(arguments)],
                                cwd=self.directory, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, **options)

    def run_tool(self, *arguments, **options):
        process = self.start(*arguments, **options)
        out, error = process.communicate(timeout=60)
        return process.returncode, out, error.decode(errors="replace")

    def interrupted(self, process, number=signal.SIGINT, timeout=60):
        """Stops a process, which prints nothing and leaves no hidden file. Returns standard error.
        """
        process.send_signal(number)
        out, error = process.communicate(timeout=timeout)
        self.assertEqual((process.returncode, out), (130, b""), error)
        self.assertFalse([name for name in self.files() if ".tofsmith" in name])
        return error.decode()

    def do(self, *arguments, **options):
        """The command must succeed without standard error; returns standard output."""
        code, out, error = self.run_tool(*arguments, **options)
        self.assertEqual((code, error), (0, ""), arguments)
        return out.decode()

    def do_json(self, *arguments):
        """The command must print exactly one JSON document."""
        return json.loads(self.do(*arguments, "--json"))

    def refuse(self, arguments, *words, code=1):
        """Runs a command that must fail: standard output is empty, the message contains all words,
        and no file is created or changed."""
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

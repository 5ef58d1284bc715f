# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Without a terminal, long commands report progress in plain lines."""

import signal
import subprocess
import time
import unittest

import command_line
from command_line import CommandLineTest

LONG = ("evaluate", "sinusoid-k4", "--trials", "1000000000", "--threads", "1")


class ProgressLines(CommandLineTest):
    def start_watched(self, *arguments):
        return subprocess.Popen([command_line.TOOL, *arguments], cwd=self.directory,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def end(self, process):
        process.send_signal(signal.SIGINT)
        out, error = process.communicate(timeout=60)
        self.assertEqual((process.returncode, out), (130, b""))
        return error

    def test_long_commands_print_plain_lines_unless_quiet(self):
        watched = [self.start_watched(*LONG, *json) for json in ((), ("--json",))]
        quiet = [self.start_watched(*words) for words in (("--quiet", *LONG), (*LONG, "--quiet"))]
        for process in watched:
            first = process.stderr.readline()
            self.assertRegex(first, rb"^tofsmith: evaluating \d+ %  \w[^\r\x1b]*\n$")
        time.sleep(1)  # longer than the delay of the first line
        for process in (*watched, *quiet):
            self.assertEqual(self.end(process), b"tofsmith: interrupted; nothing was written\n")

    def test_short_commands_print_no_progress(self):
        process = self.start_watched("evaluate", "sinusoid-k4", "--trials", "100", "--set",
                                  "samples=60", "--json")
        self.assertEqual(process.communicate(timeout=60)[1], b"")


if __name__ == "__main__":
    unittest.main()

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C stops any command soon, leaves no partial files and keeps finished results."""

import json
import os
import signal
import time
import unittest

from command_line import CommandLineTest

LONG = ("--trials", "100000000")


class Interrupts(CommandLineTest):
    def interrupt(self, *arguments, after=lambda: time.sleep(0.5), directory=None):
        process = self.start(*arguments)
        after()
        error = self.interrupted(process)
        kept = (f"; finished files are kept in {directory}, and the same command resumes from there"
                if directory else "; nothing was written")
        self.assertEqual(error, f"tofsmith: interrupted{kept}\n")

    def wait_for_handler(self, process, number):
        """Waits until the process, which may start slowly, handles the signal."""
        for _ in range(600):
            with open(f"/proc/{process.pid}/status", encoding="ascii") as status:
                caught = next(line for line in status if line.startswith("SigCgt:"))
            if int(caught.split()[1], 16) >> (number - 1) & 1:
                return
            time.sleep(0.1)
        self.fail(f"signal {number} is not handled")

    def contents(self):
        return {name: self.bytes_of(name) for name in self.files()
                if os.path.isfile(self.path(name))}

    def test_while_waiting_for_input(self):
        os.mkfifo(self.path("pipe.npy"))
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            process = self.start("decode", "pipe.npy", "--code", "sinusoid-k4", "-o", "d.npy")
            self.wait_for_handler(process, number)
            time.sleep(0.3)
            self.assertEqual(self.interrupted(process, number, timeout=10),
                             "tofsmith: interrupted; nothing was written\n")
        self.assertEqual(self.files(), ["pipe.npy"])

    def test_a_design_killed_while_writing_can_be_continued(self):
        asked = ("design", "--method", "factorize", "--exposures", "3", "--trials", "1000", "-o",
                 "d")
        self.do(*asked)
        before = self.contents()
        for name in ("d/design.json", "d/details.json", "d/report.html"):
            os.remove(self.path(name))
        with open(self.path("d/camera.toml"), "w") as half:
            half.write("[")
        self.do(*asked)
        self.assertEqual(sorted(before), sorted(self.contents()))
        for name in ("d/camera.toml", "d/codes/hamiltonian-k3.code.json"):
            self.assertEqual(self.bytes_of(name), before[name])

    def test_an_export_killed_while_writing_can_be_continued(self):
        asked = ("export", "square-k4", "--format", "csv", "--samples", "60", "--no-loss", "-o", "e")
        self.do(*asked)
        before = self.contents()
        lost = sorted(before)[-1]
        os.remove(self.path(lost))
        self.do(*asked)
        self.assertEqual(self.contents(), before)
        self.write(lost, "mine")
        self.refuse(list(asked), lost, "already exists")

    def test_evaluate(self):
        self.interrupt("evaluate", "sinusoid-k4", *LONG, "-o", "e.csv")
        self.assertEqual(self.files(), [])

    def test_evaluate_in_other_ways(self):
        self.interrupt("evaluate", "sinusoid-k4", "--best-rotation", *LONG)
        self.interrupt("evaluate", "hamiltonian-k4", "--method", "ml", *LONG)

    def test_simulate(self):
        self.interrupt("simulate", "table-top", "--code", "hamiltonian-k5", "--frames", "500",
                       "-o", "raw.npy")
        self.assertEqual(self.files(), [])

    def test_design_while_codes_are_factorized(self):
        self.interrupt("design", *LONG, "--set", "samples=2040", "-o", "d")
        self.assertNotIn("d/design.json", self.files())

    def test_design_keeps_finished_codes_and_resumes(self):
        kept = "d/finished/hamiltonian-k3-factorized.json"

        def once_finished():
            self.wait_for(kept)
            time.sleep(0.5)  # judging has begun

        self.interrupt("design", "--method", "factorize", "--exposures", "3", *LONG, "-o", "d", after=once_finished,
                       directory="d")
        self.assertNotIn("d/design.json", self.files())
        before = self.bytes_of(kept)
        document = self.do_json("design", "--method", "factorize", "--exposures", "3", "--trials", "1000",
                                "-o", "d")
        self.assertEqual(self.bytes_of(kept), before)
        resumed = next(c for c in document["codes"] if c["name"] == "hamiltonian-k3-factorized")
        self.assertEqual(resumed["seconds"], json.loads(before)["candidates"][0]["seconds"])


if __name__ == "__main__":
    unittest.main()

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""tofsmith atlas, and designs without a search."""

import csv
import io
import unittest

from command_line import CommandLineTest

ONE = """tofsmith atlas 1
code taps 1 exposures 3 peak 4 bandwidth 10 shortest 0 error linear linear_m 0.2 0.001 circular_m 0.1 0.001
light 0 25000
gate 0 50000
light 0 25000
gate 33333 83333
light 0 25000
gate 66667 116667
"""


class Atlas(CommandLineTest):
    def test_lists_filters_and_writes(self):
        document = self.do_json("atlas", "--taps", "1", "--error", "circular", "--bandwidth", "5:20",
                                "-o", "a.csv")
        codes = document["codes"]
        self.assertTrue(codes)
        for code in codes:
            self.assertEqual((code["taps"], code["error"]), (1, "circular"))
            self.assertTrue(5 <= code["bandwidth_f0"] <= 20)
        rows = list(csv.DictReader(io.StringIO(self.bytes_of("a.csv").decode())))
        self.assertEqual([row["name"] for row in rows], [code["name"] for code in codes])
        self.assertEqual(float(rows[0]["circular_m"]), codes[0]["circular_m"])
        text = self.do("atlas", "--taps", "1", "--exposures", "4", "-o", "a.html")
        self.assertIn("bandwidth^-a peak^-b", text)
        self.assertIn("Error over bandwidth", self.bytes_of("a.html").decode())

    def test_rejects_other_versions_damage_and_unknown_words(self):
        self.write("one.txt", ONE)
        self.assertEqual(len(self.do_json("atlas", "--file", "one.txt")["codes"]), 1)
        self.write("new.txt", ONE.replace("atlas 1", "atlas 2"))
        self.write("cut.txt", ONE[:-20])
        for words, code, problem in (
                (("--file", "new.txt"), 1, "new.txt:1: found an atlas of version 2; expected version 1"),
                (("--file", "cut.txt"), 1, "cut.txt:8: found"),
                (("--file", "none.txt"), 1, "none.txt"),
                (("--peak", "high"), 2, "--peak: found high; expected a number"),
                (("-o", "a.txt"), 2, "expected .csv or .html"),
                (("--error", "round"), 2, "--error")):
            done = self.run_tool("atlas", *words)
            self.assertEqual(done[0], code, words)
            self.assertIn(problem, done[2])
        self.assertEqual(self.files(), ["cut.txt", "new.txt", "one.txt"])

    def test_zero_effort_searches_nothing(self):
        few = ("--set", "operating.signal_e_per_s=[1e4]", "--set", "operating.ambient_e_per_s=[1e4]",
               "--trials", "2000", "--effort", "0")
        document = self.do_json("design", "paper-10f0", *few)
        self.assertEqual({code["method"] for code in document["codes"]}, {"atlas", "family"})
        self.assertEqual(self.do_json("design", "paper-10f0", *few), document)
        self.do("design", "paper-10f0", *few, "-o", "d")
        self.assertIn("report.html", "".join(self.files()))
        for words in (("--method", "optimize"), ("--target", "hamiltonian-k3"), ("--effort", "0.001")):
            code, _, error = self.run_tool("design", "paper-10f0", *few[:4], "--effort", "0", *words)
            self.assertEqual(code, 2, words)
            self.assertIn("--effort", error)


if __name__ == "__main__":
    unittest.main()

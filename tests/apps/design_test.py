# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Designs give documents, directories and reports, and can be resumed; the demo runs; the atlas
gives codes without a search."""

import csv
import io
import json
import unittest

import numpy as np

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


class Design(CommandLineTest):
    FAST = ("--trials", "1000", "--effort", "0.05")
    ARGUMENTS = ("design", "paper-10f0", "--exposures", "3", *FAST)

    def test_design_report_and_resume(self):
        document = self.do_json(*self.ARGUMENTS, "-o", "d")
        names = [code["name"] for code in document["codes"]]
        self.assertIn(document["best"], names)
        designed = [code for code in document["codes"] if "per_measurement" in code]
        self.assertTrue(designed)
        self.assertEqual(document, json.loads(self.bytes_of("d/design.json")))

        with self.subTest("a design may not be replaced unasked"):
            self.refuse([*self.ARGUMENTS, "-o", "d"], "d/design.json", "--force")
        with self.subTest("report"):
            self.assertEqual(self.do_json("report", "d", "-o", "r.html")["best"], document["best"])
            self.assertIn(document["best"].encode(), self.bytes_of("r.html"))
            self.refuse(["report", "d"], "report.html", "--force")
        with self.subTest("finished codes are reused"):
            name = f"d/finished/{designed[0]['name']}.json"
            record = json.loads(self.bytes_of(name))
            record["candidates"][0]["seconds"] = 12345.5
            self.write(name, json.dumps(record))
            again = self.do_json(*self.ARGUMENTS, "-o", "d", "--force")
            kept = next(c for c in again["codes"] if c["name"] == designed[0]["name"])
            self.assertEqual(kept["seconds"], 12345.5)
            self.assertEqual(again["best"], document["best"])

    def test_the_winner_has_a_requested_number_of_exposures(self):
        document = self.do_json("design", "paper-10f0", "--set", "sensor.taps=2", "--exposures",
                                "2", *self.FAST)
        best = next(c for c in document["codes"] if c["name"] == document["best"])
        self.assertEqual(best["exposures"], 2)
        self.assertTrue(all(code["taps"] == 2 for code in document["codes"]))
        self.assertIn("is the best code with 2 exposures", " ".join(document["explanation"]))

    def test_without_a_directory_designs_are_kept_in_a_default_one(self):
        for directory in ("tofsmith-design", "tofsmith-design-2"):
            said = self.do("design", "paper-10f0", "--set", "samples=24", "--effort", "0", "--method",
                           "best", "--trials", "1000")
            self.assertIn(f"wrote {directory}/report.html", said)
            self.assertIn(f"{directory}/design.json", self.files())

    def test_designs_for_a_table(self):
        np.savetxt(self.path("t.csv"), np.stack(
            [0.5 + 0.5 * np.cos(2 * np.pi * (np.arange(240) / 240 - k / 3)) for k in range(3)], 1),
            delimiter=",")
        document = self.do_json("design", "--target", "t.csv", "--method", "factorize", *self.FAST)
        self.assertIn("t-factorized", [code["name"] for code in document["codes"]])

    def test_demo(self):
        truth = np.full((12, 16), 2.0, np.float32)
        np.save(self.path("s.npy"), truth)
        document = self.do_json("demo", "--depth", "s.npy", "--trials", "1000", "--effort", "0", "-o",
                                "demo")
        self.assertIn(document["best"], [code["name"] for code in document["codes"]])
        self.assertEqual(np.load(self.path("demo/depth.npy")).shape, truth.shape)
        self.assertLessEqual({"demo/report.html", "demo/points.ply", "demo/depth.exr"},
                             set(self.files()))
        self.assertTrue(self.do_json("report", "demo", "-o", "r.html")["scene"])


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
        for words, code, problem in (
                (("--file", "new.txt"), 1, "new.txt:1: found an atlas of version 2; expected version 1"),
                (("--file", "none.txt"), 1, "none.txt"),
                (("--peak", "high"), 2, "--peak: found high; expected a number"),
                (("-o", "a.txt"), 2, "expected .csv or .html"),
                (("--error", "round"), 2, "--error")):
            done = self.run_tool("atlas", *words)
            self.assertEqual(done[0], code, words)
            self.assertIn(problem, done[2])
        self.assertEqual(self.files(), ["new.txt", "one.txt"])

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

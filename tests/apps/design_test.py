# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Designs give documents, directories and reports, and can be resumed; the demo runs."""

import json
import os
import unittest

import numpy as np

from command_line import CommandLineTest


class Design(CommandLineTest):
    FAST = ("--trials", "1000", "--effort", "0.05")
    ARGUMENTS = ("design", "paper-10f0", "--exposures", "3", *FAST)

    def test_design_report_and_resume(self):
        document = self.do_json(*self.ARGUMENTS, "-o", "d", "--threads", "1")
        names = [code["name"] for code in document["codes"]]
        self.assertIn(document["best"], names)
        designed = [code for code in document["codes"] if "per_measurement" in code]
        self.assertTrue(designed)
        for code in designed:
            self.assertLessEqual({"method", "iterations", "seconds"}, set(code))
            for measurement in code["per_measurement"]:
                self.assertLessEqual({"residual_rms", "demodulation_duty", "modulation_duty",
                                      "peak", "edges"}, set(measurement))
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
        with self.subTest("same seed, same bytes, any number of threads"):
            self.do(*self.ARGUMENTS, "-o", "e", "--threads", "2")
            codes = os.listdir(self.path("d/codes"))
            self.assertGreater(len(codes), 5)
            for code in codes:
                self.assertEqual(self.bytes_of("d/codes/" + code), self.bytes_of("e/codes/" + code))

    def test_the_winner_has_a_requested_number_of_exposures(self):
        document = self.do_json("design", "paper-10f0", "--set", "sensor.taps=2", "--exposures",
                                "2", *self.FAST)
        best = next(c for c in document["codes"] if c["name"] == document["best"])
        self.assertEqual(best["exposures"], 2)
        self.assertIn("is the best code with 2 exposures", " ".join(document["explanation"]))

    def test_without_a_directory_designs_are_kept_in_a_default_one(self):
        for directory in ("tofsmith-design", "tofsmith-design-2"):
            said = self.do("design", "paper-10f0", "--effort", "0", "--method", "best", "--trials",
                           "1000")
            self.assertIn(f"wrote {directory}/report.html", said)
            self.assertIn(f"{directory}/design.json", self.files())

    def test_designs_for_two_buckets(self):
        document = self.do_json(*self.ARGUMENTS, "--set", "sensor.taps=2")
        self.assertTrue(all(code["taps"] == 2 for code in document["codes"]))

    def test_designs_for_a_table(self):
        np.savetxt(self.path("t.csv"), np.stack(
            [0.5 + 0.5 * np.cos(2 * np.pi * (np.arange(240) / 240 - k / 3)) for k in range(3)], 1),
            delimiter=",")
        document = self.do_json("design", "--target", "t.csv", "--method", "factorize", *self.FAST)
        self.assertIn("t-factorized", [code["name"] for code in document["codes"]])

    def test_demo(self):
        truth = np.full((12, 16), 2.0, np.float32)
        np.save(self.path("s.npy"), truth)
        document = self.do_json("demo", "--depth", "s.npy", *self.FAST, "-o", "demo")
        self.assertIn(document["best"], [code["name"] for code in document["codes"]])
        self.assertEqual(np.load(self.path("demo/depth.npy")).shape, truth.shape)
        self.assertLessEqual({"demo/report.html", "demo/points.ply", "demo/depth.exr"},
                             set(self.files()))
        self.assertTrue(self.do_json("report", "demo", "-o", "r.html")["scene"])


if __name__ == "__main__":
    unittest.main()

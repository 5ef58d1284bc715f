# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Rows of one exposure, from matrices of others."""

import unittest

import numpy as np

from command_line import CommandLineTest

CAMERA = """fundamental_frequency_hz = 5e6
exposure_s = 1
samples = 60
[light]
peak_factor = 20
impulse_response = { kind = "gaussian", cutoff_hz = 30e6 }
[sensor]
readout = "rows"
read_noise_e = 0
[operating]
signal_e_per_s = [1e4]
ambient_e_per_s = [1e3]
error = "circular"
"""
RANGE_M = 299792458 / 2 / 5e6


class Rows(CommandLineTest):
    def setUp(self):
        super().setUp()
        self.write("rows.toml", CAMERA)
        light = np.zeros(60)
        light[:3] = 7
        turns = 2 * np.pi * np.outer((1, 2, 3), np.arange(60)) / 60
        self.rows = np.concatenate([np.cos(turns), np.sin(turns)])
        np.save(self.path("light.npy"), light)
        np.save(self.path("weights.npy"), self.rows)

    def test_matrices_are_judged_captured_and_decoded(self):
        code = ("light.npy,weights.npy", "--camera", "rows.toml")
        said = self.do_json("evaluate", *code, "--trials", "1000")["codes"][0]
        point = said["points"][0]
        self.assertEqual(said["name"], "weights")
        self.assertLess(point["receiver_bound_mae_m"], point["cramer_rao_mae_m"])
        self.assertLess(point["circular_mde_m"], 1.2 * point["cramer_rao_mae_m"])
        truth = np.linspace(1, RANGE_M - 1, 400).reshape(20, 20).astype(np.float32)
        np.save(self.path("scene.npy"), truth)
        self.do("simulate", "scene.npy", "--kind", "radial", "--no-falloff", "--code", *code, "-o",
                "raw.npy", "--signal", "1e5")
        self.assertEqual(np.load(self.path("raw.npy")).shape, (20, 20, 6))
        for method in ("zncc", "ml"):
            self.do("decode", "raw.npy", "--code", *code, "--method", method, "-o", "depth.npy",
                    "--force")
            depth = np.load(self.path("depth.npy"))
            self.assertLess(np.median(np.abs(depth - truth)), 0.03, method)

    def test_what_is_no_light_and_no_row_is_refused_with_its_place(self):
        broken = self.rows.copy()
        broken[2, 5] = np.nan
        for rows, message in ((0 * self.rows, "zeros in row 0"), (broken, "found nan"),
                              (np.ones((17, 60)), "found 17 rows"),
                              (np.ones((6, 61)), "a period leaves its end point out")):
            np.save(self.path("bad.npy"), rows)
            self.refuse(["evaluate", "light.npy,bad.npy", "--camera", "rows.toml"],
                        "bad.npy", message)
        np.save(self.path("dark.npy"), -np.ones(60))
        self.refuse(["evaluate", "dark.npy,weights.npy", "--camera", "rows.toml"],
                    "dark.npy[0, 0]", "expected light")
        self.refuse(["evaluate", "light.npy,weights.npy", "--camera", "paper-10f0"],
                    "weights.npy[6, 2]", "need a camera with sensor.readout")


if __name__ == "__main__":
    unittest.main()

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""A mixer, from its camera file to depth."""

import json
import unittest

import numpy as np

from command_line import CommandLineTest

CAMERA = """fundamental_frequency_hz = 20e6
exposure_s = 0.02
samples = 120
[light]
peak_factor = 4
impulse_response = { kind = "gaussian", cutoff_hz = 150e6 }
[sensor]
demodulation = "signed"
read_noise_e = 30
adc_bits = 14
gain_e_per_dn = 4
[operating]
signal_e_per_s = [1e6]
ambient_e_per_s = [1e5]
error = "circular"
"""
RANGE_M = 299792458 / 2 / 20e6


class Mixer(CommandLineTest):
    def setUp(self):
        super().setUp()
        self.write("mixer.toml", CAMERA)

    def test_families_and_arrays_are_judged_captured_and_decoded(self):
        turns = 2 * np.pi * ((np.arange(120) + 0.5) / 120)[:, None]
        weights = np.cos(turns - np.arange(4) * np.pi / 2)
        light = np.repeat(1 + np.cos(turns), 4, axis=1)
        np.savez(self.path("analog.npz"), modfs=light / light.mean(0), demodfs=weights)
        truth = np.linspace(1, RANGE_M - 1, 400).reshape(20, 20).astype(np.float32)
        np.save(self.path("scene.npy"), truth)
        for code in ("square-k4", "analog.npz"):
            code = (code, "--camera", "mixer.toml")
            point = self.do_json("evaluate", *code, "--trials", "1000")["codes"][0]["points"][0]
            self.assertLess(point["receiver_bound_mae_m"], point["cramer_rao_mae_m"])
            self.assertLess(point["circular_mde_m"], 1.3 * point["cramer_rao_mae_m"])
            self.do("simulate", "scene.npy", "--kind", "radial", "--no-falloff", "--code", *code,
                    "-o", "raw.npy", "--signal", "1e6", "--ambient", "1e5", "--force")
            raw = np.load(self.path("raw.npy"))
            self.assertEqual(raw.shape, (20, 20, 4))
            self.assertLess(raw.min(), 0)
            for method in ("zncc", "ml"):
                self.do("decode", "raw.npy", "--code", *code, "--method", method, "-o",
                        "depth.npy", "--force")
                depth = np.load(self.path("depth.npy"))
                self.assertLess(np.median(np.abs(depth - truth)), 0.1, method)

    def test_codes_are_shown_written_and_read_with_their_weights(self):
        code = ("square-k4", "--camera", "mixer.toml")
        self.assertIn("mean weight", self.do("codes", *code))
        self.do("codes", *code, "-o", "a.code.json")
        with open(self.path("a.code.json"), encoding="utf-8") as file:
            self.assertTrue(json.load(file)["signed"])
        self.do("codes", *code, "-o", "a.npz")
        self.assertEqual(set(np.load(self.path("a.npz"))["demodfs"].flat), {-1, 1})
        self.do("codes", *code, "-o", "a.csv")
        self.do("codes", *code, "-o", "a.html")
        for file in ("a.code.json", "a.npz", "a.csv"):
            self.do("codes", file, "--camera", "mixer.toml")
            self.refuse(["codes", file, "--camera", "paper-10f0", "--set", "samples=120"], file
                        if not file.endswith("json") else "sensor.demodulation")

    def test_what_is_of_taps_is_refused(self):
        for keys, message in ((("sensor.taps=2",), "one number per exposure"),
                              (("sensor.taps=2", "sensor.readout=difference"), "must be 1"),
                              (("sensor.readout=rows",), "sensor.readout"),
                              (("sensor.drain=false",), "sensor.drain"),
                              (("sensor.black_level_dn=0",), "sensor.black_level_dn")):
            settings = [word for key in keys for word in ("--set", key)]
            self.refuse(["evaluate", "square-k4", "--camera", "mixer.toml", *settings], message)
        self.refuse(["calibrate", "noise", "raw.npy", "--black-level", "0", "--camera",
                     "mixer.toml"], "sensor.demodulation")


if __name__ == "__main__":
    unittest.main()

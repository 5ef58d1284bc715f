# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Decoding with measured tables and with per-pixel maps."""

import os
import subprocess
import unittest

import numpy as np

import command_line
from command_line import CommandLineTest

RANGE_M = 299792458 / 2 / 15e6
SAMPLES = 120


class Tables(CommandLineTest):
    def simulate(self, depth, raw, *more):
        np.save(self.path("scene.npy"), depth.astype(np.float32))
        self.do("simulate", "scene.npy", "--kind", "radial", "--code", "hamiltonian-k3",
                "--no-falloff", "-o", raw, "--force", *more)
        return np.load(self.path(raw))

    def sweep(self, *more):
        """Simulates the measurement of correlation functions at every delay; returns (N, K)."""
        delays = RANGE_M * np.arange(SAMPLES) / SAMPLES
        delays[0] = RANGE_M  # 0 means no return
        return self.simulate(delays[None, :], "sweep.npy", "--signal", "1e10", *more)[0]

    def frame(self, *more):
        """Returns a ramp of distances and writes its raw frame raw.npy."""
        truth = np.linspace(1.0, 4.0, 12 * 16).reshape(12, 16)
        self.simulate(truth, "raw.npy", "--signal", "1e7", *more)
        return truth

    def decode(self, table, *more, output="depth.npy"):
        document = self.do_json("decode", "raw.npy", "--code", table, "-o", output, "--force",
                                *more)
        return np.load(self.path(output)), document["notes"]

    def test_the_range_and_its_source_are_reported(self):
        np.save(self.path("t.npy"), self.sweep())
        self.frame()
        os.remove(self.path("raw.camera.toml"))
        self.write("c.toml", "fundamental_frequency_hz = 30e6\n")

        def range_lines(code, *more):
            arguments = ["decode", "raw.npy", "--code", code, "-o", "d.npy", "--force", *more]
            lines = [line for line in self.do(*arguments).splitlines() if "range" in line[:5]]
            document = self.do_json(*arguments)
            return lines, document["range_m"], document["range_source"]
        line, range_m, source = range_lines("t.npy")
        self.assertEqual(line, ["range 9.993 m (of the camera paper-10f0)"])
        self.assertAlmostEqual(range_m, RANGE_M)
        self.assertIn("camera paper-10f0", source)
        self.assertEqual(range_lines("t.npy", "--range-m", "3"), (["range 3 m (--range-m)"], 3,
                                                           "--range-m"))
        line, range_m, _ = range_lines("t.npy", "--camera", "c.toml")
        self.assertEqual(line, ["range 4.997 m (of the camera c)"])
        self.assertAlmostEqual(range_m, RANGE_M / 2)
        self.assertEqual(range_lines("hamiltonian-k3", "--camera", "paper-10f0")[0], [])

    def test_the_default_camera_is_reported_and_has_one_tap(self):
        np.save(self.path("t.npy"), self.sweep())
        self.frame()
        os.remove(self.path("raw.camera.toml"))
        for code, advice in (("t.npy", "--range-m or --camera override it"),
                             ("hamiltonian-k3", "--camera overrides it")):
            done = subprocess.run([command_line.TOOL, "--quiet", "decode", "raw.npy", "--code", code,
                                   "-o", "d.npy", "--force"], cwd=self.directory, text=True,
                                  capture_output=True, check=True)
            self.assertIn(f"range 7.495 m (of the default camera indoor; {advice})", done.stdout)

    def test_peculiarities_are_reported(self):
        table = self.sweep()
        self.frame()
        np.save(self.path("t.npy"), table)
        expected, _ = self.decode("t.npy")
        np.save(self.path("closed.npy"), np.vstack([table, table[:1]]).T)
        depth, notes = self.decode("closed.npy")
        np.testing.assert_array_equal(depth, expected)
        self.assertIn("(3, 121) was interpreted as (K, N)", notes[0])
        self.assertIn("repeats the first and was dropped: N = 120, which makes depths 0.833 % "
                      "larger", notes[1])
        self.assertIn("--keep-end-point", notes[1])
        text = self.do("decode", "raw.npy", "--code", "closed.npy", "-o", "d.npy")
        self.assertIn("dropped", text)
        kept, notes = self.decode("closed.npy", "--keep-end-point", "--table-axes", "kn")
        self.assertGreater(np.abs(kept - expected).max(), 0.005)
        self.assertEqual(len(notes), 1)
        self.assertIn("1 of 121 bins", notes[0])  # both ends are equal

    def test_taps_of_a_table_need_an_order(self):
        buckets = ("--set", "sensor.taps=2")
        np.save(self.path("t.npy"), self.sweep(*buckets))
        truth = self.frame(*buckets)
        depth, _ = self.decode("t.npy", *buckets, "--tap-order", "interleaved")
        self.assertLess(np.abs(depth - truth).max(), 0.02)
        self.refuse(["decode", "raw.npy", "--code", "t.npy", *buckets, "-o", "d.npy"], "t.npy",
                    "--tap-order")

    def test_unequal_duties_are_reported(self):
        np.save(self.path("t.npy"), self.sweep() * [1, 0.5, 0.8])
        self.frame()
        note = self.decode("t.npy")[1][0]
        self.assertIn("--ambient mean", note)
        self.assertIn("dark offset was not subtracted, add it as an array 'offset_dn'", note)
        self.assertEqual(self.decode("t.npy", "--ambient", "mean")[1], [])

    def test_equal_rows_are_reported(self):
        twice = np.tile(self.sweep()[::2], (2, 1))
        np.save(self.path("t.npy"), twice)
        self.frame()
        notes = self.decode("t.npy")[1]
        self.assertIn("60 of 120 bins are ambiguous and decode to a nearer bin", notes[0])
        self.assertIn("4.997 m as 0 m", notes[0])
        text = self.do("evaluate", "multifrequency-2x3-4x3", "--trials", "100")
        self.assertIn("multifrequency-2x3-4x3: 120 of 240 bins are ambiguous and decode to a nearer bin", text)

    def test_options_of_tables_require_a_table(self):
        self.frame()
        for option in (("--range-m", "3"), ("--ambient", "none"), ("--table-axes", "nk"),
                       ("--keep-end-point",)):
            self.refuse(["decode", "raw.npy", "--code", "hamiltonian-k3", "-o", "d.npy", *option],
                        option[0], "measured table", code=2)

    def test_rejects_impossible_ranges(self):
        np.save(self.path("t.npy"), self.sweep())
        self.frame()
        decode = ["decode", "raw.npy", "--code", "t.npy", "-o"]
        self.refuse([*decode, "d.npy", "--range-m", "far"], "--range-m: found far; expected a number",
                    code=2)
        for value in ("1e300", "0", "-1", "nan", "inf"):
            error = self.refuse([*decode, "d.npy", "--range-m", value], "--range-m",
                                f"found {value}; must be in (0, 1000000]", code=2)
            self.assertLess(len(error), 150)
        self.refuse([*decode, "d.png", "--range-m", "1e4"], "d.png", "found a depth of", "65.535 m",
                    ".npy")
        self.do(*decode, "d.png", "--range-m", "65.6")  # every depth is smaller

    def test_only_decode_accepts_tables(self):
        np.save(self.path("t.npy"), self.sweep())
        np.savez(self.path("t.npz"), corrfs=np.load(self.path("t.npy")))
        np.savez(self.path("other.npz"), curves=np.load(self.path("t.npy")), made="today")
        self.frame()
        for table in ("t.npy", "t.npz"):
            for command in (["evaluate", table], ["codes", table],
                            ["simulate", "table-top", "--code", table, "-o", "r.npy"]):
                self.refuse(command, table, "measured table", "only decode supports")
        self.refuse(["decode", "raw.npy", "--code", "other.npz", "-o", "d.npy"], "other.npz",
                    "curves, made", "modfs", "corrfs")

    def test_rejects_maps_that_do_not_fit(self):
        self.frame()
        np.save(self.path("m.npy"), np.ones((16, 12), np.float32))
        for option in ("--gain-map", "--offset-map"):
            self.refuse(["decode", "raw.npy", "--code", "hamiltonian-k3", option, "m.npy", "-o",
                         "d.npy"], "m.npy", "16 x 12", "12 x 16")


if __name__ == "__main__":
    unittest.main()

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Limits of depth on the command line."""

import unittest

import numpy as np

from command_line import CommandLineTest

CAMERA = ("--set", "fundamental_frequency_hz=20e6", "--set", "sensor.taps=2",
          "--set", "sensor.readout=difference")
CODE = "multifrequency-4x4-5x4"


class DepthLimits(CommandLineTest):
    def setUp(self):
        super().setUp()
        np.save(self.path("truth.npy"), np.repeat(np.float32([[0.5, 2.0, 3.5]]), 5, axis=0))
        self.do("simulate", "truth.npy", "--code", CODE, *CAMERA, "--signal", "1e6", "-o",
                "raw.npy")

    def decode(self, *options):
        document = self.do_json("decode", "raw.npy", "--code", CODE, *CAMERA, *options, "-o",
                                "out.npz", "--force")
        planes = np.load(self.path("out.npz"))
        # The corners are farther away than the middle row.
        return document, {name: planes[name][2] for name in planes.files if planes[name].ndim == 2}

    def test_every_method_reports_pixels_too_near_and_too_far(self):
        for method in ("zncc", "ml", "unwrap"):
            _, planes = self.decode("--min-depth", "1", "--max-depth", "2.5", "--method", method)
            np.testing.assert_array_equal(planes["status"], [8, 0, 9])
            np.testing.assert_array_equal(np.isnan(planes["depth"]), [True, False, True])
            np.testing.assert_allclose(planes["depth"][1], 2, atol=0.05)

    def test_a_filter_and_bands_of_rows_keep_to_the_limits(self):
        limits = ("--min-depth", "1", "--max-depth", "2.5")
        for options in (("--filter", "light"), ("--mixed", "drop"), ("--time-filter", "4")):
            _, planes = self.decode(*limits, *options)
            depth = planes["depth"][np.isfinite(planes["depth"])]
            self.assertTrue(((depth >= 1) & (depth <= 2.5)).all())
            self.assertGreater(depth.size, 0)

    def test_depths_after_the_offset_are_limited(self):
        _, planes = self.decode("--offset-m", "0.4", "--min-depth", "1.5", "--max-depth", "3.8")
        np.testing.assert_array_equal(planes["status"], [8, 0, 0])

    def test_a_note_says_if_every_depth_is_outside(self):
        document, _ = self.decode("--min-depth", "5", "--max-depth", "5.3")
        self.assertIn("--min-depth", "".join(document["notes"]))

    def test_impossible_limits(self):
        for options, words in ((("--min-depth", "-1"), "--min-depth"),
                               (("--max-depth", "0"), "--max-depth"),
                               (("--max-depth", "8"),
                                "--max-depth = 8; must be > 0 and at most the unambiguous range"),
                               (("--min-depth", "3", "--max-depth", "2"),
                                "--min-depth = 3; must be below the largest depth, 2 m")):
            self.refuse(["decode", "raw.npy", "--code", CODE, *CAMERA, *options, "-o", "no.npz"],
                        words, code=2)


if __name__ == "__main__":
    unittest.main()

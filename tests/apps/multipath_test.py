# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""The multipath command, and its error messages."""

import unittest

import numpy as np

from command_line import CommandLineTest

SMALL = ["--width", "8", "--height", "6"]
TWO_BUCKETS = ["--code", "hamiltonian-k5", "--set", "sensor.taps=2"]
SIMULATE = ["simulate", "corner", *SMALL, *TWO_BUCKETS, "-o", "raw.npy"]


class Multipath(CommandLineTest):

    def test_a_scene_is_included_with_the_maps(self):
        document = self.do_json(
            "multipath", "hamiltonian-k5", "--set", "sensor.taps=2", "--trials", "50",
            "--delays", "1", "--ratios", ".3", "--tails", ".5", "--signals", "1e5", "--scene",
            "corner", *SMALL, "--bounce-rays", "32", "-o", "page.html")
        self.assertEqual(document["scene"]["all"]["pixels"], 8 * 6)
        self.assertIn(b"seen from above", self.bytes_of("page.html"))

    def test_rejected_words(self):
        for arguments, words in (
                (["--bounces", "2"], ["--bounces", "2"]),
                (["--bounce-rays", "64"], ["--bounce-rays", "--bounces"]),
                (["--bounces", "1", "--bounce-rays", "8"], ["--bounce-rays", "8"]),
                (["--bounces", "1", "--multipath", "delta=1,ratio=.3"],
                 ["--bounces: found together with --multipath", "expected one of them"]),
                (["--multipath", "delta=1"], ["found no ratio", "delta=METRES"]),
                (["--multipath", "delta=a,ratio=.3"], ["found 'delta=a'"]),
                (["--tail", "0"], ["--tail", "found 0; must be > 0"]),
                (["--tail-ratio", ".3"], ["--tail-ratio", "--tail"])):
            self.refuse([*SIMULATE, *arguments], *words, code=2)
        np.save(self.path("z.npy"), np.ones((6, 8)))
        self.refuse(["simulate", "z.npy", *TWO_BUCKETS, "-o", "r.npy", "--bounces", "1"],
                    "a depth image; expected a scene with surfaces", code=2)
        self.refuse(["multipath", "hamiltonian-k5", "--width", "8"], "--width", "--scene", code=2)
        self.refuse(["multipath", "hamiltonian-k5", "-o", "m.csv"],
                    "-o m.csv: unknown extension; expected .json or .html", code=2)
        for value, words in (
                ("ratio=.1:.5:.9", "found 'ratio=.1:.5:.9'; expected ratio=a:b,delta=a:b"),
                ("ratio=.1,delay=1", "found 'delay=1'; expected ratio=a:b,delta=a:b"),
                ("ratio=", "found 'ratio='"),
                ("ratio=-.1:.5", "operating.multipath.ratio[0] = -0.1; must be"),
                ("delta=1:11", "below the unambiguous range, 7.495 m")):
            self.refuse(["design", "--multipath", value], "--multipath " + value, words,
                        code=2)
        self.refuse(["design", "--multipath-weight", ".2"], "found no multipath", code=2)
        self.refuse(["design", "--two-return-weight", ".2"], "found no multipath", code=2)
        self.refuse(["design", "--multipath", "ratio=.3", "--two-return-weight", "-1"],
                    "--two-return-weight", ">= 0", code=2)
        self.refuse(["design", "--multipath", "ratio=.3", "--multipath-weight", "1"],
                    "--multipath-weight", "in (0, 1)", code=2)
        self.refuse(["design", "--multipath", "ratio=.3", "--robust"], "--robust: found together",
                    code=2)

    def test_rejected_values(self):
        self.refuse([*SIMULATE, "--multipath", "delta=1,ratio=-.3"], "ratio = -0.3",
                    "must be finite and >= 0")


if __name__ == "__main__":
    unittest.main()

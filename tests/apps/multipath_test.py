# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Light that comes back twice, as a user asks for it, and what is refused."""

import unittest

import numpy as np

from command_line import CommandLineTest

SMALL = ["--width", "8", "--height", "6"]
TWO_BUCKETS = ["--code", "hamiltonian-k5", "--set", "sensor.taps=2"]
SIMULATE = ["simulate", "corner", *SMALL, *TWO_BUCKETS, "-o", "raw.npy"]


class Multipath(CommandLineTest):
    def test_truth_of_bounced_light_is_read_back_as_returns(self):
        self.do(*SIMULATE, "--bounces", "1", "--bounce-rays", "32", "--truth-multipath", "t.npz")
        truth = np.load(self.path("t.npz"))
        self.assertEqual(truth["first"].shape, (8 * 6 + 1,))
        self.assertTrue((truth["ratio"] > 0).all())
        direct = np.repeat(truth["depth_m"].ravel(), np.diff(truth["first"]))
        self.assertTrue((truth["distance_m"] >= direct).all())
        self.do(*SIMULATE[:-1], "again.npy", "--multipath-file", "t.npz")
        self.assertEqual(self.bytes_of("raw.npy"), self.bytes_of("again.npy"))

    def test_no_bounces_are_direct_light(self):
        self.do(*SIMULATE, "--bounces", "0")
        self.do(*SIMULATE[:-1], "direct.npy")
        self.assertEqual(self.bytes_of("raw.npy"), self.bytes_of("direct.npy"))

    def test_a_scene_beside_the_maps(self):
        document = self.do_json(
            "multipath", "hamiltonian-k5", "--set", "sensor.taps=2", "--trials", "50",
            "--delays", "1", "--ratios", ".3", "--tails", ".5", "--signals", "1e5", "--scene",
            "corner", *SMALL, "--bounce-rays", "32", "-o", "page.html")
        self.assertEqual(document["scene"]["all"]["pixels"], 8 * 6)
        self.assertIn(b"seen from above", self.bytes_of("page.html"))

    def test_designs_say_what_multipath_makes_of_codes(self):
        self.write("mine.toml",
                   "fundamental_frequency_hz = 15e6\nsamples = 60\n[light]\npeak_factor = 15\n"
                   "[sensor]\ntaps = 2\n[operating]\nsignal_e_per_s = [1e5]\n"
                   "ambient_e_per_s = [1e4]\n[operating.multipath]\nratio = [0.3, 0.3]\n"
                   "delay_m = [1, 2]\n")
        document = self.do_json("design", "mine.toml", "--method", "factorize", "--exposures", "5",
                                "--effort", "0.05", "--trials", "1000", "-o", "designed",
                                "--multipath", "ratio=.2:.4", "--multipath-weight", ".1")
        self.assertEqual(document["camera"]["operating"]["multipath"],
                         {"ratio": [0.2, 0.4], "delay_m": [1.0, 2.0], "weight": 0.1})
        for code in document["codes"]:
            errors = code["multipath"]
            self.assertGreater(errors["single_path"]["linear_m"], code["linear"]["mean_m"])
            self.assertIsNotNone(errors["two_return"])
        self.assertIn(b"And with multipath?", self.bytes_of("designed/report.html"))

    def test_refusals_of_words(self):
        for arguments, words in (
                (["--bounces", "2"], ["--bounces", "2"]),
                (["--bounces", "-1"], ["--bounces", "-1"]),
                (["--bounce-rays", "64"], ["--bounce-rays", "--bounces"]),
                (["--bounces", "1", "--bounce-rays", "8"], ["--bounce-rays", "8"]),
                (["--bounces", "1", "--multipath", "delta=1,ratio=.3"],
                 ["--bounces: found beside --multipath", "expected one of them"]),
                (["--multipath", "delta=1"], ["found no ratio", "delta=METRES"]),
                (["--multipath", "delta=a,ratio=.3"], ["found 'delta=a'"]),
                (["--tail", "0"], ["--tail", "found 0; must be > 0"]),
                (["--tail-ratio", ".3"], ["--tail-ratio", "--tail"])):
            self.refuse([*SIMULATE, *arguments], *words, code=2)
        np.save(self.path("z.npy"), np.ones((6, 8)))
        self.refuse(["simulate", "z.npy", *TWO_BUCKETS, "-o", "r.npy", "--bounces", "1"],
                    "a depth image; expected surfaces", code=2)
        self.refuse(["multipath", "hamiltonian-k5", "--width", "8"], "--width", "--scene", code=2)
        self.refuse(["multipath", "hamiltonian-k5", "-o", "m.csv"],
                    "-o m.csv: unknown extension; expected .json or .html", code=2)
        for rest in ([], ["--delays", "1"], ["--scene", "corner", "-o", "page.html"]):
            self.refuse(["evaluate", "hamiltonian-k5", "--multipath", *rest],
                        "a command of its own now: tofsmith multipath CODE", code=2)
        for value, words in (
                ("ratio=.1:.5:.9", "found 'ratio=.1:.5:.9'; expected ratio=a:b,delta=a:b"),
                ("ratio=.1,delay=1", "found 'delay=1'; expected ratio=a:b,delta=a:b"),
                ("ratio=", "found 'ratio='"),
                ("ratio=.5:.1", "operating.multipath.ratio = [0.5, 0.1]; must be"),
                ("ratio=-.1:.5", "operating.multipath.ratio = [-0.1, 0.5]; must be"),
                ("delta=0:1", "operating.multipath.delay_m = [0, 1]; must be"),
                ("delta=1:11", "below the unambiguous range, 9.993 m")):
            self.refuse(["design", "--multipath", value], "--multipath " + value, words,
                        code=2)
        self.refuse(["design", "--multipath-weight", ".2"], "found no multipath", code=2)
        self.refuse(["design", "--two-return-weight", ".2"], "found no multipath", code=2)
        self.refuse(["design", "--multipath", "ratio=.3", "--two-return-weight", "-1"],
                    "--two-return-weight", ">= 0", code=2)
        self.refuse(["design", "--multipath", "ratio=.3", "--multipath-weight", "1"],
                    "--multipath-weight", "in (0, 1)", code=2)
        self.refuse(["design", "--multipath", "ratio=.3", "--robust"], "--robust: found beside",
                    code=2)

    def test_refusals_of_values(self):
        self.refuse([*SIMULATE, "--multipath", "delta=1,ratio=-.3"], "ratio = -0.3",
                    "must be finite and >= 0")
        self.refuse([*SIMULATE, "--multipath", "delta=11,ratio=.3"], "unambiguous range")
        self.refuse([*SIMULATE, "--multipath", "delta=2,ratio=.3", "--multipath",
                     "delta=1,ratio=.3"], "in order")
        self.refuse(["design", "--set", "operating.multipath.ratio=[0.5,0.1]"],
                    "operating.multipath.ratio = [0.5, 0.1]; must be")

    def test_refusals_of_codes(self):
        self.do(*SIMULATE)
        self.refuse(["decode", "raw.npy", "--code", "sinusoid-k5", "--set", "sensor.taps=2",
                     "--method", "two-return", "-o", "d.npz"], "independent means")


if __name__ == "__main__":
    unittest.main()

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Output of `evaluate`: fields, targets, methods, settings."""

import json
import shlex
import unittest

from command_line import CommandLineTest

FAST = ("--trials", "1000")


class Evaluate(CommandLineTest):

    def test_prints_the_mean_first_and_every_level_on_request(self):
        codes = ("sinusoid-k4", "hamiltonian-k4")
        points = {code["name"]: [point["linear_mde_m"] for point in code["points"]]
                  for code in self.do_json("evaluate", *codes, *FAST)["codes"]}
        lines = self.do("evaluate", *codes, *FAST).splitlines()
        self.assertEqual([line.split()[4] for line in lines[1:7]], ["mean", "best", "worst"] * 2)
        for code, first in zip(codes, (1, 4)):
            for line, error_m in ((first + 1, min(points[code])), (first + 2, max(points[code]))):
                self.assertIn(code, lines[line])
                self.assertAlmostEqual(float(lines[line].split()[7]) / error_m, 1e3, delta=1)
        self.assertIn("all 25 light levels of the camera (S = 1e+03 to 1e+05, A = 100 to "
                      "1e+05 e/s), use --every-level", "\n".join(lines))
        full = [lines[i] for i in (0, 2, 3, 5, 6)]  # without means, which have no bounds
        self.assertEqual(len({len(line) for line in full}), 1)  # columns are aligned
        lines = self.do("evaluate", *codes, *FAST, "--every-level").splitlines()
        self.assertEqual(sum(line.startswith("hamiltonian-k4") for line in lines), 26)
        self.assertNotIn("--every-level", lines[-1])

    def test_writes_every_format(self):
        document = self.do_json("evaluate", "sinusoid-k4", *FAST, "-o", "e.json")
        self.assertEqual(document, json.loads(self.bytes_of("e.json")))
        self.do("evaluate", "sinusoid-k4", *FAST, "-o", "e.csv")
        self.assertEqual(len(self.bytes_of("e.csv").splitlines()), 26)
        self.do("evaluate", "sinusoid-k4", *FAST, "-o", "e.html")
        self.assertIn(b"sinusoid-k4", self.bytes_of("e.html"))

    def test_the_offered_optics_can_be_copied(self):
        command = ("evaluate", "sinusoid-k4", *FAST, "--distance", "3m", "--klux", "20")
        _, offered = shlex.split(self.refuse(command, "[optics]", code=2).splitlines()[-1])
        self.do(*command, "--set", offered)
        without_filter = offered[:offered.index(", filter_width_m")] + "}"
        error = self.refuse((*command, "--set", without_filter), "filter_width_m", code=2)
        self.do(*command, "--set", without_filter, *shlex.split(error.splitlines()[-1]))

    def test_a_missing_bound_is_an_empty_field(self):
        self.do("evaluate", "sinusoid-k3", *FAST, "--set", 'light.impulse_response={kind="none"}',
                "--set", 'sensor.impulse_response={kind="none"}', "-o", "none.csv")
        names, row, *_ = self.bytes_of("none.csv").decode().splitlines()
        fields = dict(zip(names.split(","), row.split(",")))
        self.assertEqual(fields["receiver_bound_mae_m"], "")
        self.assertEqual(fields["direct_tof_bound_mae_m"], "")
        self.assertGreater(float(fields["cramer_rao_mae_m"]), 0)

    def test_levels_that_miss_the_target_are_reported(self):
        text = self.do("evaluate", "sinusoid-k4", *FAST, "--target-standard-error", "0.1%",
                       "--max-trials", "3000")
        self.assertIn("25 of 25 operating points did not reach a standard error of 0.1 %", text)
        self.assertIn("3000 trials", text)

    def test_a_target_standard_error_of_0_is_the_default(self):
        evaluate = ("evaluate", "sinusoid-k4", *FAST)
        self.assertEqual(self.do_json(*evaluate, "--target-standard-error", "0"),
                         self.do_json(*evaluate))

    def test_the_method_is_reported(self):
        document = self.do_json("evaluate", "multifrequency-k5", *FAST, "--method", "unwrap",
                                "--unwrap-weights", "frequency")
        self.assertEqual((document["method"], document["unwrap_weights"]), ("unwrap", "frequency"))
        self.assertIn("decoded by unwrap",
                      self.do("evaluate", "sinusoid-k4", *FAST, "--method", "unwrap"))

    def test_an_infinite_bound_is_null(self):
        document = self.do_json("evaluate", "sinusoid-k3", *FAST, "--set",
                                "operating.signal_e_per_s=[1e-200]")
        self.assertIsNone(document["codes"][0]["points"][0]["cramer_rao_mae_m"])

    def test_the_distribution_of_depths_is_reported(self):
        text = self.do("evaluate", "sinusoid-k4", *FAST)
        self.assertIn("true depths anywhere in the range, decoded", text)
        near = ("--set", "operating.working_distance_m=[1, 3]")
        self.assertIn("true depths from 1 to 3 m, decoded",
                      self.do("evaluate", "sinusoid-k4", *FAST, *near))
        text = self.do("evaluate", "sinusoid-k4", *FAST, *near, "--set", "operating.depths=[1, 2]")
        self.assertIn("true depths from 1 to 3 m, distributed by 2 weights, decoded", text)

    def test_maximum_likelihood_is_compared_with_zncc(self):
        ml = ("evaluate", "hamiltonian-k5", *FAST, "--set", "operating.signal_e_per_s=[1e5]",
              "--set", "operating.ambient_e_per_s=[1e2]", "--method", "ml")
        ratio = self.do_json(*ml)["codes"][0]["zncc"]["circular_ratio"]
        text = self.do(*ml, "-o", "e.csv")
        for words in ("decoded by ml", "ml / zncc", f"{ratio:.4f}"):
            self.assertIn(words, text)
        self.assertIn(b"zncc_circular_mde_m", self.bytes_of("e.csv").splitlines()[0])
        self.do(*ml, "-o", "e.html")
        self.assertIn(b"ml / zncc", self.bytes_of("e.html"))

    def test_the_decoder_of_rows_is_a_key_of_the_camera(self):
        rows = ("evaluate", "fourier-k5", "--camera", "paper-10f0", *FAST, "--set",
                "sensor.readout=rows", "--set", "sensor.read_noise_e=0")
        whitened, plain = self.do_json(*rows), self.do_json(*rows, "--decoder", "plain")
        self.assertEqual(plain, self.do_json(*rows, "--set", "sensor.decoder=plain"))
        self.assertEqual(whitened, self.do_json(*rows, "--decoder", "whitened"))
        self.assertEqual(plain["camera"]["sensor"]["decoder"], "plain")
        self.assertGreater(plain["codes"][0]["circular"]["geometric_mean_m"],
                           whitened["codes"][0]["circular"]["geometric_mean_m"])
        self.refuse((*rows, "--decoder", "white"), "--decoder", "white", "whitened", "plain",
                    code=2)
        self.refuse((*rows, "--decoder", "plain", "--method", "ml"), "sensor.decoder", "ml")

        self.do("simulate", "wall", "--width", "40", "--height", "30", "--code", "fourier-k5",
                *rows[2:4], *rows[-4:], "--signal", "1e4", "--ambient", "1e4", "-o", "rows.npy")

        def depths(*options):
            self.do("decode", "rows.npy", *options, "-o", "depth.npy", "--force")
            return self.bytes_of("depth.npy")

        self.assertEqual(depths("--decoder", "plain"), depths("--set", "sensor.decoder=plain"))
        self.assertEqual(depths("--decoder", "whitened"), depths())
        self.assertNotEqual(depths("--decoder", "plain"), depths())

    def test_motion_is_reported_for_a_velocity(self):
        bright = ("evaluate", "sinusoid-k4", "hamiltonian-k5", *FAST, "--set",
                  "operating.signal_e_per_s=[1e5]", "--set", "operating.ambient_e_per_s=[1e3]")
        still, moving = self.do_json(*bright), self.do_json(*bright, "--velocity", "-2m/s")
        self.assertEqual(moving, self.do_json(*bright, "--set", "operating.velocity_m_per_s=-2"))
        self.assertEqual(moving["camera"]["operating"].pop("velocity_m_per_s"), -2)
        motions = [code.pop("motion") for code in moving["codes"]]
        self.assertEqual(moving, still)
        for motion in motions:
            self.assertEqual(motion["velocity_m_per_s"], -2)
            self.assertGreater(motion["rms_bias_m"], 0.01)
            self.assertEqual(len(motion["edge"]["points"]), 1)
        text = self.do(*bright, "--velocity", "-2", "-o", "e.html")
        self.assertIn("motion at -2 m/s", text)
        self.assertIn(f"{1e3 * motions[0]['rms_bias_m']:.1f}", text)
        self.assertIn(b"moves along the ray at -2 m/s", self.bytes_of("e.html"))
        self.refuse((*bright, "--velocity", "fast"), "found fast; expected a number, or one with "
                    "its unit such as 2m/s", code=2)
        self.refuse((*bright, "--velocity", "1e9"), "must be in [-1000, 1000]", code=2)

    def test_other_cameras_are_reported_for_their_number(self):
        bright = ("evaluate", "sinusoid-k4", "multifrequency-k5", *FAST, "--set",
                  "operating.signal_e_per_s=[1e6]", "--set", "operating.ambient_e_per_s=[1e3]")
        alone, lit = self.do_json(*bright), self.do_json(*bright, "--interference", "2")
        self.assertEqual(lit, self.do_json(*bright, "--set", "operating.interference.cameras=2"))
        self.assertEqual(lit["camera"]["operating"].pop("interference")["cameras"], 2)
        found = [code.pop("interference") for code in lit["codes"]]
        self.assertEqual(lit, alone)
        for code, interference in zip(lit["codes"], found):
            self.assertGreater(interference["rms_m"], 0.02)
            self.assertGreater(interference["circular"]["geometric_mean_m"],
                               code["circular"]["geometric_mean_m"])
        text = self.do(*bright, "--interference", "2", "-o", "e.html")
        self.assertIn("interference of 2 other cameras, each with 0.1 times the signal", text)
        self.assertIn(f"{1e3 * found[0]['rms_m']:.3f}", text)
        self.assertIn(b"Depth error with the light of 2 other cameras", self.bytes_of("e.html"))
        self.do(*bright, "--interference", "2", "-o", "e.csv")
        self.assertIn(b"interference_circular_mde_m", self.bytes_of("e.csv").splitlines()[0])


if __name__ == "__main__":
    unittest.main()

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""What `evaluate` prints and writes: fields, targets, methods, settings."""

import json
import unittest

import numpy as np

from command_line import CommandLineTest

FAST = ("--trials", "1000")


class Evaluate(CommandLineTest):
    def test_evaluate_keeps_its_contract(self):
        document = self.do_json("evaluate", "sinusoid-k4", "square-k4", *FAST, "--seed", "7")
        self.assertEqual(list(document), ["tofsmith", "seed", "trials", "outlier_threshold_m",
                                          "camera", "method", "codes"])
        self.assertEqual(document["method"], "zncc")
        self.assertEqual((document["seed"], document["trials"]), (7, 1000))
        self.assertEqual([c["name"] for c in document["codes"]], ["sinusoid-k4", "square-k4"])
        mean = {"geometric_mean_m", "geometric_mean_se_m", "mean_m", "mean_se_m"}
        for code in document["codes"]:
            self.assertEqual(list(code), ["name", "exposures", "taps", "measurements", "samples",
                                          "rotation_bin", "linear", "circular", "linear_rmse",
                                          "circular_rmse", "points"])
            for name in ("linear", "circular", "linear_rmse", "circular_rmse"):
                self.assertEqual(set(code[name]), mean)
            self.assertEqual(len(code["points"]), 25)
            for point in code["points"]:
                self.assertEqual(list(point), [
                    "signal_e_per_s", "ambient_e_per_s", "linear_mde_m", "linear_se_m",
                    "circular_mde_m", "circular_se_m", "linear_rmse_m", "linear_rmse_se_m",
                    "circular_rmse_m", "circular_rmse_se_m", "outlier_rate", "cramer_rao_mae_m",
                    "receiver_bound_mae_m", "direct_tof_bound_mae_m"])
                for kind in ("linear", "circular"):  # Jensen's inequality
                    self.assertLessEqual(point[f"{kind}_mde_m"], point[f"{kind}_rmse_m"])
                self.assertLessEqual(point["receiver_bound_mae_m"], point["cramer_rao_mae_m"])
                self.assertLessEqual(point["direct_tof_bound_mae_m"],
                                     point["receiver_bound_mae_m"])

    def test_evaluate_meets_a_target(self):
        for target in ("5%", "0.05"):
            document = self.do_json("evaluate", "sinusoid-k4", *FAST, "--target-standard-error",
                                    target)
            self.assertEqual(document["target_standard_error"], 0.05)
            code = document["codes"][0]
            self.assertEqual(code["points_short_of_target"], 0)
            for point in code["points"]:
                self.assertLessEqual(point["linear_se_m"], 0.05 * point["linear_mde_m"])
                self.assertGreaterEqual(point["trials"], document["trials"])
        text = self.do("evaluate", "sinusoid-k4", *FAST, "--target-standard-error", "0.1%",
                       "--max-trials", "3000")
        self.assertIn("25 of 25 operating points stay short of a standard error of 0.1 %", text)
        self.assertIn("3000 trials", text)

    def test_evaluate_prints_the_mean_first_and_every_level_if_asked(self):
        codes = ("sinusoid-k4", "hamiltonian-k4")
        points = {code["name"]: [point["linear_mde_m"] for point in code["points"]]
                  for code in self.do_json("evaluate", *codes, *FAST)["codes"]}
        lines = self.do("evaluate", *codes, *FAST).splitlines()
        self.assertEqual([line.split()[2] for line in lines[1:7]], ["mean", "best", "worst"] * 2)
        for code, first in zip(codes, (1, 4)):
            for line, error_m in ((first + 1, min(points[code])), (first + 2, max(points[code]))):
                self.assertIn(code, lines[line])
                self.assertAlmostEqual(float(lines[line].split()[5]) / error_m, 1e3, delta=1)
        self.assertIn("all 25 light levels of the camera (S = 1e+03 .. 1e+05, A = 100 .. 1e+05 e/s): --every-level", "\n".join(lines))
        full = [lines[i] for i in (0, 2, 3, 5, 6)]  # without means, which have no bounds
        self.assertEqual(len({len(line) for line in full}), 1)  # columns stand below each other
        lines = self.do("evaluate", *codes, *FAST, "--every-level").splitlines()
        self.assertEqual(sum(line.startswith("hamiltonian-k4") for line in lines), 26)
        self.assertNotIn("--every-level", lines[-1])

    def test_evaluate_writes_every_format(self):
        document = self.do_json("evaluate", "sinusoid-k4", *FAST, "-o", "e.json")
        self.assertEqual(document, json.loads(self.bytes_of("e.json")))
        self.do("evaluate", "sinusoid-k4", *FAST, "-o", "e.csv")
        self.assertEqual(len(self.bytes_of("e.csv").splitlines()), 26)
        self.do("evaluate", "sinusoid-k4", *FAST, "-o", "e.html")
        self.assertIn(b"sinusoid-k4", self.bytes_of("e.html"))

    def test_evaluate_judges_robustness(self):
        few = ("--trials", "200", "--set", "samples=60", "--robustness")
        entry = self.do_json("evaluate", "sinusoid-k4", *few)["codes"][0]["robustness"]
        self.assertEqual([p["name"] for p in entry["perturbations"]],
                         ["bandwidth -20 %", "bandwidth +20 %", "peak power -10 %",
                          "peak power +10 %", "edge jitter 50 ps", "tap mismatch 2 %"])
        self.assertGreaterEqual(entry["worst_uncalibrated"]["ratio"], 1)
        self.assertIn("uncalibrated (mm)",
                      self.do("evaluate", "sinusoid-k4", *few, "-o", "r.html"))
        self.assertIn(b"Robustness", self.bytes_of("r.html"))

    def test_jitter_and_mismatch_are_settings(self):
        jitter = ("--set", "light.edge_jitter_s=5e-9", "--set", "sensor.tap_mismatch=0.1")
        document = self.do_json("evaluate", "sinusoid-k4", *FAST, *jitter)
        self.assertEqual(document["camera"]["light"]["edge_jitter_s"], 5e-9)
        self.assertEqual(document["camera"]["sensor"]["tap_mismatch"], 0.1)

    def test_a_bound_that_is_none_is_an_empty_field(self):
        self.do("evaluate", "sinusoid-k3", *FAST, "--set", 'light.impulse_response={kind="none"}',
                "--set", 'sensor.impulse_response={kind="none"}', "-o", "none.csv")
        names, row, *_ = self.bytes_of("none.csv").decode().splitlines()
        fields = dict(zip(names.split(","), row.split(",")))
        self.assertEqual(fields["receiver_bound_mae_m"], "")
        self.assertEqual(fields["direct_tof_bound_mae_m"], "")
        self.assertGreater(float(fields["cramer_rao_mae_m"]), 0)

    def test_an_infinite_bound_is_null(self):
        document = self.do_json("evaluate", "sinusoid-k3", *FAST, "--set",
                                "operating.signal_e_per_s=[1e-200]")
        self.assertIsNone(document["codes"][0]["points"][0]["cramer_rao_mae_m"])

    def test_settings_change_the_camera(self):
        document = self.do_json("evaluate", "sinusoid-k4", *FAST, "--set", "sensor.taps=2",
                                "--set", "sensor.readout=difference", "--set",
                                "sensor.noise=poisson", "--set", "light.peak_factor=5")
        sensor = document["camera"]["sensor"]
        self.assertEqual((sensor["taps"], sensor["readout"], sensor["noise"]),
                         (2, "difference", "poisson"))
        self.assertEqual(document["camera"]["light"]["peak_factor"], 5)
        code = document["codes"][0]
        self.assertEqual((code["taps"], code["exposures"], code["measurements"]), (2, 4, 4))
        separate = self.do_json("evaluate", "sinusoid-k4", *FAST, "--set", "sensor.taps=2")
        self.assertEqual(separate["codes"][0]["measurements"], 8)

    def test_the_depths_that_are_judged_are_told(self):
        text = self.do("evaluate", "sinusoid-k4", *FAST)
        self.assertIn("true depths anywhere in the range, decoded", text)
        near = ("--set", "operating.working_distance_m=[1, 3]")
        self.assertIn("true depths from 1 to 3 m, decoded",
                      self.do("evaluate", "sinusoid-k4", *FAST, *near))
        text = self.do("evaluate", "sinusoid-k4", *FAST, *near, "--set", "operating.depths=[1, 2]")
        self.assertIn("true depths from 1 to 3 m, as often as 2 weights say, decoded", text)

    def test_sinusoids_are_unwrapped(self):
        codes = ("sinusoid-k4", "multifrequency-k5")
        zncc = self.do_json("evaluate", *codes, *FAST)
        unwrap = self.do_json("evaluate", *codes, *FAST, "--method", "unwrap")
        self.assertEqual((unwrap["method"], unwrap["unwrap_weights"]), ("unwrap", "variance"))
        errors = [[code["circular"]["geometric_mean_m"] for code in document["codes"]]
                  for document in (zncc, unwrap)]
        # The same decoder, on noise of its own.
        deviation = np.hypot(*(document["codes"][0]["circular"]["geometric_mean_se_m"]
                               for document in (zncc, unwrap)))
        self.assertLess(abs(errors[0][0] - errors[1][0]), 4 * deviation)
        self.assertNotEqual(errors[0][1], errors[1][1])
        classical = self.do_json("evaluate", *codes, *FAST, "--method", "unwrap",
                                 "--unwrap-weights", "frequency")["codes"][1]
        self.assertGreater(classical["circular"]["geometric_mean_m"], 1.1 * errors[1][1])
        self.assertIn("decoded by unwrap",
                      self.do("evaluate", "sinusoid-k4", *FAST, "--method", "unwrap"))

    def test_maximum_likelihood_stands_beside_zncc(self):
        light = (*FAST, "--set", "operating.signal_e_per_s=[1e5]", "--set",
                 "operating.ambient_e_per_s=[1e2]")
        zncc = self.do_json("evaluate", "hamiltonian-k5", *light)["codes"][0]
        document = self.do_json("evaluate", "hamiltonian-k5", *light, "--method", "ml")
        self.assertEqual(document["method"], "ml")
        ml = document["codes"][0]
        # Beside another method zncc sees its noise, which is not that of zncc alone.
        beside, alone = ml["zncc"]["circular"], zncc["circular"]
        self.assertLess(abs(beside["geometric_mean_m"] - alone["geometric_mean_m"]),
                        4 * np.hypot(beside["geometric_mean_se_m"], alone["geometric_mean_se_m"]))
        self.assertAlmostEqual(ml["zncc"]["circular_ratio"], ml["circular"]["geometric_mean_m"] /
                               beside["geometric_mean_m"])
        self.assertLess(ml["zncc"]["circular_ratio"], 1)
        text = self.do("evaluate", "hamiltonian-k5", *light, "--method", "ml")
        for words in ("decoded by ml", "ml / zncc", f"{ml['zncc']['circular_ratio']:.4f}"):
            self.assertIn(words, text)
        self.do("evaluate", "hamiltonian-k5", *light, "--method", "ml", "-o", "e.csv")
        self.assertIn(b"zncc_circular_mde_m", self.bytes_of("e.csv").splitlines()[0])
        self.do("evaluate", "hamiltonian-k5", *light, "--method", "ml", "-o", "e.html")
        self.assertIn(b"ml / zncc", self.bytes_of("e.html"))

    def test_threads_do_not_change_figures(self):
        one, two = (self.do("evaluate", "hamiltonian-k4", *FAST, "--best-rotation", "--json",
                            "--threads", threads) for threads in "12")
        self.assertEqual(one, two)


if __name__ == "__main__":
    unittest.main()

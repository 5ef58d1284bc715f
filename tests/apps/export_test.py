# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Export of waveforms."""

import unittest

import numpy as np

from command_line import CommandLineTest

QUICK = ("--trials", "200")


class Export(CommandLineTest):
    def test_scripts_are_exported_with_the_tables(self):
        text = self.do("export", "hamiltonian-k3", "--format", "tek-tfw", "--samples", "16",
                       "--periods", "4", "-o", "d", *QUICK)
        self.assertIn("wrote 6 files of tek-tfw, 3 SCPI scripts, manifest.json and report.html", text)
        script = self.bytes_of("d/AFG3022_exposure_2.scpi.txt").decode()
        self.assertRegex(script, r"^# TEKTRONIX AFG3022, AFG3052, AFG3102, AFG3152, AFG3252; ")

    def test_harmful_limits_are_reported(self):
        text = self.do("export", "hamiltonian-k5", "--format", "csv", "--rate", "360e6",
                       "--edge-grid", "2.777777777777778e-9", "-o", "w.csv", *QUICK)
        self.assertIn("edge shift (ns)", text)
        self.assertIn("uncalibrated (mm)", text)
        self.assertIn("wrote w.csv", text)
        rows = np.genfromtxt(self.path("w.csv"), delimiter=",", names=True)
        self.assertEqual(len(rows), 24)

    def test_an_unsupported_sample_rate_is_reported(self):
        def notes(name, *more):
            return self.do_json("export", "hamiltonian-k3", "--format", name, "-o", "d", "--force",
                                "--no-loss", *more)["notes"]
        (note,) = notes("csv")
        for words in ("3600 MHz", "2400 MHz", "--rate 2.4e+09"):
            self.assertIn(words, note)
        rate, script = notes("keysight-arb")
        self.assertIn("1000 MHz", rate)
        self.assertIn("no SCPI script was written: modulation_1 sample_rate_hz", script)
        script, duty = notes("siglent-csv", "--rate", "1.2e9")
        self.assertIn("no supported generator with two channels reads siglent-csv", script)
        self.assertIn("the duty of modulation 1 is 0.1625 instead of 0.1667", duty)
        self.assertEqual(notes("csv", "--rate", "3.6e9"), [])  # explicitly requested rates are not
                                                               # questioned
        self.assertEqual(notes("csv", "--samples", "120"), [])
        (duty,) = notes("csv", "--camera", "prototype")  # no note about its sample rate
        self.assertNotIn("sample rate", duty)
        self.assertIn("note: " + note, self.do("export", "hamiltonian-k3", "--format", "csv", "-o",
                                               "d", "--force", "--no-loss"))

    def test_a_grid_that_changes_a_duty_is_reported_with_alternatives(self):
        def notes(*more):
            return self.do_json("export", "hamiltonian-k4", "--format", "keysight-arb", "-o", "d",
                                "--force", "--no-loss", *more)["notes"]
        (note,) = notes("--samples", "64")
        self.assertEqual(note, "with 64 points per period, the duty of modulation 1 is 0.07812 "
                               "instead of 0.08333; --samples 60 or --samples 72 would preserve all duties")
        self.refuse(["export", "hamiltonian-k4", "--format", "keysight-arb", "--rate", "100e6", "-o",
                     "e"], "points are 1/6 of a period; expected 12 points or more, 180 MHz")
        self.assertEqual(notes("--samples", "60"), [])
        (note,) = notes("--samples", "72", "--rate", "1.08e9")  # preserves the duties, but exceeds
                                                                # the sample rate
        self.assertIn("no SCPI script was written: modulation_1 sample_rate_hz = 1.08e+09; must be "
                      "at most 1e+09, the limit of 33622", note)

    def test_wrong_usage(self):
        for arguments, code, words in (
                (["--format", "tek-wmf", "-o", "d"], 2, ["tek-wfm", "did you mean tek-wfm?"]),
                (["--format", "tek-tfw", "--samples", "999999", "-o", "d"], 1, ["131072"]),
                (["--format", "tek-tfw", "--bits", "99", "-o", "d"], 1, ["bits = 99", "[1, 14]"]),
                (["--format", "tek-wfm", "--samples", "301", "--periods", "1", "-o", "d"], 1,
                 ["points = 301", "multiples of 4"]),
                (["--format", "keysight-arb", "-o", "one.arb"], 2,
                 ["one waveform per file", "expected a directory"]),
                (["--format", "intel-mif", "-o", "p.coe"], 2, ["expected .mif"]),
                (["--format", "csv", "--rate", "-1", "-o", "d"], 2, ["--rate"]),
                (["--format", "csv"], 2, ["--output"]),
                (["-o", "d"], 2, ["--format"])):
            self.refuse(["export", "hamiltonian-k3", *arguments], *words, code=code)
        self.write("p.mem", "mine")
        self.refuse(["export", "hamiltonian-k3", "--format", "verilog-mem", "-o", "p.mem", *QUICK],
                    "p.mem", "--force")
        self.do("export", "hamiltonian-k3", "--format", "verilog-mem", "-o", "d", *QUICK)
        self.refuse(["export", "hamiltonian-k3", "--format", "verilog-mem", "-o", "d", *QUICK],
                    "pattern.mem", "--force")
        self.do("export", "hamiltonian-k3", "--format", "verilog-mem", "-o", "d", "--force", *QUICK)


if __name__ == "__main__":
    unittest.main()

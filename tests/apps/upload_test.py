# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""tofsmith upload plays codes on a simulated generator, refuses what does not fit, and stops with
outputs off.

upload_test.py TOOL SIMULATED_GENERATOR"""

import json
import os
import signal
import socket
import subprocess
import sys
import unittest

from command_line import CommandLineTest

GENERATOR = os.path.abspath(sys.argv.pop(1))
CODE = ("upload", "hamiltonian-k3", "--set", "samples=60")


class Upload(CommandLineTest):
    def generator(self, *arguments):
        process = subprocess.Popen([GENERATOR, *arguments], stdin=subprocess.PIPE,
                                   stdout=subprocess.PIPE, text=True)

        def end():
            process.stdin.close()
            process.wait(timeout=60)
            process.stdout.close()

        self.addCleanup(end)
        return process, "127.0.0.1:" + process.stdout.readline().strip()

    def test_every_family_plays_and_verifies(self):
        for family, model, more in (("siglent", "SDG6022X", ("--samples", "500")),
                                    ("keysight", "33622A", ("--periods", "1")),
                                    ("tektronix", "AFG3252C", ("--samples", "100"))):
            process, address = self.generator(family, model)
            report = self.do_json(*CODE, "--instrument", address, "--output-on", *more)
            self.assertTrue(report["verified"], report["message"])
            self.assertEqual(report["instrument"]["model"], model)
            light, sensor = report["channels"]
            self.assertEqual((light["plays"], sensor["plays"]), ("modulation_1", "demodulation_1"))
            self.assertAlmostEqual(light["numbers"]["amplitude_vpp"]["read_back"], 1.0, places=3)
            self.assertEqual(process.stdout.readline(),
                             f"outputs 1 1 points {light['points']} {sensor['points']} "
                             f"waveforms {3 if family == 'tektronix' else 2}\n")

    def test_all_pairs_are_loaded_and_one_is_played_with_outputs_off(self):
        process, address = self.generator("keysight", "33522B")
        text = self.do(*CODE, "--instrument", "tcp://" + address, "--all", "--exposure", "3",
                       "--volts", "0,2", "--load", "inf")
        self.assertIn("modulation_3", text)
        self.assertIn("all points and settings read back and equal", text)
        self.assertIn("Outputs are off", text)
        self.assertRegex(process.stdout.readline(), r"^outputs 0 0 points \d+ \d+ waveforms 6\n")

    def test_points_that_are_not_read_back_are_unverified(self):
        _, address = self.generator("keysight", "33522B")
        report = self.do_json(*CODE, "--instrument", address, "--no-read-back")
        self.assertFalse(report["verified"])
        self.assertIn("unverified", report["message"])

    def test_a_dry_run_connects_to_nothing(self):
        text = self.do(*CODE, "--dry-run", "--model", "SDG2042X")
        self.assertRegex(text, r"\nC1:WVDT WVNM,M1_[0-9A-F]{7},FREQ,.*WAVEDATA,<\d+ bytes>")
        self.assertNotIn("OUTP ON", text)
        report = self.do_json(*CODE, "--dry-run", "--model", "33522", "--output-on")
        self.assertIn("OUTP2 ON", [m["message"] for m in report["messages"]])

    def test_usage(self):
        for arguments, word in ((CODE, "--instrument"), ((*CODE, "--dry-run"), "--model"),
                                ((*CODE, "--instrument", "http://x"), "tcp://host:port"),
                                ((*CODE, "--instrument", "x", "--model", "SDG1"), "must be one of"),
                                ((*CODE, "--dry-run", "--model", "33522", "--exposure", "4"),
                                 "expected at most 3")):
            self.refuse(arguments, word, code=2)

    def test_an_absent_instrument(self):
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            port = probe.getsockname()[1]
        self.refuse((*CODE, "--instrument", f"127.0.0.1:{port}"),
                    f"tcp://127.0.0.1:{port}: cannot connect", "Connection refused")

    def test_a_wrong_model_and_too_small_a_one(self):
        process, address = self.generator("keysight", "34465A")
        self.refuse((*CODE, "--instrument", address), "found the instrument 34465A of Keysight")
        self.assertEqual(process.stdout.readline(), "outputs 1 1 points 0 0 waveforms 0\n")
        _, address = self.generator("tektronix", "AFG3021B")
        self.refuse((*CODE, "--instrument", address), "channel = 2; must be in [1, 1]")
        _, address = self.generator("siglent", "SDG1032X")
        self.refuse((*CODE, "--instrument", address, "--samples", "20000"),
                    "points = 20000; must be in [8, 16384]")

    def test_a_hanging_instrument_and_an_interrupt(self):
        _, address = self.generator("tektronix", "AFG3022C", "hangs", "0")
        self.refuse((*CODE, "--instrument", address, "--timeout", "0.2"),
                    "sent '*IDN?': no answer within 0.2 s")
        process, address = self.generator("tektronix", "AFG3252C", "hangs", "12")
        upload = self.start(*CODE, "--instrument", address, "--timeout", "600", "--samples", "100",
                            "--output-on")
        with self.assertRaises(subprocess.TimeoutExpired):
            upload.communicate(timeout=2)
        upload.send_signal(signal.SIGINT)
        out, error = upload.communicate(timeout=60)
        self.assertEqual((upload.returncode, out, error), (130, b"", b"tofsmith: interrupted\n"))
        self.assertTrue(process.stdout.readline().startswith("outputs 0 0 "))


if __name__ == "__main__":
    unittest.main()

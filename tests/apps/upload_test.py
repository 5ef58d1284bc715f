# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""tofsmith upload sends codes to a simulated generator, rejects unsuitable requests, and leaves
outputs off when stopped. Faults are tested in tests/python/test_instruments.py.

    upload_test.py TOOL
"""

import os
import socket
import sys
import time
import unittest
import unittest.mock
from pathlib import Path

from command_line import CommandLineTest

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from simulated_generator import SimulatedGenerator  # noqa: E402

CODE = ("upload", "hamiltonian-k3", "--set", "samples=60")


class Upload(CommandLineTest):
    def test_outputs_are_verified(self):
        with SimulatedGenerator("siglent", "SDG6022X") as generator:
            report = self.do_json(*CODE, "--instrument", generator.address, "--output-on",
                                  "--samples", "500")
        self.assertTrue(report["verified"], report["message"])
        self.assertEqual(report["instrument"]["model"], "SDG6022X")
        light, sensor = report["channels"]
        self.assertEqual((light["waveform"], sensor["waveform"]), ("modulation_1", "demodulation_1"))
        self.assertAlmostEqual(light["numbers"]["amplitude_vpp"]["read_back"], 1.0, places=3)
        for n, channel in enumerate((light, sensor), 1):
            self.assertTrue(generator.is_on(n))
            self.assertEqual(len(generator.played(n)), 2 * channel["points"])

    def test_all_pairs_are_loaded_and_one_is_selected_with_outputs_off(self):
        with SimulatedGenerator("keysight", "33522B") as generator:
            text = self.do(*CODE, "--instrument", "tcp://" + generator.address, "--all",
                           "--exposure", "3", "--volts", "0,2", "--load", "inf")
        self.assertIn("modulation_3", text)
        self.assertIn("all points and settings read back and equal", text)
        self.assertIn("Outputs are off", text)
        self.assertFalse(generator.is_on(1) or generator.is_on(2))
        self.assertEqual(len(generator.memory), 6)

    def test_points_without_read_back_are_unverified(self):
        with SimulatedGenerator("keysight", "33522B") as generator:
            report = self.do_json(*CODE, "--instrument", generator.address, "--no-read-back")
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
                                 "must be at most 3")):
            self.refuse(arguments, word, code=2)

    def test_an_absent_instrument(self):
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            port = probe.getsockname()[1]
        self.refuse((*CODE, "--instrument", f"127.0.0.1:{port}", "--timeout", "1"),
                    f"TCPIP::127.0.0.1::{port}::SOCKET", "check the address")

    def test_a_wrong_model(self):
        with SimulatedGenerator("keysight", "34465A") as generator:
            self.refuse((*CODE, "--instrument", generator.address),
                        "found the instrument 34465A of Keysight")
        self.assertTrue(generator.is_on(1) and generator.is_on(2))

    def test_a_hanging_instrument_and_an_interrupt(self):
        with SimulatedGenerator("tektronix", "AFG3022C", "hangs") as generator:
            self.refuse((*CODE, "--instrument", generator.address, "--timeout", "0.2"),
                        "sent '*IDN?': no answer within 0.2 s")
        with SimulatedGenerator("tektronix", "AFG3252C", "hangs", 12) as generator:
            upload = self.start(*CODE, "--instrument", generator.address, "--timeout", "600",
                                "--samples", "100", "--output-on")
            deadline = time.monotonic() + 60
            while generator.messages < 12 and time.monotonic() < deadline:
                time.sleep(0.05)
            self.assertIsNone(upload.poll())
            self.assertEqual(self.interrupted(upload), "tofsmith: interrupted\n")
        self.assertFalse(generator.is_on(1) or generator.is_on(2))

    def test_missing_packages_are_reported(self):
        without_package = self.path(self.write("python", '#!/bin/sh\nexec /usr/bin/python3 -I "$@"\n'))
        os.chmod(without_package, 0o755)
        for interpreter, words in (("/nowhere/python3", "/nowhere/python3: cannot be started"),
                                   (without_package, "apt install python3-tofsmith")):
            with unittest.mock.patch.dict(os.environ, TOFSMITH_PYTHON=interpreter):
                self.refuse((*CODE, "--instrument", "127.0.0.1:1"), words)


if __name__ == "__main__":
    unittest.main()

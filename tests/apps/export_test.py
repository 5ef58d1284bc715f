# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Export of waveforms, and decoding of dumps that a file describes, as a user meets them."""

import hashlib
import json
import unittest

import numpy as np

from command_line import CommandLineTest

QUICK = ("--trials", "200")
FORMATS = ("siglent-csv", "siglent-wvdt14", "siglent-wvdt16", "keysight-arb", "tek-tfw", "tek-wfm",
           "xilinx-coe", "intel-mif", "verilog-mem", "systemverilog", "vhdl", "c-header", "csv")


class Export(CommandLineTest):
    def test_every_format_gives_all_pairs_a_manifest_and_a_report(self):
        for name in FORMATS:
            document = self.do_json("export", "hamiltonian-k5", "--format", name, "-o", name,
                                    *QUICK)
            with open(self.path(f"{name}/manifest.json"), encoding="utf-8") as file:
                manifest = json.load(file)
            self.assertEqual(document["manifest"], manifest)
            waveforms = []
            for entry in manifest["files"]:
                content = self.bytes_of(f"{name}/{entry['file']}")
                self.assertEqual(len(content), entry["bytes"])
                self.assertEqual(hashlib.sha256(content).hexdigest(), entry["sha256"])
                waveforms += [w["name"] for w in entry["waveforms"]]
            self.assertEqual(sorted(waveforms),
                             sorted(f"{arm}modulation_{i}" for arm in ("", "de")
                                    for i in range(1, 6)), name)
            self.assertIn(b"</html>", self.bytes_of(f"{name}/report.html"))

    def test_one_file_holds_what_the_limits_leave(self):
        document = self.do_json("export", "hamiltonian-k3", "--format", "verilog-mem", "--samples",
                                "12", "-o", "p.mem", *QUICK)
        words = [int(line, 16) for line in self.bytes_of("p.mem").decode().splitlines()
                 if not line.startswith("//")]
        self.assertEqual(len(words), 3 * 12)
        light = [word & 1 for word in words[:12]]
        self.assertEqual(sum(light), 2)  # a pulse of 1/6 of the period
        self.assertEqual([word >> 2 for word in words[:12]], [1] * 6 + [0] * 6)
        self.assertAlmostEqual(document["depth_error"]["actual_over_nominal"], 1.0, places=6)
        self.assertEqual(len(document["generators"]), 6)

    def test_limits_that_hurt_are_reported(self):
        text = self.do("export", "hamiltonian-k5", "--format", "csv", "--rate", "360e6",
                       "--edge-grid", "2.777777777777778e-9", "-o", "w.csv", *QUICK)
        self.assertIn("edge move (ns)", text)
        self.assertIn("uncalibrated (mm)", text)
        self.assertIn("wrote w.csv", text)
        rows = np.genfromtxt(self.path("w.csv"), delimiter=",", names=True)
        self.assertEqual(len(rows), 24)

    def test_a_rate_that_nothing_plays_is_reported(self):
        def notes(name, *more):
            return self.do_json("export", "hamiltonian-k3", "--format", name, "-o", "d", "--force",
                                "--no-loss", *more)["notes"]
        (note,) = notes("csv")
        for words in ("3600 MHz", "2400 MHz", "--rate 2.4e+09"):
            self.assertIn(words, note)
        self.assertIn("1000 MHz", notes("keysight-arb")[0])
        self.assertEqual(notes("csv", "--rate", "3.6e9"), [])  # whoever says so has one
        self.assertEqual(notes("csv", "--samples", "120"), [])
        (duty,) = notes("csv", "--camera", "prototype")  # nothing of its rate
        self.assertNotIn("sample rate", duty)
        self.assertIn("note: " + note, self.do("export", "hamiltonian-k3", "--format", "csv", "-o",
                                               "d", "--force", "--no-loss"))

    def test_a_grid_that_changes_a_duty_is_reported_with_those_that_do_not(self):
        def notes(*more):
            return self.do_json("export", "hamiltonian-k4", "--format", "keysight-arb", "-o", "d",
                                "--force", "--no-loss", *more)["notes"]
        (note,) = notes("--samples", "64")
        self.assertEqual(note, "on 64 points a period the duty of modulation 1 is 0.07812 in place "
                               "of 0.08333; --samples 60 or --samples 72 would keep all duties")
        self.refuse(["export", "hamiltonian-k4", "--format", "keysight-arb", "--rate", "100e6", "-o",
                     "e"], "points are 1/6 of a period; 12 points or more, 180 MHz, can")
        self.assertEqual(notes("--samples", "60"), [])
        self.assertEqual(notes("--samples", "72", "--rate", "1.08e9"), [])

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
                (["--format", "csv", "--edge-grid", "1", "-o", "d"], 1, ["edge_grid_s"]),
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


DESCRIPTION = """width = 12
height = 5
measurements = 3
bits = 16
signed = true
header_bytes = 10
flip_rows = true
order = [2, 0, 1]
"""


class RawFormats(CommandLineTest):
    def record(self, frames=2):
        """Counts (F, H, W, K), as raw.npy and as the dump that DESCRIPTION describes."""
        np.save(self.path("scene.npy"),
                np.linspace(1, 4, 5 * 12).reshape(5, 12).astype(np.float32))
        self.do("simulate", "scene.npy", "--kind", "radial", "--code", "hamiltonian-k3",
                "--signal", "1e5", "--no-falloff", "--frames", str(frames), "-o", "sim.npy")
        raw = np.load(self.path("sim.npy")).reshape(frames, 5, 12, 3).astype("<i2")
        np.save(self.path("raw.npy"), raw)
        planes = raw[:, ::-1].transpose(0, 3, 1, 2)[:, [2, 0, 1]]
        self.write("dump.bin", b"0123456789" + planes.tobytes())
        self.write("s.raw.toml", DESCRIPTION)
        return raw

    def test_a_dump_decodes_as_the_array_it_holds(self):
        self.record()
        rest = ["--code", "hamiltonian-k3", "--stack"]
        self.do("decode", "raw.npy", *rest, "-o", "a.npy")
        for more in ([], ["--memory-mb", "0.002"]):
            self.do("decode", "dump.bin", "--raw-format", "s.raw.toml", *rest, *more, "--force",
                    "-o", "b.npy")
            np.testing.assert_array_equal(np.load(self.path("a.npy")),
                                          np.load(self.path("b.npy")))

    def test_refusals(self):
        self.record(frames=1)
        decode = ["decode", "dump.bin", "--code", "hamiltonian-k3", "-o", "d.npy", "--raw-format"]
        self.write("bad.raw.toml", DESCRIPTION + "colour = 1\n")
        self.refuse([*decode, "bad.raw.toml"], "bad.raw.toml:9:1", "colour")
        self.write("bad.raw.toml", DESCRIPTION + "flip_row = true\n")
        self.refuse([*decode, "bad.raw.toml"], "did you mean flip_rows?")
        self.refuse([*decode, "missing.raw.toml"], "missing.raw.toml")
        self.refuse([*decode, "s.raw.toml", "--layout", "planar"], "--layout", code=2)
        self.refuse(["decode", "dump.bin", "--raw-format", "s.raw.toml", "--code", "hamiltonian-k4",
                     "-o", "d.npy"], "3 measurements", "expected 4")
        with open(self.path("dump.bin"), "ab") as file:
            file.write(b"x")
        self.refuse([*decode, "s.raw.toml"], "371 bytes", "360 bytes per frame", "1 bytes are left")


if __name__ == "__main__":
    unittest.main()

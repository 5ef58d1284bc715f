# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Wrong inputs, and words of the answer that name the cause: one row per mistake of a new user."""

import os
import shlex
import unittest

import numpy as np

from command_line import CommandLineTest

CAMERA = "fundamental_frequency_hz = 20e6\n"
DUMP = "width = 4\nheight = 2\nmeasurements = 4\nbits = 12\n"

FILES = {
    "good.toml": CAMERA,
    "lens.toml": CAMERA + "[lens]\nfx_px = 300\nfy_px = 300\ncx_px = 3.5\ncy_px = 2.5\n",
    "unit.toml": "fundamental_frequency_hz = 20 MHz\n",
    "comma.toml": CAMERA + "exposure_s = 0,02\n",
    "word.toml": CAMERA + "[sensor]\nreadout = difference\n",
    "binary.toml": b"\x7fELF\x02\x01\x01\x00\x00",
    "typo.toml": "fundamental_freqency_hz = 20e6\n",
    "ms.toml": CAMERA + "exposure_ms = 20\n",
    "table.toml": "[light\n",
    "twice.toml": CAMERA + CAMERA,
    "text.toml": 'fundamental_frequency_hz = "fast"\n',
    "negative.toml": CAMERA + "exposure_s = -1\n",
    "half_lens.toml": CAMERA + "[lens]\nfx_px = 300\n",
    "kind.toml": CAMERA + '[light]\nimpulse_response = { kind = "gauss" }\n',
    "taps.toml": CAMERA + "[sensor]\ntaps = 2.5\n",
    "empty.toml": "",
    "d.raw.toml": DUMP,
    "big.raw.toml": DUMP + 'byte_order = "big"\n',
    "high.raw.toml": DUMP + 'align = "high"\n',
    "short.raw.toml": DUMP.replace("height = 2", "height = 3"),
    "three.raw.toml": DUMP.replace("measurements = 4", "measurements = 2").replace("height = 2",
                                                                                 "height = 4"),
    "packing.raw.toml": DUMP + 'packing = "raw12"\n',
    "s.toml": "[[sphere]]\ncentre_m = [0, 0, 2]\nradius = 1\n",
    "sweep.toml": f'camera = "{"A" * 300}"\ncodes = ["sinusoid-k4"]\n',
    "c.code.json": "{}",
    "note.txt": "hello\n",
}

# Command | words of the answer, separated by ";". The exit code is 1, or 2 for wrong usage.
WRONG = """
decode raw.npy --code sinusoid-k5 -o d.npy | 4 measurements; expected 5
decode raw.npy --code sinus-k4 -o d.npy | sinus-k4; sinusoid-k4
decode raw.npy -o d.npy | --code is required; raw.code.json
decode raw.npy --code sinusoid-k4 | --output
require paper-10f0 --error 5mm --distance 3m --klux 20 | [optics]; --set 'optics = {; filter_width_m = 30e-9
decode raw.npy --code sinusoid-k4 -o d | .npz
decode raw.npy --code sinusoid-k4 -o d.ply | --view-deg; [lens]
decode raw.npy --code sinusoid-k4 --kind z -o d.npy | --view-deg; [lens]
decode raw.npy --code sinusoid-k4 --view-deg 200 -o d.ply | --view-deg; found 200
decode raw.npy --code sinusoid-k4 --order 0,1,2 -o d.npy | order
decode raw.npy --code sinusoid-k4 --order 0,0,1,2 -o d.npy | order
decode raw.npy --code sinusoid-k4 --layout planar -o d.npy | raw.npy
decode raw.npy --code sinusoid-k4 --camera absent.toml -o d.npy | absent.toml
decode raw.npy --code sinusoid-k4 --camera paper-10fo -o d.npy | did you mean paper-10f0?
decode raw.npy --code sinusoid-k4 --outputs amplitudes -o d.npz | amplitudes; signal
decode raw.npy --code sinusoid-k4 --outputs signal -o d.npy | only depth
decode raw.npy --code sinusoid-k4 --filter medium -o d.npy | medium; normal
decode raw.npy --code sinusoid-k4 --frame 3 -o d.npy | --frame; 1 frame
decode raw.npy --code sinusoid-k4 --average 2 -o d.npy | --average; 1 frame
decode raw.npy --code sinusoid-k4 --offset-m 2kg -o d.npy | found 2kg; expected a number
decode raw.npy --code sinusoid-k4 --undistort -o d.npy | [lens]
decode raw.npy --code sinusoid-k4 --time-filter 0 -o d.npy | found 0
decode raw.npy --code c.code.json -o d.npy | c.code.json
decode raw.npy --code note.txt -o d.npy | note.txt
decode note.txt --code sinusoid-k4 -o d.npy | note.txt
decode bool.npy --code sinusoid-k4 -o d.npy | bool
decode flat.npy --code sinusoid-k4 -o d.npy | shape (2, 4)
decode d.bin --code sinusoid-k4 -o d.npy | --raw-format
decode d.bin --code sinusoid-k4 --raw-format big.raw.toml -o d.npy | read as big-endian; byte_order = "little"
decode d.bin --code sinusoid-k4 --raw-format high.raw.toml -o d.npy | high bits; align = "low"
decode d.bin --code sinusoid-k4 --raw-format short.raw.toml -o d.npy | found 64 bytes
decode d.bin --code sinusoid-k4 --raw-format three.raw.toml -o d.npy | 2 measurements
decode d.bin --code sinusoid-k4 --raw-format packing.raw.toml -o d.npy | raw12; mipi
decode d.bin --code sinusoid-k4 --raw-format note.txt -o d.npy | note.txt:1
decode - --code sinusoid-k4 -o d.npy | -o -
evaluate | CODE
evaluate sinusoid-k4 --camera unit.toml | unit.toml:1; needs quotes
evaluate sinusoid-k4 --camera comma.toml | comma.toml:2; decimals have a point
evaluate sinusoid-k4 --camera word.toml | word.toml:3; readout = "difference"
evaluate sinusoid-k4 --camera binary.toml | binary file
evaluate sinusoid-k4 --camera typo.toml | typo.toml:1; did you mean fundamental_frequency_hz?
evaluate sinusoid-k4 --camera ms.toml | did you mean exposure_s, in s?
evaluate sinusoid-k4 --camera table.toml | table.toml:1
evaluate sinusoid-k4 --camera twice.toml | twice.toml:2
evaluate sinusoid-k4 --camera text.toml | found "fast"; expected a number
evaluate sinusoid-k4 --camera negative.toml | exposure_s = -1
evaluate sinusoid-k4 --camera half_lens.toml | lens.fy_px
evaluate sinusoid-k4 --camera kind.toml | "gauss"; "gaussian"
evaluate sinusoid-k4 --camera taps.toml | sensor.taps; expected an integer
evaluate sinusoid-k4 --camera empty.toml | found no fundamental_frequency_hz
evaluate sinusoid-k4 --camera raw.npy | raw.npy
evaluate sinusoid-k4 --set light.peak_factr=5 | did you mean light.peak_factor?
evaluate sinusoid-k4 --set peak_factor=5 | peak_factor
evaluate sinusoid-k4 --set fundamental_frequency_hz=20kg | 20kg
evaluate sinusoid-k4 --set exposure_s | key = value
evaluate sinusoid-k4 --trials 0 | --trials; found 0
evaluate sinusoid-k4 --trials 1.5 | --trials; 1.5
evaluate sinusoid-k4 --trials lots | --trials; lots
evaluate sinusoid-k4 --distance 2kg | --distance; found 2kg; expected a number
evaluate sinusoid-k4 --distance -1 | --distance
evaluate sinusoid-k4 --distance 2 | optics
evaluate sinusoid-k4 --klux 20 | --distance
evaluate sinusoid-k4 --method zncd | zncd
evaluate sinusoid-k4 --error 5 | unknown option '--error'
evaluate hamiltonian-k20 | hamiltonian-k20; [3, 10]
evaluate multifrequency-0x4 | multifrequency-0x4
evaluate sinusoid-k4 -o e.xls | expected .csv
design --taps 3 | --set sensor.taps
evaluate sinusoid-k4 --exposure-s 0.01 | --set exposure_s
evaluat sinusoid-k4 | did you mean evaluate?
decode raw.npy --kode sinusoid-k4 -o d.npy | unknown option '--kode'
design --exposures 20 | found 20
design --method optimise | did you mean optimize?
design --target note.txt | note.txt
design absent.toml | absent.toml
require good.toml --error 5 | unit, such as 5mm
require good.toml --error 5kg | 5kg
require good.toml --error -5mm | -5mm
require good.toml | --error
export sinusoid-k4 --format arb -o w.csv | arb
export sinusoid-k4 --format csv --rate 5mm -o w | --rate; found 5mm
simulate table-tap --code sinusoid-k4 -o r.npy | did you mean table-top?
simulate table-top --code sinusoid-k4 -o r.txt | r.txt
simulate table-top --code sinusoid-k4 --signal 2m -o r.npy | --signal; found 2m
simulate table-top --code sinusoid-k4 --width 0 -o r.npy | --width
simulate table-top --code sinusoid-k4 --frames 0 -o r.npy | --frames
simulate z.npz --kind radial --code sinusoid-k4 -o r.npy | z.npz; kind z
simulate s.toml --code sinusoid-k4 -o r.npy | radius_m
scene absent.npy | absent.npy
scene table-top --scale-m 2 | --scale-m
scene note.txt | note.txt
sweep sweep.toml --store s.sqlite | AAAA
sweep absent.toml --store s.sqlite | absent.toml
sweep good.toml --store s.sqlite | good.toml
codes sinusoid-k4 -o c.doc | c.doc
codes gray-k99 | gray-k99
cameras kinect | kinect
report . | design.json
calibrate noise raw.npy -o c.toml | --dark
calibrate correlation note.txt -o c.toml | note.txt
calibrate correlation raw.npy --reference-kind z -o c.toml | --reference
""".strip().splitlines()

# Commands that succeed with a warning or a note.
NOTED = """
decode mixed.npy -o a.npy | raw numbers do not fit this code; --order 0,2,1,3
decode mixed.npy --camera paper-10f0 -o b.npy | warning: the camera differs from mixed.camera.toml
decode mixed.npy --code square-k4 -o c.npy | warning: the code square-k4 differs from mixed.code.json
""".strip().splitlines()


class WrongInputs(CommandLineTest):
    def setUp(self):
        super().setUp()
        for name, content in FILES.items():
            self.write(name, content)
        np.save(self.path("raw.npy"), np.arange(32, dtype=np.float32).reshape(2, 4, 4))
        np.save(self.path("bool.npy"), np.ones((2, 4, 4), bool))
        np.save(self.path("flat.npy"), np.ones((2, 4), np.float32))
        np.savez(self.path("z.npz"), depth=np.ones((2, 4), np.float32),
                 depth_is_z=np.ones(1, np.uint8))
        self.write("d.bin", np.arange(300, 332, dtype="<u2").tobytes())

    def test_each_is_refused_with_its_cause(self):
        self.assertGreaterEqual(len(WRONG), 90)
        for row in WRONG:
            command, words = row.split(" | ")
            before = self.files()
            code, out, error = self.run_tool(*shlex.split(command))
            with self.subTest(command=command, message=error):
                self.assertIn(code, (1, 2))
                self.assertEqual(out, b"")
                for word in words.split("; "):
                    self.assertIn(word, error)
                self.assertEqual(self.files(), before)

    def test_conflicts_are_noted(self):
        self.do("simulate", "table-top", "--width", "40", "--height", "30", "--camera", "good.toml",
                "--code", "sinusoid-k4", "--signal", "1e6", "-o", "mixed.npy")
        raw = np.load(self.path("mixed.npy"))
        os.remove(self.path("mixed.npy"))
        np.save(self.path("mixed.npy"), raw[..., [0, 2, 1, 3]])
        for row in NOTED:
            command, words = row.split(" | ")
            with self.subTest(command=command):
                answer = self.do(*shlex.split(command))
                for word in words.split("; "):
                    self.assertIn(word, answer)


if __name__ == "__main__":
    unittest.main()

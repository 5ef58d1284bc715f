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
    "word.toml": CAMERA + "[sensor]\nreadout = difference\n",
    "negative.toml": CAMERA + "exposure_s = -1\n",
    "d.raw.toml": DUMP,
    "s.toml": "[[sphere]]\ncentre_m = [0, 0, 2]\nradius_m = 1\n",
    "sweep.toml": f'camera = "{"A" * 300}"\ncodes = ["sinusoid-k4"]\n',
    "khz.toml": "fundamental_frequency_hz = 20\n",
    "equals.toml": CAMERA + "exposure_s 0.02\n",
    "quote.toml": 'name = "mine\n' + CAMERA,
    "curly.toml": "name = \u201cmine\u201d\n" + CAMERA,
    "no_table.toml": CAMERA + "taps = 2\n",
    "bandwidth.toml": CAMERA + "[light]\nbandwidth_hz = 80e6\n",
    "focal.toml": CAMERA + "[optics]\nfocal_length_m = 4\n",
    "cutoff.toml": CAMERA + '[light]\nimpulse_response = { kind = "lowpass" }\n',
    "behind.toml": CAMERA + "[lens]\nfx_px = -300\nfy_px = 300\ncx_px = 3.5\ncy_px = 2.5\n",
    "cut.code.json": '{"name": "x", "modu',
    "columns.csv": "time,light\n0,1\n1,0\n",
    "wide.raw.toml": DUMP.replace("bits = 12", "bits = 33"),
    "ball.toml": "[[ball]]\ncentre_m = [0, 0, 2]\nradius_m = 1\n",
    "two.txt": "0\n1\n",
    "note.txt": "hello\n",
}

# Command | words of the answer, separated by ";". The exit code is 1, or 2 for wrong usage.
WRONG = """
decode raw.npy --code sinusoid-k5 -o d.npy | 4 measurements; expected 5
decode raw.npy -o d.npy | --code is required; raw.code.json
require paper-10f0 --error 5mm --distance 3m --klux 20 | [optics]; --set 'optics = {; filter_width_m = 30e-9
decode raw.npy --code sinusoid-k4 -o d | .npz
decode raw.npy --code sinusoid-k4 -o d.ply | --view-deg; [lens]
decode raw.npy --code sinusoid-k4 --kind z -o d.npy | --view-deg; [lens]
decode raw.npy --code sinusoid-k4 --view-deg 200 -o d.ply | --view-deg; found 200
decode raw.npy --code sinusoid-k4 --order 0,1,2 -o d.npy | order
decode raw.npy --code sinusoid-k4 --layout planar -o d.npy | raw.npy
decode raw.npy --code sinusoid-k4 --camera absent.toml -o d.npy | absent.toml
decode raw.npy --code sinusoid-k4 --outputs amplitudes -o d.npz | amplitudes; signal
decode raw.npy --code sinusoid-k4 --filter medium -o d.npy | medium; normal
decode raw.npy --code sinusoid-k4 --frame 3 -o d.npy | --frame; 1 frame
decode raw.npy --code sinusoid-k4 --offset-m 2kg -o d.npy | found 2kg; expected a number
decode raw.npy --code sinusoid-k4 --undistort -o d.npy | [lens]
decode raw.npy --code sinusoid-k4 --time-filter 0 -o d.npy | found 0
decode raw.npy --code note.txt -o d.npy | note.txt
decode note.txt --code sinusoid-k4 -o d.npy | note.txt
decode bool.npy --code sinusoid-k4 -o d.npy | bool; expected numbers; astype
decode flat.npy --code sinusoid-k4 -o d.npy | shape (2, 4); all files
decode d.bin --code sinusoid-k4 -o d.npy | found the extension '.bin'; a sensor's dump; --raw-format
decode d.bin --code sinusoid-k4 --raw-format d.raw.toml --layout planar -o d.npy | --layout
decode d.bin --code sinusoid-k4 --raw-format note.txt -o d.npy | note.txt:1
decode - --code sinusoid-k4 -o d.npy | -o -
evaluate | CODE
evaluate sinusoid-k4 --camera word.toml | word.toml:3; readout = "difference"
evaluate sinusoid-k4 --camera negative.toml | exposure_s = -1
evaluate sinusoid-k4 --camera raw.npy | raw.npy
evaluate sinusoid-k4 --set light.peak_factr=5 | did you mean light.peak_factor?
evaluate sinusoid-k4 --set peak_factor=5 | peak_factor
evaluate sinusoid-k4 --set exposure_s | key = value
evaluate sinusoid-k4 --decoder plain | sensor.decoder; only valid with readout = "rows"
design paper-10f0 --decoder ml | --decoder: ml not in; whitened; plain
evaluate sinusoid-k4 --trials 0 | --trials; found 0
evaluate sinusoid-k4 --trials 1.5 | --trials; 1.5
evaluate sinusoid-k4 --distance 2kg | --distance; found 2kg; expected a number
evaluate sinusoid-k4 --distance -1 | --distance
evaluate sinusoid-k4 --distance 2 | optics
evaluate sinusoid-k4 --klux 20 | --distance
evaluate sinusoid-k4 --method zncd | zncd
evaluate sinusoid-k4 --error 5 | unknown option '--error'
evaluate hamiltonian-k20 | hamiltonian-k20; must be in [3, 10]; `tofsmith codes`; hamiltonian-k4
evaluate multifrequency-0x4 | multifrequency-0x4
evaluate multifrequency-1x4-4000x4 | 4000; must be in [1, 2048]
evaluate sinusoid-k2 | measurements = 2; >= 3
evaluate note.txt | note.txt; expected .json, .npz
evaluate sinusoid-k4 -o e.xls | expected .csv
evaluate sinusoid-k4 --interference 0 | --interference; found 0; [1, 1000]
evaluate sinusoid-k4 --set operating.interference.camera=2 | did you mean operating.interference.cameras?
evaluate sinusoid-k4 --set 'operating.interference.spreading="noise"' | operating.interference.spreading; signs
evaluate sinusoid-k4 --set operating.interference.parts=4 | operating.interference.parts; spreading = "phases"
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
export sinusoid-k4 --format csv --rate 5mm -o w | --rate; found 5mm
simulate table-tap --code sinusoid-k4 -o r.npy | did you mean table-top?
simulate table-top --code sinusoid-k4 -o r.txt | r.txt
simulate table-top --code sinusoid-k4 --signal 2m -o r.npy | --signal; found 2m
simulate table-top --code sinusoid-k4 --width 0 -o r.npy | --width
simulate table-top --code sinusoid-k4 --frames 0 -o r.npy | --frames
simulate z.npz --kind radial --code sinusoid-k4 -o r.npy | z.npz; kind z
scene absent.npy | absent.npy
scene table-top --scale-m 2 | --scale-m
scene note.txt | note.txt
scene s.toml --width 64 -o out | --width; [view]
sweep sweep.toml --store s.sqlite | AAAA
sweep good.toml --store s.sqlite | good.toml
codes sinusoid-k4 -o c.doc | c.doc
codes gray-k99 | gray-k99; `tofsmith codes`
cameras kinect | kinect
report . | design.json
calibrate noise raw.npy -o c.toml | --dark
calibrate correlation note.txt -o c.toml | note.txt
calibrate correlation raw.npy --reference-kind z -o c.toml | --reference
decode --code sinusoid-k4 -o d.npy | RAW is required
decode raw.npy raw.npy --code sinusoid-k4 -o d.npy | 2 files, one per measurement; expected 4
decode raw.npy --code good.toml -o d.npy | good.toml; camera; expected a code
decode raw.npy --code raw.npy -o d.npy | shape (2, 4, 4); expected (N, K)
decode raw.npy --code sinusoid-k4 --taps 2 -o d.npy | --taps; sinusoid-k4; --set sensor.taps=2
decode raw.npy --code sinusoid-k4 -o d.jpg | ".jpg"; expected .npy
decode raw.npy --code sinusoid-k4 --order 0-3 -o d.npy | --order: found 0-3
decode raw.npy --code sinusoid-k4 --order 1,2,3,4 -o d.npy | order = 1, 2, 3, 4; 0, 1, ...
decode raw.npy --code sinusoid-k4 --bits 12 -o d.npy | unknown option '--bits'
decode raw.npy --code sinusoid-k4 --lens l.yaml -o d.ply | unknown option '--lens'
decode raw.npy --code sinusoid-k4 --kind depth -o d.npy | --kind; {radial,z}
decode raw.npy --code sinusoid-k4 --raw-format d.raw.toml -o d.npy | raw.npy; NumPy array
decode z.npz --code sinusoid-k4 -o d.npy | depth, depth_is_z; 'raw'
decode d.bin --code sinusoid-k5 --raw-format d.raw.toml -o d.npy | 4 measurements; expected 5
decode d.bin --code sinusoid-k4 --raw-format wide.raw.toml -o d.npy | bits = 33; [1, 32]
decode signed.bin --code sinusoid-k4 --raw-format d.raw.toml -o d.npy | signed = true would fit
decode d.bin --code sinusoid-k4 --raw-format absent.raw.toml -o d.npy | absent.raw.toml; no such file
evaluate good.toml sinusoid-k4 | good.toml; camera; --camera
evaluate columns.csv | columns.csv; modulation_1
evaluate cut.code.json | cut.code.json:1
evaluate Sinusoid_K4 | did you mean sinusoid-k4?
evaluate gray | did you mean gray-k4?
evaluate --code sinusoid-k4 | unknown option '--code'
evaluate sinusoid-k4 --camera khz.toml | khz.toml:1; 20 MHz are 20e6
evaluate sinusoid-k4 --camera equals.toml | equals.toml:2; expected '='
evaluate sinusoid-k4 --camera quote.toml | quote.toml:1; ends with a quote
evaluate sinusoid-k4 --camera curly.toml | curly.toml:1; straight quotes
evaluate sinusoid-k4 --camera no_table.toml | no_table.toml:2; did you mean sensor.taps?
evaluate sinusoid-k4 --camera bandwidth.toml | did you mean light.impulse_response.cutoff_hz?
evaluate sinusoid-k4 --camera focal.toml | did you mean lens.focal_length_m?
evaluate sinusoid-k4 --camera cutoff.toml | cutoff_hz = 100e6
evaluate sinusoid-k4 --camera behind.toml | lens.fx_px = -300
evaluate sinusoid-k4 --set light.cutoff_hz=80e6 | did you mean light.impulse_response.cutoff_hz?
evaluate sinusoid-k4 --set exposure_s=0,02 | decimals have a point
evaluate sinusoid-k4 --set sensor.taps=9 | multiple of the 9 taps
evaluate sinusoid-k4 --taps 3 | --taps; --set sensor.taps=3
evaluate sinusoid-k4 --camera | --camera: found no value
evaluate sinusoid-k4 --camera good.toml --camera lens.toml | --camera: found 2 value(s); expected 1
evaluate sinusoid-k4 --seed -3 | --seed: found -3; >= 0
evaluate sinusoid-k4 --seed today | --seed; today
evaluate sinusoid-k4 --threads many | --threads; found many
evaluate sinusoid-k4 --perturb bandwith=20% | bandwith=20%; bandwidth
evaluate sinusoid-k4 --perturb jitter=5 | such as 50ps
evaluate sinusoid-k4 --distance 3 --albedo 50 --camera indoor | --albedo: found 50; at most 1
design good.toml --camera lens.toml | CAMERA; --camera
design good.toml --exposures 3-5 | --exposures: found 3-5; expected an integer
design good.toml --method search | sensor.shortest_pulse_s
design good.toml --target sinusoid-k4 --method optimize | --method factorize
design good.toml --bandwidth 80MHz | --set light.impulse_response.cutoff_hz=
design sinusoid-k4 | no built-in camera of that name
require good.toml --error 5 mm | unexpected argument 'mm'
require good.toml --error 5mm | light.impulse_response = { kind = "lowpass"
require indoor --error 5mm --vary bandwith | did you mean bandwidth?
export sinusoid-k4 --format csv --rate 660 -o w | sample_rate_hz = 660; check the unit
export sinusoid-k4 --format csv --bits 12.5 -o w | --bits: found 12.5; expected an integer
export sinusoid-k4 --format csv --volts 5 -o w | --volts: found 1 value(s); expected 2
evaluate sinusoid-k4 --threads 1.5 | --threads: found 1.5; expected an integer
evaluate sinusoid-k4 --tap-order blocked | --tap-order; sinusoid-k4; array
export sinusoid-k4 --format csv -o w.docx | w.docx; expected .csv
simulate table-top --code sinusoid-k4 --truth t.txt -o r.npy | t.txt; expected one of .npy
simulate table-top --code sinusoid-k4 --frames 2.5 -o r.npy | --frames: found 2.5
simulate note.txt --code sinusoid-k4 -o r.npy | several scenes; expected a directory
simulate ball.toml --code sinusoid-k4 -o r.npy | unknown key ball; sphere
simulate table-top --scene room --code sinusoid-k4 -o r.npy | unknown option '--scene'
atlas --taps 7 | found no code; tofsmith atlas
calibrate | expected one of; noise
calibrate noize raw.npy | unknown command 'noize'; did you mean noise?
calibrate correlation raw.npy -o c.toml | --shifts; --reference
calibrate correlation raw.npy --shifts two.txt -o c.toml | 2 shifts; expected 1
calibrate noise raw.npy --dark raw.npy -o c.toml | pairs of equal light
codes fourier-k200 | 200; [2, 16]
codes sinusoid-k4 --samples 1 | --samples: found 1; [8, 65536]
lab --port 8080 | unknown option '--port'
report note.txt | design.json
version | unknown command 'version'; expected one of
""".strip().splitlines()

# Commands that succeed with a warning or a note.
NOTED = """
decode mixed.npy --camera paper-10f0 -o b.npy | warning: the camera differs from mixed.camera.toml
decode mixed.npy --code square-k4 -o c.npy | warning: the code square-k4 differs from mixed.code.json
evaluate sinusoid-k4 --camera indoor --set optics.pixel_pitch_m=7 --distance 3 | check the unit
decode mixed.npy --offset-m 1500 -o e.npy | check that they are in metres
decode broken.npy --code sinusoid-k4 --camera good.toml -o d.npy | warning: broken.camera.toml:1; not used
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
        self.write("signed.bin", np.arange(-16, 16, dtype="<i2").tobytes())
        self.write("d.bin", np.arange(300, 332, dtype="<u2").tobytes())

    def test_each_is_refused_with_its_cause(self):
        self.assertGreaterEqual(len(WRONG), 140)
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
        os.link(self.path("mixed.npy"), self.path("broken.npy"))
        self.write("broken.camera.toml", "[light\n")
        for row in NOTED:
            command, words = row.split(" | ")
            with self.subTest(command=command):
                code, out, error = self.run_tool(*shlex.split(command))
                self.assertEqual(code, 0)
                for word in words.split("; "):
                    self.assertIn(word, out.decode() + error)


if __name__ == "__main__":
    unittest.main()

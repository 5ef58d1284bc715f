# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Error messages contain the place, the invalid input and the expected input; no file is left
behind."""

import json
import os
import unittest

import numpy as np

from command_line import CommandLineTest

CAMERA = """fundamental_frequency_hz = 15e6
samples = 240

[light]
peak_factor = 15
"""


class Refusals(CommandLineTest):
    def refuse_camera(self, text, *words):
        self.write("c.toml", text)
        self.refuse(["evaluate", "sinusoid-k4", "--camera", "c.toml", "--trials", "1000"], *words)

    def refuse_setting(self, setting, *words, code="sinusoid-k4"):
        self.refuse(["evaluate", code, "--trials", "1000", "--set", setting], *words)

    def test_messages_contain_no_terminal_escapes(self):
        for name, shown in ((b"\x1b[31mred", "\\x1b[31mred"), (b"a\xff\xc2\x9bb", "a\\xff\\xc2\\x9bb"),
                            ("Größe".encode(), "Größe")):
            process = self.start("evaluate", os.fsdecode(name))
            error = process.communicate()[1]
            self.assertEqual(process.returncode, 1)
            self.assertIn(shown, error.decode())  # in UTF-8
            self.assertNotIn(b"\x1b", error)
        self.write("c.toml", 'name = "\\u001b[31mred"\nfundamental_frequency_hz = 15e6\n')
        self.assertIn("sinusoid-k4 on \\x1b[31mred: ",
                      self.do("codes", "sinusoid-k4", "--camera", "c.toml"))
        process = self.start("evaluate", "x" * 100_000)
        self.assertLess(len(process.communicate()[1]), 6000)

    def test_every_option_rejects_an_empty_value(self):
        for option, *words in (
                ("-o", "codes", "sinusoid-k4", "-o", ""),
                ("--output", "codes", "sinusoid-k4", "--output="),
                ("--store", "sweep", "s.toml", "--store", ""),
                ("--export", "sweep", "s.toml", "--export", ""),
                ("-o", "decode", "raw.npy", "--code", "sinusoid-k4", "-o", ""),
                ("--camera", "evaluate", "sinusoid-k4", "--camera", ""),
                ("--set", "evaluate", "sinusoid-k4", "--set", ""),
                ("--truth", "simulate", "room", "--code", "sinusoid-k4", "-o", "a", "--truth="),
                ("--report", "calibrate", "noise", "--report", "", "a.npy")):
            self.refuse(words, f"{option}: found an empty value; expected a value", code=2)

    def test_usage(self):
        for arguments, words in (
                (["bogus"], ["unknown command 'bogus'", "expected one of"]),
                (["evalute"], ["did you mean evaluate?"]),
                ([""], []),
                (["--bogus"], ["unknown option '--bogus'"]),
                (["evaluate"], ["CODE"]),
                (["evaluate", "sinusoid-k4", "--trails", "5"], ["did you mean --trials?"]),
                (["evaluate", "sinusoid-k4", "--trials", "0"], ["--trials", "0"]),
                (["evaluate", "sinusoid-k4", "--trials", "many"], ["--trials", "many"]),
                (["evaluate", "sinusoid-k4", "--trials", ""], ["--trials"]),
                (["evaluate", "sinusoid-k4", "--target-standard-error", "much"],
                 ["--target-standard-error", "found much", "1%"]),
                (["evaluate", "sinusoid-k4", "--target-standard-error", "100%"],
                 ["found 100%", "[1e-05, 1)"]),
                (["evaluate", "sinusoid-k4", "--target-standard-error", "0"], ["found 0"]),
                (["evaluate", "sinusoid-k4", "--max-trials", "1"], ["--max-trials", "1"]),
                (["evaluate", "sinusoid-k4", "-o", "x.xls"], ["x.xls", "expected .csv"]),
                (["evaluate", "sinusoid-k4", "--threads", "-1"], ["--threads"]),
                (["evaluate", "sinusoid-k4", "--method", "magic"], ["magic", "ml", "unwrap"]),
                (["evaluate", "sinusoid-k4", "--unwrap-weights", "frequency"], ["--method"]),
                (["design", "a", "b"], ["'b'"]),
                (["design", "--method", "magic"], ["magic", "factorize"]),
                (["design", "--method", "factorise"], ["did you mean factorize?"]),
                (["decode", "r.npy", "--code", "c", "--method", "two-returns", "-o", "d.npy"],
                 ["did you mean two-return?"]),
                (["decode", "r.npy", "--code", "c", "--filter", "weak", "-o", "d.npy"],
                 ["weak", "light", "strong"]),
                (["decode", "r.npy", "--code", "c", "--filter-set", "windows=1", "-o", "d.npy"],
                 ["--filter"]),
                (["decode", "r.npy", "--code", "c", "--mixed", "near", "-o", "d.npy"],
                 ["near", "label", "snap", "drop"]),
                (["decode", "r.npy", "--code", "c", "--average", "0", "-o", "d.npy"],
                 ["--average: found 0; must be >= 1"]),
                (["design", "--exposures", "17"], ["17"]),
                (["codes", "-o", "x.npz"], ["NAME"]),
                (["simulate", "table-top", "--code", "sinusoid-k4"], ["--output"]),
                (["simulate", "table-top", "--image", "a.png", "--code", "sinusoid-k4", "-o",
                  "r.npy"], ["--image a.png"]),
                (["simulate", "table-top", "--code", "sinusoid-k4", "--frames", "0", "-o",
                  "r.npy"], ["--frames"]),
                (["simulate", "table-top", "--code", "sinusoid-k4", "--reference-distance", "-2",
                  "-o", "r.npy"], ["--reference-distance: found -2; must be finite and > 0"]),
                (["scene", "m.obj", "--scale-m", "0", "-o", "d"], ["found 0; must be finite and > 0"]),
                (["evaluate", "sinusoid-k4", "--outlier-threshold", "nan"],
                 ["found nan; must be >= 0"]),
                (["reproduce"], ["FIGURE"]),
                (["report"], ["DIR"])):
            self.refuse(arguments, *words, code=2)
            self.refuse([*arguments, "--json"], *words, code=2)

    def test_names(self):
        self.refuse(["evaluate", "hamiltonan-k3"], "did you mean hamiltonian-k3?")
        self.refuse(["evaluate", "square-k4", "--method", "unwrap"], "measurement 0",
                    "outside harmonic 1", "requires sinusoids")
        self.refuse(["evaluate", "multifrequency-2x3-4x3", "--method", "unwrap"],
                    "frequencies = 2, 4", "repeats after 4.997")
        self.refuse(["evaluate", "hamiltonian-k40"], "hamiltonian-k40", "must be in [3, 10]",
                    "`tofsmith codes`", "hamiltonian-k4")
        self.refuse(["codes", "gray-k99"], "gray-k99", "`tofsmith codes`")
        self.refuse(["decode", "dump.bin", "--code", "sinusoid-k4", "-o", "d.npy"],
                    "found the extension '.bin'", "a sensor's dump", "--raw-format")
        self.refuse(["evaluate", "nothing-like-it"], "no such file", "codes")
        self.refuse(["evaluate", ""], "empty name")
        self.refuse(["evaluate", "sinusoid-k4", "--camera", "paper-10"], "did you mean paper-10f0?")
        self.refuse(["decode", "", "--code", "sinusoid-k4", "-o", "d.npy"], "expected")
        self.refuse(["report", ""], "design.json")
        self.refuse(["evaluate", "sinusoid-k4", "--camera", "."], "directory", "expected a file")
        self.refuse(["decode", ".", "--code", "sinusoid-k4", "-o", "d.npy"], "expected")

    def test_cameras(self):
        self.refuse_camera("", "c.toml", "fundamental_frequency_hz")
        self.refuse_camera(CAMERA + "peak_facter = 3", "c.toml:6", "did you mean")
        self.refuse_camera(CAMERA.replace("= 15\n", "= nan\n"), "c.toml:5", "peak_factor", "finite")
        self.refuse_camera(b"\0" * 100, "c.toml")

    def test_settings(self):
        self.refuse_setting("light.peak_facter=3", "unknown key", "did you mean light.peak_factor?")
        self.refuse_setting("foo", "'foo'", "key = value")
        self.refuse_setting("=3", "'=3'")
        self.refuse_setting("sensor.read_noise_e=-1", "-1", ">= 0")
        self.refuse_setting("operating.error=round", "round", "linear")

    def test_codes(self):
        self.refuse(["evaluate", "multifrequency-1x4-4000x4"], "4000", "must be in [1, 2048]")
        for code in ("sinusoid-k2", "square-k2"):
            self.refuse(["evaluate", code], "measurements = 2", ">= 3")
        self.do("codes", "sinusoid-k3", "-o", "c.code.json")
        code = json.loads(self.bytes_of("c.code.json"))
        # Three equal measurements do not separate depth from signal.
        same = code | {"modulation": code["modulation"][:1] * 3, "demodulation": code["demodulation"][:1] * 3}
        for content, words in ((same, ["rank", ">= 2"]), (code | {"version": 99}, ["c.code.json", "version"]),
                               (code | {"samples": -1}, ["c.code.json", "samples"])):
            self.write("c.code.json", json.dumps(content))
            self.refuse(["evaluate", "c.code.json"], *words)
        self.write("c.code.json", '{"format": "tofsmith-code",')
        self.refuse(["evaluate", "c.code.json"], "c.code.json:1:")
        self.write("c.txt", "")
        self.refuse(["evaluate", "c.txt"], "c.txt", "expected .json, .npz")

    def test_codes_for_another_camera(self):
        self.do("codes", "hamiltonian-k3", "-o", "h.code.json")
        evaluate = ["evaluate", "h.code.json", "--set"]
        self.assertIn("N = 480", self.do(*evaluate, "samples=480"))  # resampled
        self.refuse([*evaluate, "light.peak_factor=2"], "peak = 6", "peak_factor = 2")
        self.refuse([*evaluate, "sensor.taps=2"], "taps = 1", "sensor.taps = 2")

    def test_raw_frames(self):
        good = np.ones((4, 5, 3), np.float32)
        decode = lambda name, *more: ["decode", name, "--code", "hamiltonian-k3", "-o", "d.npy", *more]
        for array, words in ((good[:, :, :2], ["2 measurements", "expected 3"]), (good[:0], ["0"]),
                             (good.astype("?"), ["bool", "expected numbers", "astype"]),
                             (good[:, :, 0], ["shape (4, 5)", "all files"])):
            np.save(self.path("raw.npy"), array)
            self.refuse(decode("raw.npy"), "raw.npy", *words)
        np.save(self.path("raw.npy"), good)
        self.refuse(decode("raw.npy", "--frame", "1"), "--frame = 1", "1 frame", code=2)
        self.write("raw.npy", self.bytes_of("raw.npy")[:-1])
        self.refuse(decode("raw.npy"), "raw.npy", "expected")
        np.savez(self.path("raw.npz"), a=good, b=good)
        self.refuse(decode("raw.npz"), "raw.npz", "raw")
        self.refuse(decode("absent.npy"), "absent.npy", "no such file")

    def test_scenes(self):
        np.save(self.path("depth.npy"), np.ones((4, 5), np.float32))
        np.save(self.path("albedo.npy"), np.ones((5, 5), np.float32))
        np.save(self.path("deep.npy"), np.ones((4, 5, 2), np.float32))
        self.write("scene.tiff", "II")
        self.write("broken.png", b"\x89PNG\r\n\x1a\n")
        simulate = lambda *scene: ["simulate", *scene, "--code", "sinusoid-k4", "-o", "raw.npy"]
        self.refuse(simulate("depth.npy", "--image", "albedo.npy"), "albedo.npy", "5 x 5", "4 x 5")
        self.refuse(simulate("deep.npy"), "deep.npy", "shape")
        self.refuse(simulate("scene.tiff"), "scene.tiff", ".tiff", ".png")
        self.refuse(simulate("broken.png"), "broken.png")
        self.refuse(simulate("absent.npy"), "absent.npy")
        self.refuse(simulate("depth.npy", "--signal", "nan"), "signal_e_per_s", "nan")
        self.refuse(simulate("depth.npy", "--ambient", "-1"), "ambient_e_per_s", "-1")

    def test_scene_files(self):
        scene = lambda *words: ["scene", *words, "-o", "out"]
        ball = "[[sphere]]\ncentre_m = [0, 0, 2]\nradius_m = "
        for text, words in (
                ("", ["found no shapes"]),
                (ball + "0", ["s.toml:3:12", "> 0"]),
                (ball + "1\ntexture = { image = 'absent.png' }", ["s.toml:4", "absent.png"]),
                (ball + "1\n[[mesh]]\nfile = 'absent.obj'", ["s.toml:5", "absent.obj"])):
            self.write("s.toml", text)
            self.refuse(scene("s.toml"), *words)
        self.refuse(scene("tabel-top"), "did you mean table-top?")
        self.refuse(scene(""), "-o requires a SCENE", code=2)
        self.refuse(["scene", "-o", "out"], "-o requires a SCENE", code=2)
        self.write("s.toml", ball + "0.5")
        self.refuse(scene("s.toml", "--width", "64"), "--width", "[view]", code=2)
        self.refuse(scene("table-top", "--scale-m", "2"), "--scale-m", "mesh", code=2)
        self.refuse(scene("table-top", "--width", "0"), "--width", code=2)
        self.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4")
        self.refuse(scene("m.obj"), "m.obj:4", "index 4", "1 to 3")

    def test_pictures_of_scenes(self):
        np.save(self.path("depth.npy"), np.ones((4, 5), np.float32))
        for option, shape, value, words in (("--image", (4, 5), -1.0, ["p.npy: row 0, column 0", ">= 0"]),
                                            ("--ambient-image", (5, 5), 1.0, ["5 x 5", "4 x 5", "depth.npy"])):
            np.save(self.path("p.npy"), np.full(shape, value, np.float32))
            self.refuse(["simulate", "depth.npy", "--code", "sinusoid-k4", "-o", "raw.npy", option,
                         "p.npy"], "p.npy", *words)

    def test_outputs(self):
        np.save(self.path("raw.npy"), np.ones((4, 5, 3), np.float32))
        self.write("old.npy", "old")
        self.write("file", "")
        decode = lambda output: ["decode", "raw.npy", "--code", "hamiltonian-k3", "-o", output]
        self.refuse(decode("old.npy"), "old.npy", "exists", "--force")
        self.refuse(decode("d.xyz"), ".xyz", ".npy")
        self.refuse(decode("absent/d.npy"), "the directory absent does not exist")
        self.refuse(decode("file/d.npy"), "file/d.npy")
        self.refuse(decode("/dev/full"), "/dev/full")
        self.refuse(decode("/proc/d.npy"), "/proc/d.npy", "cannot")
        self.refuse(["codes", "sinusoid-k4", "-o", "c.txt"], "c.txt", ".json")
        self.refuse(["design", "-o", "file"], "directory")
        self.refuse(["design", "-o", "file/d"], "file/d", "directory")
        # before the long computation, not after it
        self.write("e.csv", "old")
        self.refuse(["evaluate", "sinusoid-k4", "--trials", "100000000", "-o", "e.csv"], "e.csv",
                    "--force")

    def test_outputs_that_are_inputs(self):
        np.save(self.path("raw.npy"), np.ones((4, 5, 3), np.float32))
        np.save(self.path("map.npy"), np.ones((4, 5), np.float32))
        np.save(self.path("t.npy"), np.random.default_rng(1).random((60, 3)))
        os.symlink("raw.npy", self.path("link.npy"))
        os.mkdir(self.path("d"))
        for output in ("raw.npy", "d/../raw.npy", "link.npy", "map.npy", "t.npy"):
            self.refuse(["decode", "raw.npy", "--code", "t.npy", "--gain-map", "map.npy", "-o",
                         output, "--force"], output, "input", "choose another name")
        self.refuse(["decode", "raw.npy", "--code", "t.npy", "--outputs", "depth,status",
                     "--stack", "--offset-map", "map.npy", "-o", "map.npy", "--force"], "map.npy",
                    "input")
        self.refuse(["simulate", "map.npy", "--code", "sinusoid-k4", "-o", "map.npy", "--force"],
                    "map.npy", "input")

    def test_no_command_replaces_its_input(self):
        np.save(self.path("depth.npy"), np.ones((4, 5), np.float32))
        self.do("codes", "sinusoid-k4", "-o", "code.json")
        os.symlink("code.json", self.path("link.json"))
        before = self.bytes_of("code.json")
        for command in (["scene", "depth.npy", "-o", "depth.npy"],
                        ["codes", "code.json", "-o", "link.json"],
                        ["codes", "code.json", "--output=./code.json"],
                        ["evaluate", "sinusoid-k4", "code.json", "-o", "link.json"]):
            output = command[-1].split("=")[-1]
            self.refuse([*command, "--force"], output, "input", "choose another name")
        self.assertEqual(self.bytes_of("code.json"), before)

    def test_designs(self):
        self.refuse(["report", "."], "design.json")
        self.write("design.json", "{}")
        self.refuse(["report", "."], "details.json")
        self.refuse(["demo", "-o", "."], "design.json", "--force")
        self.refuse(["demo", "--depth", "absent.npy", "-o", "d"], "absent.npy")
        self.write("t.csv", "1,2\nx,3\n")
        self.refuse(["design", "--target", "t.csv", "-o", "d"], "t.csv:2")
        self.refuse(["design", "--target", "hamiltonian-k3", "--exposures", "4"], "--exposures",
                    code=2)
        self.refuse(["design", "--target", "hamiltonian-k3", "--normalize"], "--normalize", code=2)

    def test_files_in_the_way_of_a_directory(self):
        self.write("report.html", "mine")
        self.refuse(["design", "--method", "factorize", "--exposures", "3", "--trials", "1000", "-o",
                     "."], "report.html",
                    "--force")
        self.refuse(["demo", "--trials", "1000", "-o", "."], "report.html", "--force")


if __name__ == "__main__":
    unittest.main()

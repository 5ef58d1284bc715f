# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Error messages contain the place, the invalid input and the expected input; no file is left
behind."""

import os
import unittest

import numpy as np

from command_line import CommandLineTest


class Refusals(CommandLineTest):
    def test_messages_contain_no_terminal_escapes(self):
        for name, shown in ((b"\x1b[31mred", "\\x1b[31mred"),
                            (b"a\xff\xc2\x9bb", "a\\xff\\xc2\\x9bb"),
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
                (["evaluate", "sinusoid-k4", "--trails", "5"], ["did you mean --trials?"]),
                (["evaluate", "sinusoid-k4", "--trials", "many"], ["--trials", "many"]),
                (["evaluate", "sinusoid-k4", "--target-standard-error", "much"],
                 ["--target-standard-error", "found much", "1%"]),
                (["evaluate", "sinusoid-k4", "--target-standard-error", "100%"],
                 ["found 100%", "[0, 1)"]),
                (["evaluate", "sinusoid-k4", "--target-standard-error=-1%"], ["found -1%"]),
                (["evaluate", "sinusoid-k4", "--interference", "1.5"],
                 ["--interference: found 1.5; expected an integer"]),
                (["require", "--error", "5mm", "--effort", "0.1"], ["--effort requires --exact"]),
                (["evaluate", "sinusoid-k4", "--max-trials", "1"], ["--max-trials", "1"]),
                (["evaluate", "sinusoid-k4", "--threads", "-1"], ["--threads"]),
                (["evaluate", "sinusoid-k4", "--method", "magic"], ["magic", "ml", "unwrap"]),
                (["evaluate", "sinusoid-k4", "--unwrap-weights", "frequency"], ["--method"]),
                (["design", "a", "b"], ["'b'"]),
                (["decode", "r.npy", "--code", "c", "--method", "two-returns", "-o", "d.npy"],
                 ["did you mean two-return?"]),
                (["decode", "r.npy", "--code", "c", "--filter-set", "windows=1", "-o", "d.npy"],
                 ["--filter"]),
                (["decode", "r.npy", "--code", "c", "--mixed", "near", "-o", "d.npy"],
                 ["near", "label", "snap", "drop"]),
                (["decode", "r.npy", "--code", "c", "--average", "0", "-o", "d.npy"],
                 ["--average: found 0; must be >= 1"]),
                (["simulate", "table-top", "--code", "sinusoid-k4", "--ambient", "-1", "-o",
                  "r.npy"], ["--ambient: found -1; must be >= 0"]),
                (["codes", "-o", "x.npz"], ["NAME"]),
                (["simulate", "table-top", "--code", "sinusoid-k4"], ["--output"]),
                (["simulate", "table-top", "--image", "a.png", "--code", "sinusoid-k4", "-o",
                  "r.npy"], ["--image a.png"]),
                (["simulate", "table-top", "--code", "sinusoid-k4", "--reference-distance", "-2",
                  "-o", "r.npy"], ["--reference-distance: found -2; must be finite and > 0"]),
                (["scene", "m.obj", "--scale-m", "0", "-o", "d"],
                 ["found 0; must be finite and > 0"]),
                (["evaluate", "sinusoid-k4", "--outlier-threshold", "nan"],
                 ["found nan; must be >= 0"]),
                (["reproduce"], ["FIGURE"])):
            self.refuse(arguments, *words, code=2)
            self.refuse([*arguments, "--json"], *words, code=2)

    def test_empty_names_and_directories(self):
        self.refuse(["evaluate", ""], "empty name")
        self.refuse(["decode", "", "--code", "sinusoid-k4", "-o", "d.npy"], "expected")
        self.refuse(["report", ""], "design.json")
        self.refuse(["evaluate", "sinusoid-k4", "--camera", "."], "directory", "expected a file")
        self.refuse(["decode", ".", "--code", "sinusoid-k4", "-o", "d.npy"], "expected")
        self.refuse(["scene", "", "-o", "out"], "-o requires a SCENE", code=2)
        self.refuse(["scene", "-o", "out"], "-o requires a SCENE", code=2)

    def test_codes_for_another_camera(self):
        self.do("codes", "hamiltonian-k3", "-o", "h.code.json")
        evaluate = ["evaluate", "h.code.json", "--set"]
        self.assertIn("N = 480", self.do(*evaluate, "samples=480"))  # resampled
        self.refuse([*evaluate, "light.peak_factor=2"], "peak = 6", "peak_factor = 2")
        self.refuse([*evaluate, "sensor.taps=2"], "taps = 1", "sensor.taps = 2")

    def test_scenes(self):
        np.save(self.path("depth.npy"), np.ones((4, 5), np.float32))
        np.save(self.path("p.npy"), np.ones((5, 5), np.float32))
        np.save(self.path("negative.npy"), np.full((4, 5), -1.0, np.float32))
        self.write("scene.tiff", "II")
        self.write("broken.png", b"\x89PNG\r\n\x1a\n")
        simulate = lambda *scene: ["simulate", *scene, "--code", "sinusoid-k4", "-o", "raw.npy"]
        self.refuse(simulate("depth.npy", "--image", "p.npy"), "p.npy", "5 x 5", "4 x 5")
        self.refuse(simulate("depth.npy", "--ambient-image", "p.npy"), "p.npy", "5 x 5", "4 x 5",
                    "depth.npy")
        self.refuse(simulate("depth.npy", "--image", "negative.npy"),
                    "negative.npy: row 0, column 0", ">= 0")
        self.refuse(simulate("scene.tiff"), "scene.tiff", ".tiff", ".png")
        self.refuse(simulate("broken.png"), "broken.png")
        self.refuse(simulate("depth.npy", "--signal", "nan"),
                    "--signal: found nan; must be >= 0 and finite", code=2)

    def test_outputs(self):
        np.save(self.path("raw.npy"), np.ones((4, 5, 3), np.float32))
        self.write("old.npy", "old")
        self.write("file", "")
        decode = lambda output: ["decode", "raw.npy", "--code", "hamiltonian-k3", "-o", output]
        self.refuse(decode("old.npy"), "old.npy", "exists", "--force")
        self.refuse(decode("absent/d.npy"), "the directory absent does not exist")
        self.refuse(decode("file/d.npy"), "file/d.npy")
        self.refuse(decode("/dev/full"), "/dev/full")
        self.refuse(decode("/proc/d.npy"), "/proc/d.npy", "cannot")
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
        self.do("codes", "sinusoid-k4", "-o", "code.json")
        os.symlink("raw.npy", self.path("link.npy"))
        os.symlink("code.json", self.path("link.json"))
        os.mkdir(self.path("d"))
        decode = ("decode", "raw.npy", "--code", "t.npy")
        inputs = ("raw.npy", "d/../raw.npy", "link.npy", "map.npy", "t.npy")
        for command in (*((*decode, "--gain-map", "map.npy", "-o", name) for name in inputs),
                        (*decode, "--outputs", "depth,status", "--stack", "--offset-map", "map.npy",
                         "-o", "map.npy"),
                        ("simulate", "map.npy", "--code", "sinusoid-k4", "-o", "map.npy"),
                        ("scene", "map.npy", "-o", "map.npy"),
                        ("codes", "code.json", "-o", "link.json"),
                        ("codes", "code.json", "--output=./code.json"),
                        ("evaluate", "sinusoid-k4", "code.json", "-o", "link.json")):
            output = command[-1].split("=")[-1]
            self.refuse([*command, "--force"], output, "input", "choose another name")

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
        self.refuse(["design", "--method", "factorize", "--exposures", "3", "--trials", "1000",
                     "-o", "."], "report.html", "--force")
        self.refuse(["demo", "--trials", "1000", "-o", "."], "report.html", "--force")


if __name__ == "__main__":
    unittest.main()

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Commands that compute write and print the same bytes with 1 and 5 threads, also with fewer
cores."""

import os
import re
import unittest

import numpy as np

from command_line import CommandLineTest

SCENE = ("table-top", "--width", "48", "--height", "36")
LIGHT = ("--signal", "1e5", "--ambient", "1e4")
CAMERA = ("--set", "samples=60")
SMALL = ("--set", "samples=24", "--set", "operating.signal_e_per_s=[1e5]", "--set",
         "operating.ambient_e_per_s=[1e4]")
TAPS = (*CAMERA, "--set", "sensor.taps=2")
TRIALS = ("--trials", "1000")
DECODE = ("decode", "raw.npy", "--code", "sinusoid-k4", *CAMERA)

# Each runs in the directory filled by the previous ones.
COMMANDS = {
    "simulate": ("simulate", *SCENE, "--code", "sinusoid-k4", *CAMERA, *LIGHT, "--frames", "6", "-o",
                 "raw.npy", "--truth", "truth.npy"),
    "simulate, two returns": ("simulate", *SCENE, "--code", "hamiltonian-k5", *TAPS, *LIGHT,
                              "--multipath", "delta=.7,ratio=.3", "-o", "two.npy"),
    "simulate, frequencies": ("simulate", *SCENE, "--code", "multifrequency-k5", *CAMERA, *LIGHT,
                              "-o", "wrapped.npy"),
    "simulate, bounces": ("simulate", *SCENE, "--code", "sinusoid-k4", *CAMERA, *LIGHT, "--bounces",
                          "1", "--bounce-rays", "16", "-o", "bounced.npy"),
    "simulate, motion and blur": (
        "simulate", "moving-hand", "--width", "24", "--height", "18", "--code", "sinusoid-k4", *CAMERA,
        "--set", "lens.blur=gaussian", "--set", "lens.blur_sigma_px=0.6", "--frames", "2", "-o",
        "moving.npy"),
    "simulate, a mesh": ("simulate", "mesh.obj", "--width", "64", "--height", "48", "--code",
                         "sinusoid-k4", *CAMERA, "-o", "mesh.npy"),
    "simulate, many scenes": (
        "simulate", "room", "corner", "--width", "24", "--height", "18", "--code", "sinusoid-k4",
        "--signal-range", "1e4:1e5", "--ambient-range", "1e3:1e4", "-o", "set"),
    "decode": (*DECODE, "--outputs", "depth,signal,ambient,confidence,deviation,status", "-o",
               "zncc.npz"),
    "decode, filters": (*DECODE, "--filter", "normal", "--time-filter", "4", "-o", "filter.npz"),
    "decode, mixed pixels": (*DECODE, "--mixed", "label", "-o", "mixed.npz"),
    "decode, likelihood": (*DECODE, "--method", "ml", "-o", "ml.npz"),
    "decode, unwrapping": ("decode", "wrapped.npy", "--code", "multifrequency-k5", *CAMERA,
                           "--method", "unwrap", "-o", "unwrap.npz"),
    "decode, two returns": ("decode", "two.npy", "--code", "hamiltonian-k5", *TAPS, "--method",
                            "two-return", "-o", "returns.npz"),
    "decode, points": ("decode", "bounced.npy", "--code", "sinusoid-k4", *CAMERA, "--view-deg",
                       "60", "-o", "points.ply"),
    "scene": ("scene", *SCENE, "-o", "scene.npz"),
    "evaluate": ("evaluate", "sinusoid-k4", "hamiltonian-k3", *CAMERA, *TRIALS, "--best-rotation",
                 "--robustness"),
    "evaluate, likelihood": ("evaluate", "sinusoid-k4", *CAMERA, "--trials", "300", "--method", "ml"),
    "evaluate, unwrapping": ("evaluate", "multifrequency-k5", *CAMERA, "--trials", "300", "--method",
                             "unwrap", "--target-standard-error", "10%"),
    "multipath": ("multipath", "multifrequency-k5", *CAMERA, "--trials", "200", "--delays", "1",
                  "--ratios", ".3", "--tails", ".5"),
    "require": ("require", "--error", "30mm", *SMALL, "--set", "exposure_s=[0.1,0.1,0.1]",
                "--vary", "power", "--max-factor", "1.5", "--exact", "--effort", ".01", *TRIALS,
                "--no-map", "-o", "require.json"),
    "require, atlas": ("require", "--error", "30mm", *SMALL, "--vary", "power", *TRIALS, "-o",
                       "from_atlas.json"),
    "design": ("design", *SMALL, "--method", "optimize", "--effort", ".01", *TRIALS, "-o",
               "optimized"),  # with several numbers of exposures, searches end early
    "design, factorized": ("design", *SMALL, "--method", "factorize", "--exposures", "3",
                           "--effort", ".01", *TRIALS, "-o", "factorized"),
    "report": ("report", "factorized", "-o", "factorized.html"),
    "sweep": ("sweep", "sweep.toml", "--store", "store.sqlite", "--export", "sweep.csv",
              "--export", "sweep.npz"),
    "calibrate correlation": ("calibrate", "correlation", "shifted.npy", "--shifts", "shifts.txt",
                              "--shift-unit", "period", *CAMERA, "--table", "t.npz", "--offset-map",
                              "o.npy", "--gain-map", "g.npy", "--report", "correlation.html"),
    "calibrate depth": ("calibrate", "correlation", "raw.npy", "--reference", "truth.npy", "--code",
                        "sinusoid-k4", *CAMERA, "--table", "corrected.npz"),
    "calibrate temperature": ("calibrate", "temperature", "raw.npy", "--temperatures", "c.txt",
                              "--code", "sinusoid-k4", *CAMERA, "-o", "warm.toml"),
    "export": ("export", "hamiltonian-k3", "--format", "csv", "--samples", "64", "-o", "export"),
}
# Stores are not compared, because they contain times, processes and machines.
IGNORED = re.compile(r"\.sqlite")


def without_times(text):
    """Removes computing times and the command line from results."""
    text = re.sub(rb'"seconds": ?[-+.e\d]+', b"", text)
    text = re.sub(rb'"(frames|megapixels)_per_s": ?[-+.e\d]+', b"", text)
    text = re.sub(rb"--threads \d+", b"", text)
    return re.sub(rb"\d[.\d]* (m?s|min)\b", b"", text)


class Threads(CommandLineTest):
    def prepare(self, folder):
        os.mkdir(self.path(folder))
        delays = np.repeat(np.arange(24) / 24, 2)
        waves = 1000 + 500 * np.cos(2 * np.pi * (delays[:, None] - np.arange(4) / 4))
        noise = np.random.default_rng(3).normal(0, 5, (48, 4, 5, 4))
        np.save(self.path(f"{folder}/shifted.npy"), (waves[:, None, None] + noise).astype("f4"))
        np.savetxt(self.path(f"{folder}/shifts.txt"), delays)
        np.savetxt(self.path(f"{folder}/c.txt"), 20 + np.arange(6))
        self.write(f"{folder}/mesh.obj", "v 0 0 0\nv 2 0 0\nv 2 1 1\nv 0 1 0\nf 1 2 3\nf 1 3 4\n")
        self.write(f"{folder}/sweep.toml",
                   'set = ["samples=60"]\ncodes = ["sinusoid-k4"]\ntrials = 2000\n'
                   '[[axis]]\nkey = "light.peak_factor"\nvalues = [2, 4, 6]\n')

    def outcome(self, threads):
        folder, found = threads, {}
        self.prepare(folder)
        for name, words in COMMANDS.items():
            code, out, error = self.run_tool(*words, "--json", "--threads", threads, folder=folder)
            self.assertEqual((code, error), (0, ""), name)
            found[name] = without_times(out)
        for place, _, files in os.walk(self.path(folder)):
            for file in files:
                path = os.path.join(place, file)
                name = os.path.relpath(path, self.path(folder))
                if not IGNORED.search(name):
                    found[name] = without_times(self.bytes_of(path))
        return found

    def start(self, *arguments, folder=".", **options):
        above, self.directory = self.directory, os.path.join(self.directory, folder)
        try:
            return super().start(*arguments, **options)
        finally:
            self.directory = above

    def test_any_number_of_threads_gives_the_same_bytes(self):
        expected, found = self.outcome("1"), self.outcome("5")
        self.assertEqual(found.keys(), expected.keys())
        for name in found:
            self.assertEqual(found[name], expected[name], name)


if __name__ == "__main__":
    unittest.main()

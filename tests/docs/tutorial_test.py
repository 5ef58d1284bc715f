# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Runs the tutorial and the pages from raw frames to depth: writes their files and executes their
commands in order, in an empty directory. PYTHONPATH must contain the Python package.

    tutorial_test.py TOFSMITH DOCS
"""

import os
import re
import subprocess
import sys
import tempfile
import unittest

TOOL = os.path.abspath(sys.argv.pop(1))
DOCS = os.path.abspath(sys.argv.pop(1))
MADE = ("designed/report.html", "raw.npy", "truth.npy", "depth.npz", "depth.png", "points.ply",
        "compared.png", "waveforms.pdf")
OFFSET = re.compile(r"MHz: offset (\S+) ± (\S+) mm, contrast (\S+) ±")


def text_of(page):
    with open(os.path.join(DOCS, page), encoding="utf-8") as file:
        return file.read()


def blocks_of(page):
    """Returns (language, text) of every fenced block, with the commands alone of `console` blocks;
    `sh` blocks are not executed."""
    blocks = re.findall(r"^```(bash|console|toml|python)\n(.*?)^```$", text_of(page), re.M | re.S)
    return [("bash", "".join(re.findall(r"^\$ ((?:.*\\\n)*.*\n)", text, re.M)))
            if language == "console" else (language, text) for language, text in blocks]


def errors_mm(text):
    """Returns {file: (median error in mm, percentage of pixels within 50 mm)} from compare.py."""
    lines = re.findall(r"^(\S+): median error ([\d.]+) mm, (\d+) %", text, re.M)
    return {name: (float(median), float(share)) for name, median, share in lines}


class Tutorial(unittest.TestCase):
    def run_in(self, directory, command, text):
        environment = dict(os.environ, PATH=f"{os.path.dirname(TOOL)}:/usr/bin:/bin", MPLBACKEND="agg")
        done = subprocess.run(command, input=text, cwd=directory, env=environment, text=True,
                              capture_output=True, timeout=200)
        self.assertEqual(done.returncode, 0, f"{text}\n{done.stdout}\n{done.stderr}")
        return done.stdout

    def run_page(self, page, made):
        """Writes the files and runs the blocks of a page in order; returns the printed text."""
        blocks = blocks_of(page)
        self.assertGreater(len(blocks), 4)
        printed = ""
        with tempfile.TemporaryDirectory(prefix="tofsmith-tutorial-") as directory:
            for language, text in blocks:
                name = re.match(r"# (\S+\.(?:toml|py))\n", text)
                if language == "toml" or name:
                    with open(os.path.join(directory, name[1]), "w", encoding="utf-8") as file:
                        file.write(text)
                else:
                    command = ["bash", "-e"] if language == "bash" else [sys.executable, "-B", "-"]
                    printed += self.run_in(directory, command, text)
            for name in made:
                self.assertGreater(os.path.getsize(os.path.join(directory, name)), 0, name)
        return printed

    def test_commands_run_in_order(self):
        printed = self.run_page("tutorial.md", MADE)
        errors = [float(mm) for mm in re.findall(r"median error ([\d.]+) mm", printed)]
        self.assertEqual(len(errors), 2)
        self.assertLess(2 * errors[0], errors[1], "the designed code is not twice as good")

    def test_camera_calibration_gives_the_stated_results(self):
        printed = self.run_page("your_camera.md", ("first.png", "table.npz", "reference.html", "depth.npz",
                                                   "cloud.ply", "errors.png", "cloud.png"))
        off_m, rms_mm = re.search(r"mean offset ([+-][\d.]+) m, residual ([\d.]+) mm", printed).groups()
        self.assertAlmostEqual(float(off_m), 0.31, delta=0.01)
        error_mm = float(re.search(r"median error ([\d.]+) mm", printed)[1])
        self.assertLess(3 * error_mm, float(rms_mm))

    def test_three_cameras_have_the_stated_errors(self):
        printed = self.run_page("real_cameras.md",
                                [camera + "-table.npz" for camera in ("kinect", "azure", "ti")])
        stated = text_of("real_cameras.md")
        error_mm = errors_mm(printed)
        self.assertEqual(list(error_mm), list(errors_mm(stated)))
        for name, (median, share) in errors_mm(stated).items():
            self.assertAlmostEqual(error_mm[name][0], median, delta=0.05 * median, msg=name)
            self.assertAlmostEqual(error_mm[name][1], share, delta=2, msg=name)
        for camera in ("kinect", "azure", "ti"):
            first, depth, exact = (error_mm[f"{camera}-{name}.npz"][0]
                                   for name in ("first", "depth", "exact"))
            self.assertLess(20 * depth, first)
            self.assertLess(depth, 1.5 * exact)
        # (offset [mm], its standard error, contrast) of each frequency, estimated and simulated
        found = [[float(number) for number in row] for row in OFFSET.findall(printed)]
        self.assertEqual(len(found), 8)
        for row, said in zip(found, OFFSET.findall(stated), strict=True):
            self.assertAlmostEqual(row[0], float(said[0]), delta=row[1], msg=said)
            self.assertAlmostEqual(row[2], float(said[2]), delta=0.01, msg=said)
        true_mm = (-178.9, 619.7, -548.9, 120, 350, -80, 1878.6, 1779.2)
        for row, true in zip(found, true_mm, strict=True):
            self.assertAlmostEqual(row[0], true, delta=2 * row[1])


if __name__ == "__main__":
    unittest.main()

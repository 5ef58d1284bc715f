# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""The tutorial and the page on a camera of one's own do what they say: their files are written and
their commands run, in order, in an empty directory. PYTHONPATH has the Python package.

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
MADE = ("designed/report.html", "raw.npy", "truth.npy", "depth.npz", "depth.png", "points.ply", "depth.pdf",
        "waveforms.pdf")


def blocks_of(page):
    """(language, text) of every fenced block; `sh` is for the reader alone."""
    with open(os.path.join(DOCS, page), encoding="utf-8") as file:
        return re.findall(r"^```(bash|toml|python)\n(.*?)^```$", file.read(), re.M | re.S)


class Tutorial(unittest.TestCase):
    def run_in(self, directory, command, text):
        environment = dict(os.environ, PATH=f"{os.path.dirname(TOOL)}:/usr/bin:/bin", MPLBACKEND="agg")
        done = subprocess.run(command, input=text, cwd=directory, env=environment, text=True,
                              capture_output=True, timeout=200)
        self.assertEqual(done.returncode, 0, f"{text}\n{done.stdout}\n{done.stderr}")
        return done.stdout

    def run_page(self, page, made):
        """Everything that a page prints, its files written and its blocks run, in order."""
        blocks = blocks_of(page)
        self.assertGreater(len(blocks), 4)
        printed = ""
        with tempfile.TemporaryDirectory(prefix="tofsmith-tutorial-") as directory:
            for language, text in blocks:
                if language == "toml":
                    with open(os.path.join(directory, re.match(r"# (\S+)\n", text)[1]), "w") as file:
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

    def test_a_camera_is_calibrated_as_its_page_says(self):
        printed = self.run_page("your_camera.md", ("first.png", "table.npz", "reference.html", "depth.npz",
                                                   "cloud.ply", "errors.png", "cloud.png"))
        off_m, rms_mm = re.search(r"depth is ([+-][\d.]+) m off in the mean, ([\d.]+) mm", printed).groups()
        self.assertAlmostEqual(float(off_m), 0.31, delta=0.01)
        error_mm = float(re.search(r"median error ([\d.]+) mm", printed)[1])
        self.assertLess(3 * error_mm, float(rms_mm))


if __name__ == "__main__":
    unittest.main()

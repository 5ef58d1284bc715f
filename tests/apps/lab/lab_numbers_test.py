#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""The lab gives the same numbers as the command line. Exit 77: no page is built, or no browser.

    lab_numbers_test.py TOFSMITH PAGE_OR_ENGINE
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

TOOL, PAGE = sys.argv.pop(1), Path(sys.argv.pop(1))

from lab_browser import LabTest, run_tests  # noqa: E402

TRIALS = 1000


def command(*words):
    done = subprocess.run([TOOL, "--json", *words], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def numeric_fields(document, path=""):
    if isinstance(document, dict):
        return {k: v for key, one in document.items() for k, v in numeric_fields(one, f"{path}.{key}").items()}
    if isinstance(document, list):
        return {k: v for i, one in enumerate(document) for k, v in numeric_fields(one, f"{path}[{i}]").items()}
    is_number = isinstance(document, (int, float)) and not isinstance(document, bool)
    return {path: document} if is_number else {}


def row_text(value, digits):
    """Formats a number like the table: with `digits` significant digits and no exponent."""
    return f"{value:#.{digits}g}".rstrip(".") if value else "0"


class Numbers(LabTest):
    def compare(self, camera, changes, code):
        ours = self.run_script("""
            tofsmithLab.store.change((state) => {
              Object.assign(state, {camera: {built_in: args[0], changes: args[1]}, codes: [{name: args[2]}], trials: args[3], seed: 3, chosen: 0});
            });
            await waitFor(() => !tofsmithLab.engine.isIdle);
            await settled();
            return [tofsmithLab.lab.slots[0].evaluation, [...document.querySelectorAll('#error-table tbody td')].map((cell) => cell.textContent)];""",
            camera, changes, code, TRIALS)
        sets = [word for change in changes for word in ("--set", f"{change['key']}={change['value']}")]
        theirs = command("evaluate", code, "--camera", camera, *sets, "--trials", str(TRIALS), "--seed", "3")
        document, cells = ours
        found, expected = numeric_fields(document["codes"]), numeric_fields(theirs["codes"])
        self.assertEqual(found.keys(), expected.keys())
        range_m = 299792458 / (2 * theirs["camera"]["fundamental_frequency_hz"])
        for place, value in expected.items():
            # Decoded in single precision, with and without fused multiply-add.
            self.assertLessEqual(abs(found[place] - value), 1e-6 * abs(value) + 2e-9 * range_m, place)
        for cell, kind in zip(cells[1:3], ("linear", "circular")):
            mean, deviation = (1e3 * theirs["codes"][0][kind][f"geometric_mean_{what}"] for what in ("m", "se_m"))
            self.assertEqual(cell, f"{row_text(mean, 4)} \u00b1 {row_text(deviation, 2)}")
        shown = self.text("[data-command=evaluate] pre")
        self.assertEqual(self.shell(shown + " --json"), theirs)

    def compare_scene(self, camera, code):
        """Compares the depth of every pixel, to single precision."""
        ours = self.run_script("""
            const {depth_m} = await tofsmithLab.engine.call('scene', {
              camera: args[0], code: {name: args[1]}, scene: 'table-top', seed: 3, width: 64, signal: 1e5, ambient: 1e4, filter: 'off'
            });
            return [...depth_m.values].map(String);""",
            subprocess.run([TOOL, "cameras", camera], capture_output=True, text=True, check=True).stdout, code)
        with tempfile.TemporaryDirectory() as folder:
            raw, depth = Path(folder, "raw.npy"), Path(folder, "depth.npy")
            on = ["--code", code, "--camera", camera]
            command("simulate", "table-top", *on, "--width", "64", "--height", "48", "--signal", "1e5", "--ambient", "1e4",
                    "--seed", "3", "-o", str(raw))
            command("decode", str(raw), *on, "-o", str(depth))
            theirs = np.load(depth).ravel()
        found = np.array(ours, dtype=float)
        np.testing.assert_array_equal(np.isfinite(found), np.isfinite(theirs))
        np.testing.assert_allclose(found, theirs, rtol=1e-6)

    def shell(self, text):
        """Runs the command shown on the page and returns its document."""
        words = text.replace("tofsmith", TOOL, 1)
        return json.loads(subprocess.run(["sh", "-c", words], capture_output=True, text=True, check=True).stdout)

    def test_the_table_and_the_shown_command_equal_the_command(self):
        self.compare("paper-10f0", [{"key": "exposure_s", "value": "0.25"}], "hamiltonian-k4")

    def test_curves_that_are_equally_long_in_several_directions(self):
        self.compare("paper-10f0", [{"key": "light.peak_factor", "value": "6"}], "hamiltonian-k4")

    def test_commercial_cameras(self):
        self.compare("kinect-v2", [], "multifrequency-2x3-10x3-15x3")

    def test_scenes_have_the_depth_of_the_command(self):
        self.compare_scene("paper-10f0", "hamiltonian-k4")
        self.compare_scene("kinect-v2", "multifrequency-2x3-10x3-15x3")  # counts photons

    def test_invalid_values_give_the_message_of_the_command(self):
        done = subprocess.run([TOOL, "cameras", "paper-10f0"], capture_output=True, text=True, check=True)
        self.assertIn("fundamental_frequency_hz", done.stdout)
        message = self.run_script("""
            enter(byId('field-light-peak_factor'), 'nan');
            await waitFor(() => !byId('field-light-peak_factor-problem').hidden);
            return byId('field-light-peak_factor-problem').textContent;""")
        failed = subprocess.run([TOOL, "codes", "sinusoid-k4", "--set", "light.peak_factor=nan"], capture_output=True, text=True)
        self.assertIn(message.split(":", 1)[-1].strip(), failed.stderr)


if __name__ == "__main__":
    run_tests(PAGE)

#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Compares codes of `design --effort 0`, which only looks up known codes, with codes of a full
design (`--effort 1` without the atlas), on cameras that the atlas does not contain. Both are
evaluated with independent random numbers at their best origins. Prints the errors and their
ratio; exits with 1 if a ratio exceeds 1.03.

    atlas.py TOFSMITH [EFFORT]       EFFORT of the full design instead of 1
"""

import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ASKED = 1.03
#: taps, peak factor, bandwidth (f0), kind of error
CAMERAS = ((1, 6, 7, "circular"), (1, 11, 14, "circular"), (1, 11, 7, "linear"), (1, 20, 4, "circular"),
           (2, 6, 14, "circular"), (2, 11, 7, "linear"), (2, 3, 7, "circular"),
           (3, 11, 7, "circular"), (4, 6, 7, "circular"), (4, 11, 14, "circular"), (4, 11, 17, "circular"))


def run(*words):
    begin = time.monotonic()
    done = subprocess.run(words, check=True, capture_output=True, text=True)
    return json.loads(done.stdout), time.monotonic() - begin


def main():
    tool, effort = sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else "1"
    print("taps  peak  bandwidth  error     effort 0 (mm)  by  s  full (mm)  by  s  ratio")
    worst = 0.0
    for taps, peak, band, kind in CAMERAS:
        camera = ["--camera", "paper-10f0"]
        for key, value in (("sensor.taps", taps), ("light.peak_factor", peak), ("operating.error", f'"{kind}"'),
                           ("light.impulse_response.f_max_hz", band * 15e6),
                           ("sensor.impulse_response.f_max_hz", band * 15e6)):
            camera += ["--set", f"{key}={value}"]
        errors, words = [], []
        for asked in (("--effort", "0"), ("--effort", effort, "--atlas-cameras", "0")):
            with tempfile.TemporaryDirectory() as folder:
                design = str(Path(folder) / "design")
                found, seconds = run(tool, "design", *camera, *asked, "-o", design, "--json", "--quiet")
                best = str(Path(design) / "codes" / f"{found['best']}.code.json")
                judged, _ = run(tool, "evaluate", best, *camera, "--trials", "40000", "--seed", "77",
                                "--best-rotation", "--json", "--quiet")
            errors.append(judged["codes"][0][kind]["geometric_mean_m"])
            words.append(f"{1e3 * errors[-1]:.2f}  {found['best']}  {seconds:.1f}")
        ratio = errors[0] / errors[1]
        worst = max(worst, ratio)
        print(f"{taps}  {peak}  {band}  {kind}  {words[0]}  {words[1]}  {ratio:.3f}", flush=True)
    print(f"worst {worst:.3f}; asked: at most {ASKED}")
    sys.exit(worst > ASKED)


if __name__ == "__main__":
    main()

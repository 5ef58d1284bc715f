#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Measures how much the result of a design depends on its seed. Designs a code for each camera with
several seeds (`--method optimize`, default effort, the best number of exposures) and evaluates the
winners with the same new random numbers. Prints the errors in mm and the spread of each camera:
largest error / smallest error - 1. Target: at most 1 % plus four standard errors of the evaluation.

    seeds.py TOFSMITH [SEEDS [STORE.jsonl]]    10 seeds; designs in the store are reused

Exits with 1 if a spread exceeds the target.
"""

import json
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

ASKED = 0.01
#: taps, exposures, peak factor, bandwidth (f0); circular errors
CAMERAS = ((1, 5, 10, 10), (1, 3, 5, 5), (2, 4, 10, 10), (2, 4, 5, 14),
           (3, 2, 10, 10), (3, 3, 11, 14), (4, 2, 10, 10), (4, 2, 11, 14))
TRIALS, JUDGING_SEED = 40000, 77


def run(*words):
    return json.loads(subprocess.run(words, check=True, capture_output=True, text=True).stdout)


def designed(tool, camera, seed):
    """Returns the name of the winner, its error and the standard error [m]."""
    taps, exposures, peak, band = camera
    words = ["--camera", "paper-10f0", "--threads", "1"]
    for key, value in (("sensor.taps", taps), ("light.peak_factor", peak), ("operating.error", '"circular"'),
                       ("light.impulse_response.f_max_hz", band * 15e6),
                       ("sensor.impulse_response.f_max_hz", band * 15e6)):
        words += ["--set", f"{key}={value}"]
    with tempfile.TemporaryDirectory() as folder:
        out = str(Path(folder) / "design")
        best = run(tool, "design", *words, "--method", "optimize", "--exposures", str(exposures),
                   "--seed", str(seed), "-o", out, "--json", "--quiet")["best"]
        code = str(Path(out) / "codes" / f"{best}.code.json")
        judged = run(tool, "evaluate", code, *words, "--trials", str(TRIALS), "--seed", str(JUDGING_SEED),
                     "--json", "--quiet")["codes"][0]["circular"]
    return best, judged["geometric_mean_m"], judged["geometric_mean_se_m"]


def main():
    tool, seeds = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 10
    store = Path(sys.argv[3]) if len(sys.argv) > 3 else None
    kept = {}
    if store and store.exists():
        for line in store.read_text(encoding="utf-8").splitlines():
            item = json.loads(line)
            kept[tuple(item["camera"]), item["seed"]] = item["found"]
    for camera in CAMERAS:
        for seed in range(1, seeds + 1):
            if (camera, seed) in kept:
                continue
            kept[camera, seed] = designed(tool, camera, seed)
            if store:
                with store.open("a", encoding="utf-8") as file:
                    file.write(json.dumps({"camera": camera, "seed": seed, "found": kept[camera, seed]}) + "\n")
    print("taps  exposures  peak  bandwidth  least (mm)  median  largest  standard error  spread  found")
    met = True
    for camera in CAMERAS:
        found = [kept[camera, seed] for seed in range(1, seeds + 1)]
        errors = [1e3 * error for _, error, _ in found]
        deviation = 1e3 * max(each for _, _, each in found)
        spread = max(errors) / min(errors) - 1
        met = met and spread <= ASKED + 4 * deviation / min(errors)
        names = ", ".join(sorted({name for name, _, _ in found}))
        print(f"{camera[0]}  {camera[1]}  {camera[2]}  {camera[3]}  {min(errors):.2f}  "
              f"{statistics.median(errors):.2f}  {max(errors):.2f}  {deviation:.3f}  {spread:.2%}  {names}")
    sys.exit(not met)


if __name__ == "__main__":
    main()

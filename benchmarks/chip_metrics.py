#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Compares codes of exclusive taps on a chip clock that minimize two variances: of depth with
unknown signal and ambient light (ours), and of depth alone, as in "Revisiting Optimal Coding for
I-ToF under Practical Sensor Constraints" (CVPR 2026). Prints the circular depth error of both codes
by maximum likelihood [mm], their ratio, and the words of the codes where they differ. Fails if ours
is worse by more than four standard errors.

    PYTHONPATH=build-dev/python chip_metrics.py [--pairs]

With --pairs, also searches two exposures (minutes).
"""

import argparse
import sys

import numpy as np

import tofsmith as ts

PERIOD_S = 90e-9
LIGHTS = {"high signal": (1.7e7, 0.0), "high ambient": (1.7e7, 8e7), "low signal": (1.1e6, 0.0)}
TRIALS = 100000


def camera_of(taps, chips, light):
    signal_e_per_s, ambient_e_per_s = light
    base = ts.Camera("exclusive-3tap-9chip")
    return base.replace(
        samples=40 * chips,
        sensor={"taps": taps, "shortest_pulse_s": PERIOD_S / chips},
        operating={"signal_e_per_s": [signal_e_per_s], "ambient_e_per_s": [ambient_e_per_s],
                   "error": "circular"})


def best_code(camera, exposures, metric):
    result = ts.design(camera, method="search", exposures=[exposures], trials=1000, baselines=[],
                       search={"metric": metric, "finalists": 1})
    found = [c for c in result.candidates if c.method == "search"][0]
    return found.code, found.message.split(":")[0]


def error_mm(code, camera):
    evaluated = ts.evaluate(code, camera, method="ml", trials=TRIALS, seed=7)
    return 1e3 * evaluated.circular_mde_m[0], 1e3 * evaluated.circular_se_m[0]


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pairs", action="store_true", help="also two exposures of three taps")
    pairs = parser.parse_args().pairs
    sizes = [(3, 9, 1), (3, 12, 1), (4, 9, 1), (4, 12, 1)] + [(3, 9, 2)] * pairs
    is_worse = False
    for taps, chips, exposures in sizes:
        for name, light in LIGHTS.items():
            camera = camera_of(taps, chips, light)
            ours, our_words = best_code(camera, exposures, "unknown-light")
            theirs, their_words = best_code(camera, exposures, "known-light")
            our_mm, our_error = error_mm(ours, camera)
            their_mm, their_error = error_mm(theirs, camera)
            is_worse |= our_mm > their_mm + 4.0 * np.hypot(our_error, their_error)
            print(f"{taps} taps, {chips:2} chips, {exposures} exposures, {name:13}"
                  f" ours {our_mm:8.3f}, depth alone {their_mm:8.3f}, ratio"
                  f" {their_mm / our_mm:.3f}", flush=True)
            if our_words != their_words:
                print(f"    ours {our_words}\n    depth alone {their_words}")
    sys.exit(int(is_worse))


if __name__ == "__main__":
    main()

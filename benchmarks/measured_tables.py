#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Depth error with a measured correlation table relative to the exact camera, for various taps,
orders, signs and directions. Each camera is swept over 121 delays of 64 pixels and calibrated with
its nominal description. Both decoders use the same 40,000 pixels at random depths. The signals of
sweep and pixels are 3e6 and 3e5 e/s, then 4e8 e/s for both. Target: a ratio of at most 1.02.

    PYTHONPATH=build-dev/python measured_tables.py
"""

import numpy as np

import tofsmith as ts

ASKED = 1.02
DELAYS, SIDE, PIXELS = 121, 8, 200
AMBIENT = 1e5
#: Signals of the sweep and of the pixels [e/s].
LIGHTS = [(3e6, 3e5), (4e8, 4e8)]

TWO = {"taps": 2, "drain": False}
DIFFERENCE = {**TWO, "readout": "difference"}
#: Name, code, sensor, playback.
CAMERAS = [
    ("one tap", "hamiltonian-k4", {}, {}),
    ("one tap, another order", "sinusoid-k4", {}, {"order": [0, 2, 1, 3]}),
    ("one tap, backwards, 1.1 m off", "hamiltonian-k5", {}, {"reversed": True, "offset_m": 1.1}),
    ("one tap, signs opposite", "sinusoid-k3", {}, {"inverted": True}),
    ("two taps", "hamiltonian-k3", TWO, {}),
    ("two taps swapped, backwards", "sinusoid-k4", TWO, {"inverted": True, "reversed": True}),
    ("differences", "sinusoid-k4", DIFFERENCE, {}),
    ("differences, all at once", "sinusoid-k4", DIFFERENCE,
     {"order": [0, 3, 2, 1], "reversed": True, "inverted": True, "offset_m": 0.7}),
]


def ratio(code, sensor, playback, sweep_s, scene_s, seed):
    """Mean absolute error with the measured table / error with the exact camera."""
    nominal = ts.Camera("paper-10f0", samples=240, exposure_s=0.01, sensor=sensor)
    true = nominal.replace(playback=playback) if playback else nominal
    range_m = nominal.range_m
    light = {"falloff": False, "ambient_e_per_s": AMBIENT}
    shares = np.append(np.arange(DELAYS - 1) / (DELAYS - 1), 0.0)
    frames = np.stack([
        ts.capture(np.full((SIDE, SIDE), max(share * range_m, 1e-6), np.float32), code, true,
                   signal_e_per_s=sweep_s, seed=1000 * seed + i, **light)
        for i, share in enumerate(shares)])
    found = ts.calibrate_correlation(ts.DelaySweep(shares, frames), nominal)
    depth_m = np.random.default_rng(seed).uniform(0.001, range_m, (PIXELS, PIXELS))
    depth_m = depth_m.astype(np.float32)
    raw = ts.capture(depth_m, code, true, signal_e_per_s=scene_s, seed=seed, **light)

    def error(decoder):
        off_m = decoder.decode(raw).depth_m - depth_m
        return np.nanmean(np.abs(off_m - range_m * np.round(off_m / range_m)))

    measured = error(ts.Decoder(found.decoding_table(nominal)))
    return measured / error(ts.Decoder(code, true)), measured


def main():
    worst = 0.0
    for name, code, sensor, playback in CAMERAS:
        print(f"{name:32} {code:15}", end="")
        for sweep_s, scene_s in LIGHTS:
            over, error_m = ratio(code, sensor, playback, sweep_s, scene_s, 1)
            worst = max(worst, over)
            print(f" {1e3 * error_m:8.3f} mm {over:.4f}", end="", flush=True)
        print()
    print(f"worst {worst:.4f} (asked {ASKED})")


if __name__ == "__main__":
    main()

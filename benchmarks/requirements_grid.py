#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Compares the results of `tofsmith require` with a fine grid, for several cameras, errors and
quantities. New codes are designed at factors near the result; each is evaluated at factors 1 %
apart, together with the family codes and the code of the result. The answer of the grid is the
factor at which the smallest error equals the requested one (linear interpolation of logarithms).
Targets: agreement within 2 %, at most 2 minutes for each search.

    PYTHONPATH=build-dev/python requirements_grid.py [CASE ...]
"""

import sys
import time

import numpy as np

import tofsmith as ts

ASKED, ASKED_S = 1.02, 120.0
EFFORT, TRIALS = 0.1, 50_000
PERCENT, DESIGNED_AT = range(-4, 5), (-4, 0, 4)
FAMILIES = ("sinusoid-k3", "sinusoid-k4", "square-k4", "hamiltonian-k3", "hamiltonian-k4",
            "hamiltonian-k5")

SUNNY = ts.Camera(
    "paper-10f0", fundamental_frequency_hz=20e6, exposure_s=0.02,
    light={"peak_factor": 8, "impulse_response": {"kind": "hann", "f_max_hz": 120e6}},
    sensor={"impulse_response": {"kind": "lowpass", "cutoff_hz": 60e6}},
    optics={"source_power_w": 2.0, "wavelength_m": 940e-9, "field_of_view_deg": [70, 55],
            "f_number": 1.2, "pixel_pitch_m": 7e-6, "quantum_efficiency": 0.3,
            "filter_width_m": 30e-9})
MEDIUM = {"signal_e_per_s": [1e4, 1e5], "ambient_e_per_s": [1e4]}
BUCKETS = {"taps": 2, "readout": "difference", "drain": False}
#: Camera, requested error [m], quantity.
CASES = {
    "paper-power": (ts.Camera("paper-10f0", operating=MEDIUM), 0.03, "power"),
    "paper-bandwidth": (ts.Camera("paper-10f0", operating=MEDIUM), 0.03, "bandwidth"),
    "sunny-exposure": (SUNNY.at_distances([2.0], albedo=0.3, klux=10), 0.02, "exposure"),
    "buckets-power": (ts.Camera("paper-5f0", sensor=BUCKETS, operating=MEDIUM), 0.03, "power"),
}


def scaled(camera, quantity, factor):
    """See with_scaled() in design/design.hpp."""
    if quantity == "power":
        levels = [factor * s for s in camera.operating.signal_e_per_s]
        return camera.replace(operating={"signal_e_per_s": levels})
    if quantity == "exposure":
        return camera.replace(exposure_s=factor * camera.exposure_s)
    arms = {}
    for name in ("light", "sensor"):
        response = getattr(camera, name).impulse_response
        key = "cutoff_hz" if response.kind == "lowpass" else "f_max_hz"
        arms[name] = {"impulse_response": {"kind": response.kind,
                                           key: factor * getattr(response, key)}}
    return camera.replace(**arms)


def judged(code, camera):
    return ts.evaluate(code, camera, trials=TRIALS, seed=3, bounds=False).circular.geometric_mean_m


def grid_answer(camera, error_m, quantity, found):
    """Factor at which the best error equals the requested one, and the best errors on the grid."""
    factors = [found.factor * (1 + percent / 100) for percent in PERCENT]
    codes = [found.code, *FAMILIES]
    for percent in DESIGNED_AT:
        there = scaled(camera, quantity, found.factor * (1 + percent / 100))
        near = [found.code.exposures + beside for beside in (-1, 0, 1)]
        design = ts.design(there, effort=EFFORT, trials=5000, seed=4, exposures=near)
        codes.append(design.winner.code)
    errors = np.array([[judged(code, scaled(camera, quantity, factor)) for factor in factors]
                       for code in codes])
    least = errors.min(axis=0)
    slope, height = np.polyfit(np.log(factors), np.log(least), 1)
    return np.exp((np.log(error_m) - height) / slope), least


def main(names):
    worst = 0.0
    for name in names or CASES:
        camera, error_m, quantity = CASES[name]
        camera = camera.replace(operating={"error": "circular"})
        begin = time.perf_counter()
        (found,) = ts.find_requirements(
            camera, error_m, exact=True, effort=EFFORT, trials=TRIALS, map=False,
            **{f"vary_{q}": q == quantity for q in ("bandwidth", "power", "exposure")}).varied
        seconds = time.perf_counter() - begin
        if found.factor is None:
            print(f"{name}: not within {found.quantity}; errs {1e3 * found.error_m:.2f} mm")
            continue
        answer, least = grid_answer(camera, error_m, quantity, found)
        worst = max(worst, found.factor / answer, answer / found.factor)
        print(f"{name}: {1e3 * error_m:.3g} mm takes {found.factor:.4g} x {quantity} "
              f"({found.code.name}, {seconds:.0f} s); grid {answer:.4g} x, ratio "
              f"{found.factor / answer:.4f}; least errors of the grid [mm] "
              + " ".join(f"{1e3 * e:.2f}" for e in least), flush=True)
    print(f"worst ratio {worst:.4f} (asked {ASKED}, in {ASKED_S:.0f} s each)")


if __name__ == "__main__":
    main(sys.argv[1:])

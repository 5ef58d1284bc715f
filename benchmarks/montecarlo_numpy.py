#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Straightforward NumPy version of the experiment of benchmark_montecarlo, on one core.

Draws depths, expected electrons and normal noise; decodes by the largest normalized correlation
with the table. Prints "code samples trials-per-second" for each code and N, and on standard error
the mean circular error, which should agree with `tofsmith evaluate --no-sub-bin`.
"""
import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import sys
import time

import numpy as np

# Runs on, off, on, ... and shift of each demodulation of the ideal codes, and their length L.
RUNS = {
    "k3": (6, [([3, 3], 0), ([3, 3], 2), ([3, 3], 4)]),
    "k4": (12, [([6, 6], 5), ([6, 6], 2), ([3, 4, 3, 2], 0), ([2, 3, 4, 3], 4)]),
    "k5": (30, [([15, 15], 15), ([15, 15], 7), ([8, 8, 7, 7], 3),
                ([4, 4, 4, 4, 3, 4, 4, 3], 1), ([2] * 7 + [3] + [2] * 4 + [3, 2], 4)]),
}
PEAK, BAND, RANGE_M = 15, 10, 9.993
SIGNAL, AMBIENT, TOTAL_S, READ_NOISE = 1e4, 1e4, 0.3, 20.0


def correlation(code, samples, fine=240):
    """chi (samples, K), from harmonics after both arms of the camera."""
    length, runs = RUNS[code]
    n = np.arange(0, fine // 2)
    x = n * 1.444 / BAND
    with np.errstate(divide="ignore", invalid="ignore"):
        response = np.where(np.isclose(x, 1), 0.5, np.sinc(x) / (1 - x**2))
    duty = max(1 / PEAK, 1 / length)

    def box(rise, fall):
        return (fall - rise) * np.sinc(n * (fall - rise)) * np.exp(-1j * np.pi * n * (rise + fall))

    light = box(0, duty) / duty * response
    columns = []
    for lengths, shift in runs:
        gate, at = np.zeros(len(n), complex), shift / length
        for i, run in enumerate(lengths):
            if i % 2 == 0:
                gate += box(at, at + run / length)
            at += run / length
        product = gate * response * np.conj(light)
        padded = np.zeros(samples // 2 + 1, complex)
        kept = min(len(product), len(padded))
        padded[:kept] = product[:kept]
        columns.append(np.fft.irfft(padded, samples) * samples)
    return np.stack(columns, axis=1)


def trial_errors(table, trials, random):
    """Circular errors [m] for random depths at one light level."""
    samples, count = table.shape
    exposure = TOTAL_S / count
    depth = random.uniform(0, samples, trials)
    below = depth.astype(int)
    share = (depth - below)[:, None]
    chi = (1 - share) * table[below] + share * table[(below + 1) % samples]
    expected = exposure * (SIGNAL * chi + AMBIENT * 0.5)
    measured = expected + np.sqrt(expected + READ_NOISE**2) * random.standard_normal(expected.shape)
    centred = table - table.mean(axis=1, keepdims=True)
    directions = centred / np.linalg.norm(centred, axis=1, keepdims=True)
    measured -= measured.mean(axis=1, keepdims=True)
    decoded = np.argmax(measured @ directions.T, axis=1)
    error = np.abs(decoded - depth)
    return np.minimum(error, samples - error) * RANGE_M / samples


def main():
    random = np.random.default_rng(1)
    for samples in (1000, 10000):
        for code in RUNS:
            table = correlation(code, samples)
            trials = 5000 if samples == 1000 else 1000
            best, errors = np.inf, []
            for _ in range(5):
                start = time.process_time()
                errors.append(trial_errors(table, trials, random).mean())
                best = min(best, time.process_time() - start)
            print(code, samples, round(trials / best, 1), flush=True)
            print(f"  circular error {1e3 * np.mean(errors):.2f} mm", file=sys.stderr)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Compares bins of random codes with brute force in NumPy: every score of every pixel, in double.

Run by scripts/differential.sh. Item i of a seed is deterministic: a code (K = 3 to 16 measurements,
N = 8 to 5000 bins: smooth, of chips, of noise, or of steps), a type of raw values and a noise
level. Progress is stored in a tally file, and the next run continues there.

    decode_bins.py --pixels N [--seed S] [--tally FILE]
"""

import argparse
import json
import os
import sys
from pathlib import Path

import numpy as np

import tofsmith as ts

KINDS = ("smooth", "chips", "noise", "steps")
TYPES = (np.uint8, np.uint16, np.float32, np.float64)
PIXELS_OF_ITEM = 100_000
SCORES_AT_ONCE = 200_000  # fits into a core's cache


def random_table(rng):
    """Returns the kind of the table and the table (N, K)."""
    measurements = int(rng.integers(3, 17))
    samples = int(np.exp(rng.uniform(np.log(8), np.log(5000))))
    kind = KINDS[rng.integers(len(KINDS))]
    phase = 2 * np.pi * np.arange(samples) / samples
    if kind == "smooth":
        table = np.zeros((samples, measurements))
        for harmonic in range(1, int(rng.integers(2, 7))):
            swing = rng.normal(size=measurements) / harmonic
            table += swing * np.cos(harmonic * phase[:, None]
                                    + rng.uniform(0, 2 * np.pi, measurements))
        # Noise and an outlier prevent interpolation of the table as a smooth curve.
        table += rng.normal(scale=1e-4, size=table.shape)
        table[0, 0] += 1e-2
    elif kind == "chips":
        light, sensor = rng.integers(0, 2, (2, samples, measurements))
        light[0], sensor[0] = 1, 1
        table = np.fft.irfft(np.fft.rfft(sensor, axis=0) * np.conj(np.fft.rfft(light, axis=0)),
                             samples, axis=0)
    elif kind == "noise":
        table = rng.normal(size=(samples, measurements))
    else:
        levels = rng.integers(0, 4, (min(samples, int(rng.integers(4, 40))), measurements))
        table = levels[np.arange(samples) * len(levels) // samples].astype(float)
    return kind, table - table.min()


def random_frame(rng, table, pixels):
    """Returns raw values (1, pixels, K) at random depths, for all magnitudes of light and noise."""
    samples, measurements = table.shape
    at = rng.uniform(0, samples, pixels)
    before = at.astype(int)
    part = (at - before)[:, None]
    chi = (1 - part) * table[before] + part * table[(before + 1) % samples]
    largest = {np.uint8: 255, np.uint16: 65535}.get(kind := TYPES[rng.integers(len(TYPES))], 1e6)
    signal = largest / max(table.max(), 1e-9) * 10 ** rng.uniform(-3, 0, (pixels, 1))
    values = signal * chi + 0.2 * largest * rng.uniform(0, 1, (pixels, 1))
    values += rng.normal(size=values.shape) * largest * 10 ** rng.uniform(-5, 0)
    if np.issubdtype(kind, np.integer):
        values = np.clip(np.rint(values), 0, largest)
    else:
        broken = rng.uniform(size=values.shape) < 1e-4
        values[broken] = rng.choice([np.nan, np.inf, -np.inf], broken.sum())
    return values.astype(kind)[None]


def wrong_bins(table, raw, found):
    """Returns the pixels that were not assigned the lowest of the best bins."""
    unit = table - table.mean(axis=1, keepdims=True)
    size = np.linalg.norm(unit, axis=1)
    known = np.flatnonzero(size > 1e-12 * size.max())
    unit = np.ascontiguousarray((unit[known] / size[known, None]).T)
    among_known = np.full(len(table), -1)
    among_known[known] = np.arange(len(known))

    y, bins = raw[0].astype(float), found[0]
    valid = np.isfinite(y).all(axis=1)
    wrong = (bins == -1) == valid
    pixels = np.flatnonzero(valid & ~wrong)
    at = among_known[bins[pixels]]
    wrong[pixels[at < 0]] = True  # a bin without contrast
    pixels, at = pixels[at >= 0], at[at >= 0]
    y = y[pixels]
    # Expected is the lowest bin within 1e-11 of the best score (docs/decoding.md). Scores within 10
    # % of that limit, or within the rounding error of large values, may fall on either side.
    rounding = 2e-15 * np.abs(y).max(axis=1, initial=0)
    y -= y.mean(axis=1, keepdims=True)
    norm = np.linalg.norm(y, axis=1)
    surely_tied, perhaps_tied = 0.9e-11 * norm - rounding, 1.1e-11 * norm + rounding
    step = max(1, SCORES_AT_ONCE // len(known))
    all_scores = np.empty((step, len(known)))
    for first in range(0, len(pixels), step):
        part = slice(first, first + step)
        here = at[part]
        scores = np.matmul(y[part], unit, out=all_scores[: len(here)])
        best = scores.max(axis=1)
        behind = best - scores[np.arange(len(here)), here]
        lowest = np.argmax(scores >= (best - surely_tied[part])[:, None], axis=1)
        lower = (surely_tied[part] >= 0) & (at[part] > lowest)
        wrong[pixels[part]] = lower | (behind > perhaps_tied[part])
    return np.flatnonzero(wrong)


def check_item(seed, item, pixels):
    """Returns the number of compared pixels; raises AssertionError at the first wrong one."""
    rng = np.random.default_rng([seed, item])
    kind, table = random_table(rng)
    raw = random_frame(rng, table, pixels)
    try:
        decoder = ts.Decoder(ts.DecodingTable.of_measured(table, range_m=1.0))
    except ValueError:  # a code without depth information
        return 0
    found = decoder.decode(raw, planes=["bin"]).bin
    wrong = wrong_bins(table, raw, found)
    assert wrong.size == 0, (
        f"seed {seed}, item {item}: {wrong.size} of {pixels} pixels, the first {wrong[0]}: raw "
        f"{raw[0, wrong[0]]}, bin {found[0, wrong[0]]}; a {kind} code of N, K = {table.shape}, "
        f"{raw.dtype}")
    return pixels


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--pixels", type=float, default=1e7, help="to compare in this run (1e7)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--tally", type=Path, help="what was done before, and is kept (.json)")
    arguments = parser.parse_args()
    tally = {}
    if arguments.tally and arguments.tally.exists():
        tally = json.loads(arguments.tally.read_text())
    state = tally.setdefault(str(arguments.seed), {"items": 0, "pixels": 0})
    done = 0
    while done < arguments.pixels:
        # The size of an item must not depend on the number of requested pixels.
        done += (pixels := check_item(arguments.seed, state["items"], PIXELS_OF_ITEM))
        state["items"] += 1
        state["pixels"] += pixels
        if arguments.tally and (state["items"] % 10 == 0 or done >= arguments.pixels):
            part = arguments.tally.with_suffix(".part")
            part.write_text(json.dumps(tally, indent=1) + "\n")
            os.replace(part, arguments.tally)
        if sys.stderr.isatty():
            print(f"\r{done:.3g} pixels", end="", file=sys.stderr)
    everything = sum(each["pixels"] for each in tally.values())
    print(f"{done:.4g} pixels of {state['items']} random codes so far: no bin is wrong; "
          f"{everything:.4g} pixels in the tally")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Reliability of `confidence`: the share of pixels in the right lobe against the mean confidence.

    PYTHONPATH=BUILD/python /usr/bin/python3 benchmarks/reliability.py [--pixels N] [CODE ...]

Depths are uniform and signals log-uniform, from 0.1 to 300 standard deviations of the signal. With a
filter, the scene consists of slanted tiles of 64 x 64 pixels with one signal each, from 0.01 to 3
deviations. Only pixels far from the edges of a tile count. The table shows the difference `share
right - confidence` of each code and decoder, in bins of confidence that contain at least 1000 pixels,
and with filters its standard error over tiles. The limit is 0.02 above 0.9, 0.03 above 0.7 and 0.05
below. Exits with 1 if a difference exceeds its limit by more than four standard errors.
"""

import argparse
import sys

import numpy as np

import tofsmith
from tofsmith import Camera, Decoder, DecodingTable, Scene

SIGNALS, FILTERED_SIGNALS = (0.1, 300), (0.01, 3)  # standard deviations of the signal
TILE_PX, CLEARANCE_PX = 64, 26
EDGES = (0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 0.97, 0.995, 1.0)
LEAST_PIXELS, LEAST_TILES = 1000, 20


def designed(camera, exposures):
    return tofsmith.design(camera, method="optimize", exposures=exposures, effort=0.3,
                           seed=1).winner.code


def measured(name, camera, samples):
    """Table from a noise-free delay sweep of `samples` steps."""
    code = tofsmith.build_family(name, camera)
    correlation = tofsmith.ForwardModel(code, camera).correlation_table(samples)
    return DecodingTable.of_measured(correlation, camera)


def cases():
    """Name, camera, code and decoding table (None: the code's own)."""
    plain = Camera("paper-10f0")
    buckets = Camera("paper-10f0", sensor={"taps": 2, "readout": "difference"})
    three_taps = Camera("paper-10f0", sensor={"taps": 3})
    for name in ("sinusoid-k3", "sinusoid-k4", "sinusoid-k5", "square-k4", "hamiltonian-k3",
                 "hamiltonian-k4", "hamiltonian-k5", "hamiltonian-k8", "gray-k4", "multifrequency-k5",
                 "multifrequency-1x4-5x4"):
        yield name, plain, name, None
    yield "hamiltonian-k4 on paper-30x", Camera("paper-30x"), "hamiltonian-k4", None
    for name in ("hamiltonian-k4", "hamiltonian-k5"):
        yield f"{name}, two buckets", buckets, name, None
    yield "kinect-v2", Camera("kinect-v2"), "multifrequency-2x3-10x3-15x3", None
    for exposures in (3, 4, 5):
        yield f"designed, K = {exposures}", plain, designed(plain, exposures), None
    yield "designed, two buckets", buckets, designed(buckets, 3), None
    yield "designed, three taps", three_taps, designed(three_taps, 2), None
    for name in ("hamiltonian-k4", "multifrequency-k5"):
        yield f"{name}, measured", plain, name, measured(name, plain, 360)


def lobe_edges(table):
    """Number of rows, and the width of the lobe to the left and right of each row [rows], as
    defined for `confidence`: while the code's own score decreases, at most 5 % of the range."""
    correlation = np.asarray(table.correlation)
    gain = np.asarray(table.ambient_gain)
    if np.any(gain):
        correlation = correlation - np.outer(correlation @ gain, gain) / (gain @ gain)
    length = np.linalg.norm(correlation, axis=1, keepdims=True)
    direction = np.divide(correlation, length, out=np.zeros_like(correlation), where=length > 0)
    rows = len(direction)
    reach = max(1, rows // 20)
    offsets = np.arange(1, reach + 1)
    edges = []
    for side in (-1, 1):
        neighbours = direction[(np.arange(rows)[:, None] + side * offsets) % rows]
        score = np.einsum("rk,rok->ro", direction, neighbours)
        falls = np.diff(np.column_stack([np.ones(rows), score]), axis=1) < 0
        edges.append(np.where(falls.all(1), reach, np.argmin(falls, axis=1)))
    return rows, edges[0], edges[1]


def random_scene(rng, pixels, range_m, signals, tiled):
    """Depth and albedo (H, W); albedo 1 is the brightest signal."""
    height = TILE_PX * max(1, round(np.sqrt(pixels) / TILE_PX))
    tiles = (height // TILE_PX,) * 2 if tiled else (height, height)
    depth = rng.uniform(0, range_m, tiles)
    albedo = (signals[0] / signals[1]) ** rng.uniform(0, 1, tiles)
    if tiled:
        slopes = rng.normal(0, 1e-4 * range_m, (2, *tiles))
        depth, albedo, *slopes = (np.kron(plane, np.ones((TILE_PX, TILE_PX)))
                                  for plane in (depth, albedo, *slopes))
        y, x = np.mgrid[:height, :height] % TILE_PX
        depth = (depth + slopes[0] * x + slopes[1] * y) % range_m
    return np.maximum(depth, 1e-6), albedo


def signal_deviation(code, camera):
    """Approximate standard deviation of the signal in a dark scene [e/s]: noise of a measurement /
    root sum of squares of the changes with depth per unit of signal."""
    level_e_per_s = 1e5
    depth = np.linspace(0.1, camera.range_m - 0.1, 64 * 64).reshape(64, 64)
    dark, lit = (tofsmith.capture(Scene(depth, albedo=albedo), code, camera, falloff=False,
                                  signal_e_per_s=level_e_per_s) for albedo in (0.0, 1.0))
    change = np.linalg.norm(lit - lit.mean(axis=(0, 1)), axis=-1).mean()
    return float(dark.std(axis=(0, 1)).mean() * level_e_per_s / change)


def reliability(decoder, code, camera, strength, pixels):
    """Confidence, correctness of the lobe, and tile, of all pixels with a depth. Without a filter
    each pixel is a tile."""
    signals = FILTERED_SIGNALS if strength else SIGNALS
    depth, albedo = random_scene(np.random.default_rng(7), pixels, camera.range_m, signals,
                                 bool(strength))
    raw = tofsmith.capture(Scene(depth, albedo=albedo), code, camera, falloff=False, seed=3,
                           signal_e_per_s=signals[1] * signal_deviation(code, camera))
    image = decoder.decode(raw, planes=("depth", "confidence", "status"), filter=strength)
    confidence, status = image.confidence.astype(float), np.asarray(image.status)
    rows, left, right = lobe_edges(decoder.table)
    known = np.isfinite(confidence) & np.isfinite(image.depth_m) & (status != 1)
    tile = np.arange(depth.size).reshape(depth.shape)
    if strength:  # next to an edge between tiles a filter may mix two surfaces
        place = np.arange(len(depth)) // TILE_PX
        tile = place[:, None] * len(depth) + place
        inner = np.arange(len(depth)) % TILE_PX
        inner = (inner >= CLEARANCE_PX) & (inner < TILE_PX - CLEARANCE_PX)
        known &= inner[:, None] & inner
    row_m = camera.range_m / rows
    row = np.round(image.depth_m[known] / row_m).astype(int) % rows
    away = (depth[known] / row_m - row + rows / 2) % rows - rows / 2
    is_right = (away >= -left[row] - 0.5) & (away <= right[row] + 0.5)
    return confidence[known], is_right, tile[known]


def judged(confidence, is_right, tile):
    """The differences as text, and True if all are within their limits. The pixels of a tile have
    correlated errors, so the standard error uses the sums over tiles."""
    shows_error = len(np.unique(tile)) < len(tile)
    texts, is_good = [], True
    for low, high in zip(EDGES, EDGES[1:]):
        inside = (confidence >= low) & ((confidence < high) | (high == 1.0))
        count = inside.sum()
        if count < LEAST_PIXELS or len(np.unique(tile[inside])) < LEAST_TILES:
            texts.append(" " * (12 if shows_error else 6))
            continue
        claimed = confidence[inside].mean()
        allowed = 0.02 if claimed > 0.9 else 0.03 if claimed > 0.7 else 0.05
        away = is_right[inside] - confidence[inside]
        difference = away.mean()
        of_tile = np.unique(tile[inside], return_inverse=True)[1]
        sums = np.bincount(of_tile, away - difference)
        error = np.linalg.norm(sums) * np.sqrt(len(sums) / max(1, len(sums) - 1)) / count
        is_good &= abs(difference) <= allowed + 4 * error
        texts.append(f"{difference:+.3f}" + (f" {error:.3f}" if shows_error else ""))
    return " ".join(texts), is_good


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="CODE", help="names in the first column (all)")
    parser.add_argument("--pixels", type=int, default=250000,
                        help="per code; a fifth for ml and unwrap, 16 times as many for filters (250000)")
    arguments = parser.parse_args()
    print("Upper ends of the bins: " + " ".join(f"{edge:.3f}" for edge in EDGES[1:]))
    all_good = True
    for name, camera, code, table in cases():
        if arguments.names and name not in arguments.names:
            continue
        decoders = [("zncc", None), ("ml", None)]
        if name.startswith(("sinusoid", "kinect", "multifrequency")) and table is None:
            decoders.append(("unwrap", None))
        decoders += [("zncc", strength) for strength in ("light", "normal", "strong")]
        for method, strength in decoders:
            pixels = arguments.pixels * 16 if strength else arguments.pixels
            if method != "zncc":
                pixels //= 5
            decoder = (Decoder(table, method=method) if table else
                       Decoder(code, camera, method=method))
            texts, is_good = judged(*reliability(decoder, code, camera, strength, pixels))
            all_good &= is_good
            print(f"{name:29s} {strength or method:8s} {texts} {'' if is_good else ' differs'}",
                  flush=True)
    return 0 if all_good else 1


if __name__ == "__main__":
    sys.exit(main())

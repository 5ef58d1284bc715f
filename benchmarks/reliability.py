#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Reliability of `confidence`: the share of pixels in the right lobe against the mean confidence.

    PYTHONPATH=BUILD/python /usr/bin/python3 benchmarks/reliability.py [--pixels N] [CODE ..]

Signals are log-uniform from 0.1 standard deviations of the signal to saturation, or to 300
deviations, depths are uniform. With a filter, the scene consists of slanted tiles of 64 x 64 pixels
of one signal each. Prints, for each code and decoder, the difference `share right - confidence` in
bins of confidence that hold at least 1000 pixels; allowed are 0.02 above 0.9, 0.03 above 0.7 and
0.05 below. Exits 1 where a difference is larger by more than four standard errors.
"""

import argparse
import sys

import numpy as np

import tofsmith
from tofsmith import Camera, Decoder, DecodingTable, Scene

AMBIENT_E_PER_S = 1e4
DARKEST, BRIGHTEST = 0.1, 300  # standard deviations of the signal
TILE_PX, CLEARANCE_PX = 64, 26
EDGES = (0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 0.97, 0.995, 1.0)
LEAST_PIXELS = 1000


def two_buckets(name="paper-10f0"):
    return Camera(name, sensor={"taps": 2, "readout": "difference"})


def designed(camera, exposures):
    return tofsmith.design(camera, method="optimize", exposures=exposures, effort=0.3, seed=1).best


def measured(name, camera, samples):
    """The table that a noise-free delay sweep of `samples` steps gives."""
    code = tofsmith.build_family(name, camera)
    correlation = tofsmith.ForwardModel(code, camera).correlation_table(samples)
    return DecodingTable.of_measured(correlation, camera)


def cases():
    """Name, camera, code and decoding table (None: the code's own)."""
    plain, buckets = Camera("paper-10f0"), two_buckets()
    for name in ("sinusoid-k3", "sinusoid-k4", "sinusoid-k5", "square-k4", "ramp-k3", "hamiltonian-k3",
                 "hamiltonian-k4", "hamiltonian-k5", "hamiltonian-k8", "gray-k4", "multifrequency-k5",
                 "multifrequency-k4"):
        yield name, plain, name, None
    yield "hamiltonian-k4 on paper-30x", Camera("paper-30x"), "hamiltonian-k4", None
    for name in ("hamiltonian-k4", "hamiltonian-k5"):
        yield f"{name}, two buckets", buckets, name, None
    yield "kinect-v2", Camera("kinect-v2"), "multifrequency-2x3-10x3-15x3", None
    three = Camera("paper-10f0", sensor={"taps": 3})
    yield "hamiltonian-k3, three taps", three, "hamiltonian-k3", None
    for exposures in (3, 4, 5):
        yield f"designed, K = {exposures}", plain, designed(plain, exposures), None
    yield "designed, two buckets", buckets, designed(buckets, 3), None
    for name in ("hamiltonian-k4", "multifrequency-k5"):
        yield f"{name}, measured", plain, name, measured(name, plain, 360)


def lobe_edges(table):
    """Number of rows, and the first row of the lobe to the left and right of each [rows], by the
    definition of `confidence`: as far as the code's own score falls, at most 5 % of the range."""
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


def random_scene(rng, pixels, range_m, brightest, tiled):
    """Depth and albedo (H, W); albedo 1 is the brightest signal."""
    height = TILE_PX * max(1, round(np.sqrt(pixels) / TILE_PX))
    shape = (height, height)
    tiles = (height // TILE_PX,) * 2 if tiled else shape
    depth = rng.uniform(0, range_m, tiles)
    albedo = (DARKEST / brightest) ** rng.uniform(0, 1, tiles)
    if tiled:
        slopes = rng.normal(0, 1e-4 * range_m, (2, *tiles))
        depth, albedo, *slopes = (np.kron(plane, np.ones((TILE_PX, TILE_PX)))
                                  for plane in (depth, albedo, *slopes))
        y, x = np.mgrid[:height, :height] % TILE_PX
        depth = (depth + slopes[0] * x + slopes[1] * y) % range_m
    return np.maximum(depth, 1e-6), albedo


def signal_deviation(decoder, code, camera):
    """Standard deviation of the signal without light from the scene [e/s]."""
    dark = Scene(np.full((64, 64), 1.0), albedo=0.0)
    raw = tofsmith.capture(dark, code, camera, signal_e_per_s=1.0, falloff=False,
                           ambient_e_per_s=AMBIENT_E_PER_S)
    bright = Scene(np.linspace(0.1, camera.range_m - 0.1, 64 * 64).reshape(64, 64))
    level = 1e5
    lit = tofsmith.capture(bright, code, camera, signal_e_per_s=level, falloff=False,
                           ambient_e_per_s=AMBIENT_E_PER_S)
    per_signal = (lit.mean(axis=(0, 1)) - raw.mean(axis=(0, 1))) / level
    gain = np.linalg.norm(lit - raw.mean(axis=(0, 1)) - level * per_signal, axis=-1).mean() / level
    return float(raw.std(axis=(0, 1)).mean() / max(gain, 1e-12))


def reliability(decoder, code, camera, strength, pixels):
    """Confidence, and whether the depth is in the right lobe, of all pixels with a depth."""
    rng = np.random.default_rng(7)
    darkest = DARKEST * signal_deviation(decoder, code, camera)
    if strength:
        darkest /= 8  # the noise of a filtered pixel
    brightest = BRIGHTEST
    depth, albedo = random_scene(rng, pixels, camera.range_m, brightest, bool(strength))
    raw = tofsmith.capture(Scene(depth, albedo=albedo), code, camera, falloff=False, seed=3,
                           signal_e_per_s=darkest * brightest / DARKEST,
                           ambient_e_per_s=AMBIENT_E_PER_S)
    image = decoder.decode(raw, planes=("depth", "confidence", "status"), filter=strength)
    confidence, status = image.confidence.astype(float), np.asarray(image.status)
    rows, left, right = lobe_edges(decoder.table)
    known = np.isfinite(confidence) & np.isfinite(image.depth_m) & (status != 1)
    if strength:  # next to an edge between tiles a filter may mix two surfaces
        inner = np.arange(len(depth)) % TILE_PX
        inner = (inner >= CLEARANCE_PX) & (inner < TILE_PX - CLEARANCE_PX)
        known &= inner[:, None] & inner
    row_m = camera.range_m / rows
    row = np.round(image.depth_m[known] / row_m).astype(int) % rows
    away = (depth[known] / row_m - row + rows / 2) % rows - rows / 2
    return confidence[known], (away >= -left[row] - 0.5) & (away <= right[row] + 0.5)


def judged(confidence, right):
    """A text per bin of confidence, and whether all are within what is allowed."""
    texts, is_good = [], True
    for low, high in zip(EDGES, EDGES[1:]):
        inside = (confidence >= low) & ((confidence < high) | (high == 1.0))
        if (count := inside.sum()) < LEAST_PIXELS:
            texts.append("      ")
            continue
        claimed, share = confidence[inside].mean(), right[inside].mean()
        allowed = 0.02 if claimed > 0.9 else 0.03 if claimed > 0.7 else 0.05
        noise = np.sqrt(claimed * (1 - claimed) / count)
        is_good &= abs(share - claimed) <= allowed + 4 * noise
        texts.append(f"{share - claimed:+.3f}")
    return " ".join(texts), is_good


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="CODE", help="names in the first column (all)")
    parser.add_argument("--pixels", type=int, default=250000, help="per code (250000)")
    arguments = parser.parse_args()
    print(f"{'code':29s} {'decoder':8s} " + " ".join(f"{edge:6.3f}" for edge in EDGES[1:]))
    all_good = True
    for name, camera, code, table in cases():
        if arguments.names and name not in arguments.names:
            continue
        decoders = [("zncc", None), ("ml", None)]
        if name.startswith(("sinusoid", "kinect", "multifrequency")) and table is None:
            decoders.append(("unwrap", None))
        decoders += [("zncc", strength) for strength in ("light", "normal", "strong")]
        for method, strength in decoders:
            pixels = arguments.pixels // (1 if method == "zncc" else 5)
            decoder = (Decoder(table, method=method) if table else
                       Decoder(code, camera, method=method))
            texts, is_good = judged(*reliability(decoder, code, camera, strength, pixels))
            all_good &= is_good
            print(f"{name:29s} {strength or method:8s} {texts} {'' if is_good else ' differs'}",
                  flush=True)
    return 0 if all_good else 1


if __name__ == "__main__":
    sys.exit(main())

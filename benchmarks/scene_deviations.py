#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Compares the root mean square error of depths in the built-in scenes with the deviation that
decoding reports.

    PYTHONPATH=BUILD/python /usr/bin/python3 benchmarks/scene_deviations.py [FILTER ...]

Each scene is a part of 96 x 72 pixels of the picture with 320 x 240 pixels. Prints for each class
of pixels the smallest, median and largest ratio over all scenes, codes and light levels. The ratio
is the median over pixels of

    root mean square error / root mean square of the reported deviation,

over the captures of a pixel in which it is ok, for pixels that are ok in at least 80 % of them. The
error includes the bias. In parentheses: the share of ratios within the required range.

Exits with 1 if a ratio is outside of the required range.
"""

import argparse
import sys
from collections import defaultdict

import numpy as np
from scipy import ndimage

import tofsmith as ts

CODES = ("hamiltonian-k4", "multifrequency-k5", "pulsed-multifrequency-k5")
LEVELS_E_PER_S = (5e3, 5e4, 5e5)  # at the median depth of the scene
AMBIENT_E_PER_S = 1e4
FILTERS = ("none", "light", "normal", "strong")
HEIGHT, WIDTH = 72, 96
#: First row and column of the part of each scene.
SCENES = {"table-top": (80, 180), "books": (130, 80), "ball": (20, 200), "corner": (168, 112),
          "room": (168, 112), "hand": (60, 110), "moving-hand": (60, 30)}
#: Required ratios: on surfaces, and within 1 pixel of depth edges and creases.
SURFACE, EDGE = (0.9, 1.15), (0.0, 1.5)
CLASSES = {"flat": SURFACE, "5 to 15 mm/px": SURFACE, "steeper": SURFACE, "crease": EDGE,
           "edge": EDGE}
STEP_MM, CREASE_MM = 30, 2  # depth step at an edge; change of the slope per pixel at a crease
LEAST_OK, LEAST_PIXELS = 0.8, 20


def along(depth_mm, axis):
    """Returns the slope [mm per pixel] along an axis, the pixels on both sides of depth edges, and
    those next to a change of the slope.
    """
    z = np.moveaxis(depth_mm, axis, 0)
    step = np.diff(np.pad(z, ((3, 3), (0, 0)), mode="edge"), axis=0)
    before, here, ahead, after = (step[i:i + len(z)] for i in (1, 2, 3, 4))
    after = np.where(np.arange(len(z))[:, None] < len(z) - 2, after, ahead)
    jump = (np.abs(ahead) > STEP_MM) & (np.abs(ahead) > 3 * np.fmin(np.abs(here), np.abs(after)))
    jump |= np.isnan(ahead) & np.isfinite(z)
    edge = jump | np.roll(jump, 1, 0) | (np.isnan(here) & np.isfinite(z))
    bent = np.abs(ahead - here) > CREASE_MM
    bent[[0, -1]] = edge[[0, -1]] = False
    slope = np.where(np.abs(ahead) < np.abs(here), ahead, here)
    slope[0], slope[-1] = ahead[0], here[-1]
    return [np.moveaxis(plane, 0, axis) for plane in (np.nan_to_num(slope), edge, bent)]


def classes_of(depth_m):
    """Returns the mask of each class, from the true radial distance."""
    (down, *_), (right, *_) = parts = [along(1e3 * depth_m, axis) for axis in (0, 1)]
    edge, bent = (parts[0][i] | parts[1][i] for i in (1, 2))
    square = np.ones((3, 3))
    seen = np.isfinite(depth_m)
    edge &= seen
    crease = ndimage.binary_dilation(bent & ~ndimage.binary_dilation(edge, square), square)
    crease &= seen & ~edge
    slope, surface = np.hypot(down, right), seen & ~edge & ~crease
    masks = (surface & (slope < 5), surface & (slope >= 5) & (slope < 15),
             surface & (slope >= 15), crease, edge)
    return dict(zip(CLASSES, masks))


def part_of(name):
    """Returns a part of a built-in scene, the masks of its classes and the scene's median depth."""
    whole = ts.built_in_scene(name, 320, 240)
    row, column = SCENES[name]
    window = np.s_[row:row + HEIGHT, column:column + WIDTH]
    planes = {key: np.ascontiguousarray(np.asarray(value)[window])
              for key in ("depth_m", "albedo", "cosine", "ambient_scale")
              if np.ndim(value := getattr(whole, key)) == 2}
    masks = {key: mask[window] for key, mask in classes_of(np.asarray(whole.depth_m)).items()}
    return ts.Scene(**planes), masks, float(np.nanmedian(whole.depth_m))


def ratios(image, truth, range_m):
    """Returns the ratio of each pixel (H, W); NaN where it is ok in too few captures."""
    depth, deviation = (np.asarray(p, np.float64) for p in (image.depth_m, image.deviation_m))
    error = depth - truth
    error -= range_m * np.round(error / range_m)
    ok = (np.asarray(image.status) == ts.PixelStatus.ok) & np.isfinite(error)
    squares, predicted = (np.where(ok, np.square(v), 0).sum(0) for v in (error, deviation))
    is_known = ok.mean(0) >= LEAST_OK
    return np.sqrt(np.where(is_known, squares, np.nan) / np.where(is_known, predicted, 1))


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("filters", nargs="*", metavar="FILTER", help=" ".join(FILTERS))
    parser.add_argument("--frames", type=int, default=50, help="captures of each level")
    arguments = parser.parse_args()
    camera = ts.Camera("paper-10f0")
    filters = arguments.filters or FILTERS
    found = {strength: defaultdict(list) for strength in filters}
    for name in SCENES:
        scene, masks, middle_m = part_of(name)
        for code in CODES:
            decoder = ts.Decoder(code, camera)
            for signal in LEVELS_E_PER_S:
                raw = ts.capture(scene, code, camera, signal_e_per_s=signal,
                                 ambient_e_per_s=AMBIENT_E_PER_S, reference_distance_m=middle_m,
                                 frames=arguments.frames)
                for strength in filters:
                    image = decoder.decode(raw, filter=None if strength == "none" else strength,
                                           planes=("depth", "deviation", "status"))
                    ratio = ratios(image, np.asarray(scene.depth_m), camera.range_m)
                    for key, mask in masks.items():
                        part = ratio[mask & np.isfinite(ratio)]
                        if part.size >= LEAST_PIXELS:
                            found[strength][key].append(np.median(part))
    print("| filter | " + " | ".join(CLASSES) + " |\n" + "|---" * (len(CLASSES) + 1) + "|")
    is_met = True
    for strength, cells in found.items():
        shown = []
        for key, (least, most) in CLASSES.items():
            low, middle, high = np.quantile(cells[key], (0, 0.5, 1))
            share = np.mean([least <= ratio <= most for ratio in cells[key]])
            is_met &= bool(share == 1)
            shown.append(f"{low:.2f}, {middle:.2f}, {high:.2f} ({100 * share:.0f} %)")
        print(f"| {strength} | " + " | ".join(shown) + " |")
    sys.exit(0 if is_met else 1)


if __name__ == "__main__":
    main()

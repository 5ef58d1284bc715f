#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Compares the spread of depths over repeated captures with the standard deviation that decoding
predicts.

    /usr/bin/python3 benchmarks/filter_deviation.py TOFSMITH CODE [S ...] [--frames N]

The synthetic scene of 320 x 240 pixels has a signal of S [e/s] at white pixels of any depth. It
consists of a flat plane, a slanted plane, a textured plane with half the slope, and stripes of two
depths. Prints for each class of pixels:

    spread   root mean square of (depth - mean over captures) / predicted deviation
    bias     root mean square of (mean over captures - truth) / predicted deviation, without the
             noise of the mean
    other    share of depths that are closer to another depth of the scene or in another lobe;
             spread and bias exclude them, since the deviation describes the correct peak only
"""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

HEIGHT, WIDTH = 240, 320
AMBIENT_E_PER_S = 1e4
STRIPE_PX, STEP_M = 32, 0.6
SLOPE_M = (0.004, 0.0015)  # per column and row
CLEARANCE_PX = 26  # from the borders between the parts
FILTERS = ("off", "light", "normal", "strong")


def made_scene():
    """Returns the radial distance [m], the albedo, and the mask of each class of pixels."""
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    top, left = y < HEIGHT // 2, x < WIDTH // 2
    across, down = x % (WIDTH // 2), y % (HEIGHT // 2)  # in the part
    depth, albedo = np.full((HEIGHT, WIDTH), 1.5), np.ones((HEIGHT, WIDTH))
    slanted, textured, striped = top & ~left, ~top & left, ~top & ~left
    depth[slanted] = (1.8 + SLOPE_M[0] * across + SLOPE_M[1] * down)[slanted]
    depth[textured] = (2.2 + 0.5 * SLOPE_M[0] * across)[textured]
    depth[striped] = (1.2 + STEP_M * (across // STRIPE_PX % 2))[striped]
    blocks = np.random.default_rng(1).uniform(0.2, 1, (HEIGHT // 3, WIDTH // 3 + 1))
    albedo[textured] = blocks.repeat(3, 0).repeat(3, 1)[:, :WIDTH][textured]
    border = np.minimum(np.minimum(x, WIDTH - 1 - x), np.minimum(y, HEIGHT - 1 - y))
    seam = np.minimum(np.abs(x - WIDTH // 2 + 0.5), np.abs(y - HEIGHT // 2 + 0.5))
    inside = np.minimum(border, seam) >= CLEARANCE_PX
    edge = np.minimum(across % STRIPE_PX, STRIPE_PX - 1 - across % STRIPE_PX)
    beside = striped & (np.minimum(down, HEIGHT // 2 - 1 - down) >= CLEARANCE_PX)
    beside &= (across >= STRIPE_PX // 2) & (across < WIDTH // 2 - STRIPE_PX // 2)
    return depth, albedo, {
        "flat": inside & top & left,
        "slanted": inside & slanted,
        "textured": inside & textured,
        "edge 1 px": beside & (edge == 0),
        "2-3 px": beside & (edge > 0) & (edge < 3),
        "4-12 px": beside & (edge >= 3) & (edge < 12),
        "border 3 px": top & left & (border < 3) & (seam >= CLEARANCE_PX),
    }


def run(program, *arguments):
    done = subprocess.run([program, "--quiet", "--force", *map(str, arguments)],
                          capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"tofsmith {' '.join(map(str, arguments))}\n{done.stderr}")


def decoded(program, raw, code, options):
    """Returns the depth and the predicted deviation of all captures [m] (frames, H, W)."""
    depth = raw.with_name("depth.npy")
    run(program, "decode", raw, "--code", code, *options, "--stack", "--outputs",
        "depth,deviation", "-o", depth)
    return [np.load(file).astype(np.float64).reshape(-1, HEIGHT, WIDTH)
            for file in (depth, raw.with_name("depth-deviation.npy"))]


def judged(depth, deviation, truth, part):
    """Returns spread, bias and share of other depths of the pixels in the mask `part`."""
    z, s, t = depth[:, part], deviation[:, part], truth[part]
    near = np.isfinite(z) & np.isfinite(s) & (np.abs(z - t) < 0.45 * STEP_M)
    other = 1 - near.mean()
    known = near.sum(0) > len(z) / 2
    near, z, s, t = near[:, known], z[:, known], s[:, known], t[known]
    if not known.any():
        return np.nan, np.nan, other
    count = near.sum(0)
    mean = np.where(near, z, 0).sum(0) / count
    spread2 = (np.where(near, ((z - mean) / s) ** 2, 0).sum(0) / (count - 1)).mean()
    predicted2 = np.where(near, s ** 2, 0).sum(0) / count
    bias2 = ((mean - t) ** 2 / predicted2 - spread2 / count).mean()
    return np.sqrt(spread2), np.sqrt(max(bias2, 0)), other


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path, help="the command tofsmith")
    parser.add_argument("code", help="a code's name or file")
    parser.add_argument("signals", nargs="*", type=float, metavar="S", help="[e/s]")
    parser.add_argument("--frames", type=int, default=48, help="captures of each level")
    arguments = parser.parse_args()
    truth, albedo, classes = made_scene()
    with tempfile.TemporaryDirectory() as name:
        directory = Path(name)
        scene, image, raw = (directory / file for file in ("scene.npy", "image.npy", "raw.npy"))
        np.save(scene, truth.astype(np.float32))
        np.save(image, albedo.astype(np.float32))
        print("spread, bias, other | " + " | ".join(classes))
        for signal in arguments.signals or (1e3, 3e3, 1e4, 1e5):
            run(arguments.program, "simulate", scene, "--kind", "radial", "--no-falloff",
                "--camera", "paper-10f0", "--image", image, "--code", arguments.code, "--signal",
                signal, "--ambient", AMBIENT_E_PER_S, "--frames", arguments.frames, "-o", raw)
            for strength in FILTERS:
                options = ("--filter", strength) if strength != "off" else ()
                captures = decoded(arguments.program, raw, arguments.code, options)
                parts = (judged(*captures, truth, part) for part in classes.values())
                shown = (f"{spread:.2f} {bias:.2f} {100 * other:.1f} %"
                         for spread, bias, other in parts)
                print(f"{signal:.0e} {strength} | " + " | ".join(shown), flush=True)


if __name__ == "__main__":
    main()

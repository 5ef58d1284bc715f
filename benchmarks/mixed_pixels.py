#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Fraction of flying pixels at edges that `decode --mixed` detects, and of valid pixels that it
removes.

    /usr/bin/python3 benchmarks/mixed_pixels.py TOFSMITH CODE.code.json [S ...]

Uses the table-top scene with 320 x 240 pixels and a lens blur of half a pixel. Nine times as many
rays determine the visible depths of each pixel. A pixel flies if its depth differs from the
nearest, the farthest and the central ray by more than 30 mm and three predicted standard
deviations. A pixel shows a single surface if its rays differ by less than 30 mm. Such a pixel can
still fly because of large noise; flying pixels at edges are also counted separately. With a filter,
an unmarked flying pixel counts as `right after` if its depth is correct once marked neighbours are
excluded from the average.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

WIDTH, HEIGHT, RAYS = 320, 240, 3
LENS = ("--set", "lens.blur=gaussian", "--set", "lens.blur_sigma_px=0.5",
        "--set", f"lens.pixel_samples={RAYS}")
AMBIENT_E_PER_S = 1e4
REFERENCE_M = 1.93
LEAST_M = 0.03
SNAPPED_M = 0.06
STATUS_MIXED, STATUS_OK = 6, 0
FILTERS = {"each pixel alone": (), "--filter light": ("--filter", "light"),
           "--filter normal": ("--filter", "normal"), "--filter strong": ("--filter", "strong")}


def run(program, *arguments):
    subprocess.run([program, "--quiet", "--force", *map(str, arguments)], check=True,
                   stdout=subprocess.DEVNULL)


def rays_seen(program, code, directory):
    """Nearest, farthest and central depth within each pixel [m]."""
    size = ("--width", WIDTH * RAYS, "--height", HEIGHT * RAYS)
    run(program, "simulate", "table-top", *size, "--code", code, "-o", directory / "raw.npy",
        "--truth", directory / "truth.npy", "--reference-distance", REFERENCE_M)
    truth = np.load(directory / "truth.npy").reshape(HEIGHT * RAYS, WIDTH * RAYS)
    truth = np.where(truth > 0, truth, np.nan).astype(np.float64)
    # The pixel and two standard deviations of blur on each side.
    windows = sliding_window_view(np.pad(truth, RAYS, mode="edge"), (3 * RAYS, 3 * RAYS))
    windows = windows[::RAYS, ::RAYS]
    return (np.nanmin(windows, (2, 3)), np.nanmax(windows, (2, 3)),
            truth[RAYS // 2::RAYS, RAYS // 2::RAYS])


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    program, code, *levels = sys.argv[1:]
    with tempfile.TemporaryDirectory() as name:
        directory = Path(name)
        near, far, middle = rays_seen(program, code, directory)
        print(f"{'S':>7} {'':18} {'flying':>7} {'of them marked':>15} {'at edges':>9} "
              f"{'or right after':>15} "
              f"{'of surface lost':>16} "
              f"{'of edges that lie on one':>25} {'snapped right':>14}")
        for signal in [float(level) for level in levels] or [1e5]:
            raw = directory / "raw.npy"
            run(program, "simulate", "table-top", "--width", WIDTH, "--height", HEIGHT, *LENS,
                "--code", code, "--signal", signal, "--ambient", AMBIENT_E_PER_S,
                "--reference-distance", REFERENCE_M, "-o", raw)
            for title, options in FILTERS.items():
                planes = {}
                for mixed in ("off", "label", "snap"):
                    run(program, "decode", raw, "--code", code, *options, "--outputs",
                        "depth,status,deviation", "-o", directory / "depth.npz",
                        *(() if mixed == "off" else ("--mixed", mixed)))
                    with np.load(directory / "depth.npz") as arrays:
                        planes[mixed] = {k: arrays[k].reshape(HEIGHT, WIDTH) for k in arrays.files
                                         if arrays[k].size == WIDTH * HEIGHT}
                depth, deviation = planes["off"]["depth"], planes["off"]["deviation"]
                limit = np.maximum(LEAST_M, 3 * deviation)
                decoded = planes["off"]["status"] == STATUS_OK
                marked = planes["label"]["status"] == STATUS_MIXED
                off = [np.abs(depth - seen) > limit for seen in (near, far, middle)]
                flying = decoded & off[0] & off[1] & off[2]
                after = planes["label"]["depth"]
                limit_after = np.maximum(LEAST_M, 3 * planes["label"]["deviation"])
                right_after = np.any([np.abs(after - seen) <= limit_after
                                      for seen in (near, far, middle)], axis=0)
                edge = decoded & (far - near >= LEAST_M)
                surface = decoded & (far - near < LEAST_M)
                on_one = edge & ~(off[0] & off[1])
                snapped = planes["snap"]["depth"][marked]
                right = np.minimum(np.abs(snapped - near[marked]),
                                   np.abs(snapped - far[marked])) < SNAPPED_M
                print(f"{signal:7.0e} {title:18} {flying.sum():7} "
                      f"{marked[flying].mean():15.1%} {marked[flying & edge].mean():9.1%} "
                      f"{(marked | right_after)[flying].mean():15.1%} "
                      f"{marked[surface].mean():16.4%} "
                      f"{marked[on_one].mean():25.1%} {right.mean():14.1%}", flush=True)


if __name__ == "__main__":
    main()

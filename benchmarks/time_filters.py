# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Depth errors of the temporal filter for static and moving scenes.

    /usr/bin/python3 benchmarks/time_filters.py BUILD/apps/tofsmith
    /usr/bin/python3 benchmarks/time_filters.py BUILD/apps/tofsmith \\
        --optimized OUT/codes/optimized-k5.code.json

OUT is the output of `tofsmith demo -o OUT`. All methods decode the same raw frames: individual
frames, temporal filter without and with look-ahead, and means of frames. A pixel is moving if its
true depth differs from the previous frame. Target: errors of moving pixels at most 1.2 times the
errors of individual frames, with and without a spatial filter.
"""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

RANGE_M = 9.9930819  # of the default camera, f0 = 15 MHz
SIZE = ("--width", 320, "--height", 240)
AMBIENT_E_PER_S = 1e4
EXPOSURE = ("--set", "exposure_s=0.03")  # 33 frames/s
STATIC_FRAMES, MOVING_FRAMES, FIRST = 16, 10, 3
SPHERE = """
[view]
width_px = 320
height_px = 240

[[plane]]
point_m = [0, 0, 2.5]
normal = [0, 0, -1]

[[sphere]]
centre_m = [{x}, 0, {z}]
radius_m = 0.25
velocity_m_per_s = [{vx}, 0, {vz}]
"""
# Initial position and velocity of the sphere; the hand is built in.
MOTIONS = {
    "across, 1 m/s": {"x": -0.15, "z": 1.25, "vx": 1.0, "vz": 0.0},
    "towards, 1 m/s": {"x": 0.0, "z": 1.4, "vx": 0.0, "vz": -1.0},
    "towards, 0.1 m/s": {"x": 0.0, "z": 1.25, "vx": 0.0, "vz": -0.1},
    "moving-hand": None,
}


class Recordings:
    """Runs the command line in a separate folder."""

    def __init__(self, program, code, folder):
        self.program, self.code, self.folder = program, code, folder

    def run(self, *arguments):
        done = subprocess.run([self.program, "--quiet", "--force", *map(str, arguments)],
                              capture_output=True, text=True, check=False)
        if done.returncode:
            sys.exit(f"tofsmith {' '.join(map(str, arguments))}\n{done.stderr}")

    def simulate(self, scene, signal, frames, *options):
        """True depth of each frame [m], (F, H, W)."""
        size = () if str(scene).endswith(".toml") else SIZE
        self.run("simulate", scene, *size, "--code", self.code, "--signal", signal, "--ambient",
                 AMBIENT_E_PER_S, "--frames", frames, "-o", self.folder / "raw.npy", "--truth",
                 self.folder / "truth.npy", *options)
        truth = np.load(self.folder / "truth.npy").astype(np.float64)
        truth = np.where(truth > 0, truth, np.nan)
        return truth if truth.ndim == 3 else np.broadcast_to(truth, (frames, *truth.shape))

    def moving(self, name, motion, signal, frames):
        """True depth of each frame [m], and the pixels that moved since the previous frame."""
        scene = name
        if motion:
            scene = self.folder / "moving.toml"
            scene.write_text(SPHERE.format(**motion))
        truth = self.simulate(scene, signal, frames, *EXPOSURE, "--reference-distance", 1)
        moved = np.zeros(truth.shape, bool)
        moved[1:] = np.abs(truth[1:] - truth[:-1]) > 1e-4
        moved[:FIRST] = moved[-1:] = False
        return truth, moved

    def errors_m(self, truth, *options, read=()):
        """Circular error of each output frame [m]; NaN without a true depth."""
        output = self.folder / "depth.npy"
        self.run("decode", self.folder / "raw.npy", "--code", self.code, *read, *options,
                 "--memory-mb", 1000, "--stack", "-o", output)
        off = np.abs(np.load(output) - truth) % RANGE_M
        off = np.minimum(off, RANGE_M - off)
        return np.where(np.isfinite(truth) & ~np.isfinite(off), RANGE_M / 4, off)


def static(recordings, signals, space):
    """Mean and median error [mm] of a middle frame of a static scene, and the gain."""
    ways = (("each frame alone", ()), ("--time-filter 64", ("--time-filter", 64)),
            ("--look-ahead 4", ("--time-filter", 64, "--look-ahead", 4)),
            (f"--look-ahead {STATIC_FRAMES}", ("--time-filter", 64, "--look-ahead", STATIC_FRAMES)),
            (f"mean of all {STATIC_FRAMES}", ("--average", STATIC_FRAMES)))
    print("\n| S (e/s) | " + " | ".join(name for name, _ in ways) + " |")
    print("|---" * (1 + len(ways)) + "|")
    for signal in signals:
        truth = recordings.simulate("table-top", signal, STATIC_FRAMES, "--reference-distance", 1.93)
        cells = []
        for name, options in ways:
            frame = 0 if name.startswith("mean") else STATIC_FRAMES // 2 - 1
            if name == "--time-filter 64":
                frame = STATIC_FRAMES - 1
            errors = recordings.errors_m(truth, *options, *space)[frame]
            cells.append(f"{1e3 * np.nanmean(errors):.3g} / {1e3 * np.nanmedian(errors):.3g}")
        print(f"| {signal:g} | " + " | ".join(cells) + " |", flush=True)


def moving(recordings, signals, space):
    """Errors of moving pixels relative to individual frames: median, mean."""
    ways = {"--time-filter 64": ("--time-filter", 64),
            "--look-ahead 4": ("--time-filter", 64, "--look-ahead", 4),
            "mean of 3": None}
    worst = 0.0
    print("\n| motion | S at 1 m (e/s) | pixels | alone (mm) | " +
          " | ".join(ways) + " |")
    print("|---" * (4 + len(ways)) + "|")
    for name, motion in MOTIONS.items():
        for signal in signals:
            truth, moved = recordings.moving(name, motion, signal, MOVING_FRAMES)
            alone = recordings.errors_m(truth, *space, read=EXPOSURE)[moved]
            cells = [f"{1e3 * alone.mean():.3g} / {1e3 * np.median(alone):.3g}"]
            for way, options in ways.items():
                if options is None:
                    errors = means_of_three(recordings, truth, space)[moved]
                else:
                    errors = recordings.errors_m(truth, *options, *space, read=EXPOSURE)[moved]
                ratios = np.median(errors) / np.median(alone), errors.mean() / alone.mean()
                cells.append("{:.2f}, {:.2f}".format(*ratios))
                worst = max(worst, *ratios) if options else worst
            print(f"| {name} | {signal:g} | {moved.sum()} | " + " | ".join(cells) + " |",
                  flush=True)
    print(f"\nworst of the filter in time: {worst:.2f} (asked: at most 1.2)")


def means_of_three(recordings, truth, space):
    """Errors of the mean of each frame with its two neighbours [m]."""
    raw_file = recordings.folder / "raw.npy"
    raw = np.load(raw_file)
    padded = np.concatenate([raw[:1], raw, raw[-1:]]).astype(np.float32)
    np.save(raw_file, (padded[:-2] + padded[1:-1] + padded[2:]) / 3)
    errors = recordings.errors_m(truth, "--averaged", 3, *space, read=EXPOSURE)
    np.save(raw_file, raw)
    return errors


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path, help="the command tofsmith")
    parser.add_argument("--optimized", type=Path,
                        help="file of the code optimized-k5 of `tofsmith demo` (hamiltonian-k4)")
    parser.add_argument("--quick", action="store_true", help="one level of light")
    arguments = parser.parse_args()
    code = str(arguments.optimized) if arguments.optimized else "hamiltonian-k4"
    signals = (1e5,) if arguments.quick else (1e5, 9e5)
    with tempfile.TemporaryDirectory() as folder:
        recordings = Recordings(arguments.program, code, Path(folder))
        for space in ((), ("--filter", "normal")):
            print(f"\n## {' '.join(space) or 'no filter in space'}")
            print("\nStatic: mean / median error in mm, of frame 7 (of frame 15 without look-ahead)")
            static(recordings, (1e5,) if arguments.quick else (1e4, 1e5, 1e6), space)
            print("\nMoving: error over that of frames alone, median, mean")
            moving(recordings, signals, space)


if __name__ == "__main__":
    main()

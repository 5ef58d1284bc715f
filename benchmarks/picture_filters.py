# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Compares the filter with filters of depth images and of phasors on the same raw frames.

    scripts/packages.sh benchmark
    /usr/bin/python3 benchmarks/picture_filters.py BUILD/apps/tofsmith --quick
    /usr/bin/python3 benchmarks/picture_filters.py BUILD/apps/tofsmith --empty
    /usr/bin/python3 benchmarks/picture_filters.py BUILD/apps/tofsmith \\
        --optimized OUT/codes/optimized-k5.code.json --data DIRECTORY

OUT is the output directory of `tofsmith demo -o OUT`. --data adds RGB-D images and meshes; missing
files are reported and skipped. --empty measures only the shares of pixels with status ok: among
pixels without a surface, by distance from the nearest surface, and among pixels with a surface.

Our filter has its default parameters. For each frame, the other filters have the parameters of
their grid with the smallest mean error, which requires the true depth; their input marks the pixels
that have a surface. Errors are circular errors of all pixels with a true depth. A pixel dropped by
another filter gets the depth of the nearest pixel that this filter keeps.
"""

import argparse
import math
import statistics
import subprocess
import sys
import tempfile
import time
from collections import defaultdict
from pathlib import Path

import cv2
import numpy as np

import picture_anchors as anchors

LEVELS_E_PER_S = (3.16e3, 1e4, 1e5)
AMBIENT_E_PER_S = 1e4
LENS = ("--set", "lens.blur=gaussian", "--set", "lens.blur_sigma_px=0.5",
        "--set", "lens.pixel_samples=3")
PLANES = ("table-top", "room", "corner", "wall")
CLEARANCES_PX = (13, 24)
OURS = ("light", "normal", "strong")
BUILT_IN = ("table-top", "hand", "room", "corner")
EMPTY_SCENES = ("hand", "moving-hand", "ball")
EMPTY_LEVELS_E_PER_S = (1e3, 3e3, 5e3, 1e4, 3e4, 1e5, 1e7)
EMPTY_DISTANCES_PX = ((1, 1), (2, 2), (3, 4), (5, 8), (9, 12), (13, 10**6))
# Depth and image files, relative to --data. PNG images are sRGB, NPY images are linear.
RGB_D = {
    "bottles": ("pcl_tabletop/bottles_floor_depth_m.npy", "pcl_tabletop/bottles_floor_rgb.png"),
    "carton": ("pcl_tabletop/floor_bottles_carton_depth_m.npy",
               "pcl_tabletop/floor_bottles_carton_rgb.png"),
    "cornell-box": ("tofsim_cbox/cbox_depthmap_nr-240_nc-320.npy",
                    "tofsim_cbox/cbox_rgb_nr-240_nc-320.npy"),
    "v-groove": ("vgroove_depth_rgb/vgroove_depth.npy", "vgroove_depth_rgb/vgroove_rgb.npy"),
}
MESHES = {"mesh-hand": "meshes/hand_lowres.obj", "mesh-spot": "meshes/spot_low_resolution.obj"}


class Camera:
    """Runs the command line with the camera paper-10f0."""

    def __init__(self, program, directory):
        self.program, self.directory = program, directory
        self.medians_m = {}

    def run(self, *arguments):
        done = subprocess.run([self.program, "--quiet", "--force", *map(str, arguments)],
                              capture_output=True, text=True, check=False)
        if done.returncode:
            sys.exit(f"tofsmith {' '.join(map(str, arguments))}\n{done.stderr}")

    def capture(self, scene, code, signal, ambient, *options):
        """Returns the file of raw measurements and the true distances [m] (H, W), NaN where a pixel
        has no surface.
        """
        raw, truth = self.directory / "raw.npy", self.directory / "truth.npy"
        self.run("simulate", *scene, "--code", code, "--camera", "paper-10f0", "--signal", signal,
                 "--ambient", ambient, "-o", raw, "--truth", truth, *options)
        truth = np.load(truth)
        truth = (truth[0] if truth.ndim == 3 else truth).astype(np.float64)
        return raw, np.where(truth > 0, truth, np.nan)

    def decode(self, raw, code, *options):
        depth = self.directory / "depth.npy"
        self.run("decode", raw, "--code", code, "-o", depth, *options)
        return np.load(depth).squeeze()

    def is_ok(self, raw, code, *options):
        """Returns the mask of pixels with status ok."""
        decoded = self.directory / "status.npz"
        self.run("decode", raw, "--code", code, "-o", decoded, "--outputs", "status", *options)
        return np.load(decoded)["status"].squeeze() == 0

    def table(self, code, samples=1000):
        """Returns the measurements (N, K) of a signal of 1 e/s at `samples` depths of the range."""
        depth = np.arange(samples) * anchors.RANGE_M / samples
        depth[0] = 1e-6
        np.save(self.directory / "ramp.npy", depth.reshape(1, samples).astype(np.float32))
        ramp = (self.directory / "ramp.npy", "--kind", "radial", "--no-falloff")
        raw, _ = self.capture(ramp, code, 1e15, 0, "--set", "sensor.read_noise_e=0")
        return np.load(raw).reshape(samples, -1).astype(np.float64) / 1e15

    def lit(self, name, scene, code, signal, *options):
        """Captures a scene with the given signal at its median depth."""
        if name not in self.medians_m:
            self.medians_m[name] = np.nanmedian(self.capture(scene, code, 1, 1)[1])
        return self.capture(scene, code, signal, AMBIENT_E_PER_S,
                            "--reference-distance", self.medians_m[name], *options)


def prepared(name, data, directory):
    """Returns arguments of an RGB-D scene of up to 320 x 240 pixels, or None without its files."""
    depth_file, image_file = (data / part for part in RGB_D[name])
    if not depth_file.exists() or not image_file.exists():
        return None
    depth, image = np.load(depth_file), anchors.linear_image(image_file)
    step = -(-depth.shape[1] // 320)
    rows, columns = (n // step for n in depth.shape)
    image = image[: rows * step, : columns * step].reshape(rows, step, columns, step).mean((1, 3))
    albedo = np.clip(image / np.quantile(image, 0.95), 0.02, 1).astype(np.float32)
    np.save(directory / f"{name}.npy", depth[::step, ::step][:rows, :columns].astype(np.float32))
    np.save(directory / f"{name}-albedo.npy", albedo)
    return (directory / f"{name}.npy", "--image", directory / f"{name}-albedo.npy")


def scenes(arguments, directory):
    """Returns names, arguments of `simulate`, and whether the scene is from --data."""
    if arguments.quick:
        return [("table-top", ("table-top", "--width", 160, "--height", 120), False)]
    size = ("--width", 320, "--height", 240)
    found = [(name, (name, *size), False) for name in BUILT_IN]
    if not arguments.data:
        print("no --data: RGB-D images and meshes left out", file=sys.stderr)
        return found
    outside = {name: prepared(name, arguments.data, directory) for name in RGB_D}
    for name, file in MESHES.items():
        there = (arguments.data / file).exists()
        outside[name] = (arguments.data / file, *size) if there else None
    for name, scene in outside.items():
        if scene is None:
            print(f"{name}: not in {arguments.data}, left out", file=sys.stderr)
        else:
            found.append((name, scene, True))
    return found


def error_mm(depth, truth):
    """Returns the mean and median circular error [mm]; the error of a missing depth is a quarter of
    the range.
    """
    seen = np.isfinite(truth)
    off = np.abs(depth[seen] - truth[seen]) % anchors.RANGE_M
    off = np.where(np.isfinite(off), np.minimum(off, anchors.RANGE_M - off), anchors.RANGE_M / 4)
    return 1e3 * off.mean(), 1e3 * np.median(off)


def edge_shifts_px(depth, truth, least_step_m=0.2, side=4):
    """Returns the shifts of depth edges along rows and columns [px].

    A true edge is a step with `side` level pixels on both sides. The shift is the distance to the
    nearest place where the depth crosses the middle of the step, at most `side`.
    """
    shifts = []
    for z, t in ((depth, truth), (depth.T, truth.T)):
        z, t = z.astype(np.float64), np.where(np.isfinite(t), t, 1e9)
        for x in range(side - 1, t.shape[1] - side):
            near = slice(x - side + 1, x + side + 1)
            step = t[:, x + 1] - t[:, x]
            halves = t[:, near].reshape(-1, 2, side)
            level = np.ptp(halves, axis=2).max(1)
            rows = (least_step_m < np.abs(step)) & (np.abs(step) < 100)
            rows &= level < 0.25 * np.abs(step)
            share = (z[rows, near] - t[rows, x, None]) / step[rows, None] - 0.5
            below, above = share[:, :-1], share[:, 1:]
            crosses = (below < 0) & (above >= 0)
            at = np.arange(2 * side - 1) - (side - 1) - 0.5
            at = at + np.where(crosses, -below / np.where(crosses, above - below, 1), np.inf)
            shifts.append(np.minimum(np.abs(at).min(1), side))
    return np.concatenate(shifts)


def plane_bias(camera, code, name, signal, frames):
    """Returns the number of pixels on planes and the rms bias of their depth, in units of its
    standard deviation over frames, for each of CLEARANCES_PX: the minimum distance from edges,
    creases and the border of the image.
    """
    scene = (name, "--width", 320, "--height", 240)
    raw, truth = camera.lit(f"{name} of planes", scene, code, signal, "--frames", frames)
    depth = camera.decode(raw, code, "--filter", "normal", "--stack")
    camera.run("scene", *scene, "-o", camera.directory / "scene")
    z = np.load(camera.directory / "scene" / "z.npy").astype(np.float64)
    error = depth.astype(np.float64) - truth
    mean, variance = error.mean(0), error.var(0, ddof=1)
    found = []
    for clearance in CLEARANCES_PX:
        part = anchors.planes(z, clearance) & (np.sqrt(variance) < 0.3)
        if part.sum() < 500:
            found.append((int(part.sum()), math.nan))
            continue
        noise = variance[part].mean()
        own = (mean[part] ** 2).mean() - noise / frames  # subtracts the noise of the mean
        found.append((int(part.sum()), math.sqrt(max(own, 0) / noise)))
    return found


def with_holes(camera, directory):
    """Writes a depth image of a wall with holes of 3 to 60 pixels and gaps of 4 to 24 pixels."""
    depth = np.full((240, 320), 1.5, np.float32)
    y, x = np.mgrid[:240, :320]
    for row, radius in ((50, 1), (50, 4), (50, 10), (50, 30)):
        depth[(y - row) ** 2 + (x - 8 * radius - 20) ** 2 <= radius ** 2] = np.nan
    for left, width in ((20, 4), (60, 8), (110, 12), (170, 24)):
        depth[120:220, left:left + width] = np.nan
    file = directory / "holes.npy"
    np.save(file, depth)
    return (file, "--kind", "radial")


def empty_report(camera, code, frames):
    """Prints the shares of ok pixels without and with filters, by distance from a surface."""
    near = [f"{a}" if a == b else f"{a}-{b}" if b < 1000 else f"{a} on" for a, b in
            EMPTY_DISTANCES_PX]
    print(f"\nok pixels in %, {label(code)}, {frames} frames\n")
    print("| scene | S (e/s) | filter | all empty | " + " | ".join(f"{n} px" for n in near) +
          " | surface |")
    print("|---" * (5 + len(near)) + "|")
    scenes = {name: (name, "--width", 320, "--height", 240) for name in EMPTY_SCENES}
    scenes["holes"] = with_holes(camera, camera.directory)
    for name, scene in scenes.items():
        for signal in EMPTY_LEVELS_E_PER_S:
            shares = defaultdict(list)
            for seed in range(1, frames + 1):
                raw, truth = camera.lit(name, scene, code, signal, "--seed", seed)
                empty = np.isnan(truth)
                away = cv2.distanceTransform(empty.astype(np.uint8), cv2.DIST_C, 3)
                parts = [empty] + [(away >= a) & (away <= b) for a, b in EMPTY_DISTANCES_PX]
                for strength in ("alone", *OURS):
                    options = ("--filter", strength) if strength != "alone" else ()
                    ok = camera.is_ok(raw, code, *options)
                    shares[strength].append([ok[part].mean() if part.any() else math.nan
                                             for part in (*parts, ~empty)])
            for strength, found in shares.items():
                shown = " | ".join(f"{100 * share:.2f}" for share in np.mean(found, 0))
                print(f"| {name} | {signal:g} | {strength} | {shown} |", flush=True)


def measured(camera, code, name, scene, signal, lens, shifts):
    """Returns the mean and median error [mm] of every method in one cell of the table."""
    raw, truth = camera.lit(name, scene, code, signal, *(LENS if lens else ()))
    measurements = np.load(raw).squeeze().astype(np.float64)
    alone = camera.decode(raw, code)
    errors = {"alone": error_mm(alone, truth)}
    ours = {strength: camera.decode(raw, code, "--filter", strength) for strength in OURS}
    seen = np.isfinite(truth)
    candidates = anchors.of_depth(anchors.spread(alone, seen & np.isfinite(alone)))
    if code in anchors.HARMONICS:
        phasors = anchors.Phasors(camera.table(code), anchors.HARMONICS[code])
        candidates = {**candidates, **phasors.filters(measurements, seen)}
    chosen = {}
    for anchor, depths in candidates.items():
        judged = [(error_mm(depth, truth), parameters) for parameters, depth in depths]
        errors[anchor], chosen[anchor] = min(judged, key=lambda found: found[0][0])
    for strength, depth in ours.items():
        errors[strength] = error_mm(depth, truth)
    for shown, depth in (("normal", ours["normal"]), ("alone", alone)):
        shifts[code, signal, lens, shown].append(edge_shifts_px(depth, truth))
    where = f"{label(code)} {name} {signal:g} {'lens' if lens else 'sharp'}"
    print(f"{where}: {chosen}", file=sys.stderr)
    return errors


def label(code):
    """Returns the name of a code or of a code file."""
    return Path(code).name.removesuffix(".code.json")


def report(code, cells):
    """Prints the mean / median error [mm] of each method for one code, and the ratio of errors."""
    names = sorted({name for errors in cells.values() for name in errors}, key=ORDER.index)
    print(f"\n## {label(code)}\n")
    print("| scene | S (e/s) | lens | " + " | ".join(names) + " | best other / normal |")
    print("|---" * (len(names) + 4) + "|")
    for (name, signal, lens), errors in cells.items():
        shown = ["{:.3g} / {:.3g}".format(*errors[m]) if m in errors else "" for m in names]
        where = f"{name} | {signal:g} | {'yes' if lens else 'no'}"
        print(f"| {where} | {' | '.join(shown)} | {ratio(errors):.2f} |")
    sys.stdout.flush()


ORDER = ("alone", *anchors.NAMES, *OURS)


def ratio(errors, strength="normal"):
    """Returns the mean error of the best other filter divided by that of our filter."""
    return min(e[0] for m, e in errors.items() if m not in OURS) / errors[strength][0]


def summary(results, outside):
    """Prints the number of --data cells at dim light with a ratio of at least 1.5, and all cells
    with a ratio below 1.
    """
    print("\n## Summary\n")
    for code, cells in results.items():
        dim = {c: ratio(e) for c, e in cells.items()
               if c[0] in outside and c[1] < max(LEVELS_E_PER_S)}
        worse = {c: ratio(e) for c, e in cells.items() if ratio(e) < 1}
        if dim:
            good = sum(r >= 1.5 for r in dim.values())
            print(f"- {label(code)}: RGB-D and meshes at the dimmer levels: "
                  f">= 1.5x in {good} of {len(dim)} cells, "
                  f"median {statistics.median(dim.values()):.2f}x, least {min(dim.values()):.2f}x")
        listed = [f"{n} {s:g}{' lens' if lens else ''} {r:.2f}x"
                  for (n, s, lens), r in worse.items()]
        middle = statistics.median(map(ratio, cells.values()))
        print(f"- {label(code)}: all {len(cells)} cells: median {middle:.2f}x; "
              f"worse than the best other in {len(worse)}: {', '.join(listed) or 'none'}")


def edges_report(shifts):
    """Prints the shifts of depth edges by code, light level and lens."""
    print("\nShift of depth edges (asked: median < 0.2 pixel)\n")
    print("| code | S (e/s) | lens | depth | edges | median (px) | beyond half a pixel |")
    print("|---|---|---|---|---|---|---|")
    for (code, signal, lens, shown), parts in shifts.items():
        moved = np.concatenate(parts)
        if moved.size:
            where = f"{label(code)} | {signal:g} | {'yes' if lens else 'no'} | {shown}"
            print(f"| {where} | {moved.size} | "
                  f"{np.median(moved):.3f} | {100 * (moved > 0.5).mean():.1f} % |")


def planes_report(camera, code, levels, frames):
    """Prints the bias on planes by scene and light level."""
    print(f"\nrms bias / sigma of `normal` on planes (asked < 0.1), {label(code)}, {frames} frames")
    print()
    columns = "".join(f" pixels {n} from any edge | bias |" for n in CLEARANCES_PX)
    print(f"| scene | S (e/s) |{columns}")
    print("|---" * (2 + 2 * len(CLEARANCES_PX)) + "|")
    for name in PLANES:
        for signal in levels:
            parts = plane_bias(camera, code, name, signal, frames)
            shown = " | ".join(f"{pixels} | {bias:.3f}" for pixels, bias in parts)
            print(f"| {name} | {signal:g} | {shown} |")


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path, help="the command tofsmith")
    parser.add_argument("--optimized", type=Path,
                        help="file of the code optimized-k5 of `tofsmith demo`")
    parser.add_argument("--data", type=Path, help="directory of RGB-D images and meshes")
    parser.add_argument("--quick", action="store_true", help="table-top alone at one level, small")
    parser.add_argument("--empty", action="store_true", help="only pixels without a surface")
    parser.add_argument("--frames", type=int, default=4, help="with --empty: frames of each scene")
    arguments = parser.parse_args()
    if arguments.empty:
        with tempfile.TemporaryDirectory() as folder:
            code = str(arguments.optimized or "hamiltonian-k4")
            empty_report(Camera(arguments.program, Path(folder)), code, arguments.frames)
        return
    codes = [str(arguments.optimized)] if arguments.optimized else []
    codes += list(anchors.HARMONICS)
    levels = LEVELS_E_PER_S[1:2] if arguments.quick else LEVELS_E_PER_S
    start, shifts, results = time.monotonic(), defaultdict(list), {}
    with tempfile.TemporaryDirectory() as folder:
        camera = Camera(arguments.program, Path(folder))
        found = scenes(arguments, camera.directory)
        print("Mean / median error in mm; S at the median depth of the scene, A = 1e4 e/s")
        for code in codes:
            results[code] = {
                (name, signal, lens): measured(camera, code, name, scene, signal, lens, shifts)
                for name, scene, _ in found for lens in (False, True) for signal in levels}
            report(code, results[code])
        summary(results, {name for name, _, outside in found if outside})
        edges_report(shifts)
        planes_report(camera, codes[0], levels, 8 if arguments.quick else 32)
    print(f"\n{time.monotonic() - start:.0f} s", file=sys.stderr)


if __name__ == "__main__":
    main()

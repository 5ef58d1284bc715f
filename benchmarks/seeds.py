#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Measures how much designs depend on the seed. Designs codes for the same camera with several
seeds (`--method optimize` at the default effort) and judges each winner with the same fresh random
numbers. Prints errors in mm and, for each camera, the spread: the largest error divided by the
smallest, minus 1. Required: at most 1 % plus four standard errors of judging.

Exits with 1 if the spread of a fixed camera is larger, or with --random if it is larger for more
than 5 % of the cameras or exceeds 2 % for any.
"""

import argparse
import json
import random
import resource
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

REQUIRED, REQUIRED_OF_ALL, SHARE_OF_CAMERAS = 0.01, 0.02, 0.95
#: Linear errors have a larger standard error, due to depths decoded at the other end of the range.
TRIALS = {"circular": 40000, "linear": 400000}
JUDGING_SEED = 77


class Camera(NamedTuple):
    """Changes to the camera paper-10f0."""

    taps: int
    exposures: int  # 0: numbers of exposures that design tries by default
    peak: float
    limit_f0: float
    response: str = "hann"
    error: str = "circular"
    f0_mhz: float = 15.0

    def words(self):
        limit = "f_max_hz" if self.response == "hann" else "cutoff_hz"
        response = f'{{ kind = "{self.response}", {limit} = {self.limit_f0 * self.f0_mhz * 1e6} }}'
        keys = {"fundamental_frequency_hz": self.f0_mhz * 1e6, "sensor.taps": self.taps,
                "light.peak_factor": self.peak, "operating.error": f'"{self.error}"',
                "light.impulse_response": response, "sensor.impulse_response": response}
        settings = (("--set", f"{key}={value}") for key, value in keys.items())
        return ["--camera", "paper-10f0", "--threads", "1", *(word for pair in settings for word in pair)]


#: The first eight have their best number of exposures.
CAMERAS = (Camera(1, 5, 10, 10), Camera(1, 3, 5, 5), Camera(2, 4, 10, 10), Camera(2, 4, 5, 14),
           Camera(3, 2, 10, 10), Camera(3, 3, 11, 14), Camera(4, 2, 10, 10), Camera(4, 2, 11, 14),
           Camera(1, 0, 12, 13, error="linear"),
           Camera(1, 0, 3, 6, response="lowpass", error="linear", f0_mhz=10),
           Camera(1, 0, 15, 5, f0_mhz=20))


def random_cameras(count, seed):
    draw = random.Random(seed)
    return [Camera(taps=draw.randint(1, 4), exposures=0, peak=round(2 * 20 ** draw.random(), 1),
                   limit_f0=round(3 * 10 ** draw.random(), 1), response=draw.choice(("hann", "lowpass")),
                   error=draw.choice(("linear", "circular")), f0_mhz=round(5 * 10 ** draw.random(), 1))
            for _ in range(count)]


def run(*words):
    return json.loads(subprocess.run(words, check=True, capture_output=True, text=True).stdout)


def cpu_s():
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime


def designed(tool, camera, seed):
    """Returns the name of the winner, its error and standard error [m] and the CPU time [s]."""
    words = camera.words()
    exposures = ["--exposures", str(camera.exposures)] if camera.exposures else []
    with tempfile.TemporaryDirectory() as folder:
        out = str(Path(folder) / "design")
        begin_s = cpu_s()
        best = run(tool, "design", *words, "--method", "optimize", *exposures, "--seed", str(seed),
                   "-o", out, "--json", "--quiet")["best"]
        seconds = cpu_s() - begin_s
        code = str(Path(out) / "codes" / f"{best}.code.json")
        judged = run(tool, "evaluate", code, *words, "--trials", str(TRIALS[camera.error]),
                     "--seed", str(JUDGING_SEED), "--json", "--quiet")["codes"][0][camera.error]
    return best, judged["geometric_mean_m"], judged["geometric_mean_se_m"], seconds


def stored_designs(store):
    if not store or not store.exists():
        return {}
    items = (json.loads(line) for line in store.read_text(encoding="utf-8").splitlines())
    return {(Camera(*item["camera"]), item["seed"]): item["found"] for item in items}


def spread_of(camera, found):
    """Prints the results of a camera. Returns the spread minus four standard errors of judging."""
    errors_mm = [1e3 * error for _, error, _, _ in found]
    deviation_mm = 1e3 * max(deviation for _, _, deviation, _ in found)
    spread = max(errors_mm) / min(errors_mm) - 1
    names = ", ".join(sorted({name for name, _, _, _ in found}))
    seconds = statistics.mean(seconds for _, _, _, seconds in found)
    limit = f"{camera.limit_f0:g} {camera.response}"
    print(f"{camera.taps}  {camera.peak:g}  {limit}  {camera.f0_mhz:g}  {camera.error}  "
          f"{min(errors_mm):.2f}  {statistics.median(errors_mm):.2f}  {max(errors_mm):.2f}  "
          f"{deviation_mm:.3f}  {spread:.2%}  {seconds:.1f}  {names}", flush=True)
    return spread - 4 * deviation_mm / min(errors_mm)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tool", help="the program tofsmith")
    parser.add_argument("seeds", nargs="?", type=int, default=10, help="number of seeds (default 10)")
    parser.add_argument("store", nargs="?", type=Path, help="file of finished designs, which are not repeated")
    parser.add_argument("--random", type=int, metavar="N", help="use N random cameras instead of the fixed ones")
    parser.add_argument("--cameras-seed", type=int, default=1, help="seed of the random cameras (default 1)")
    options = parser.parse_args()
    cameras = random_cameras(options.random, options.cameras_seed) if options.random else CAMERAS
    designs = stored_designs(options.store)
    print("taps  peak  limit (f0)  f0 (MHz)  error  least (mm)  median  largest  standard error  spread  CPU (s)  found")
    spreads = []
    for camera in cameras:
        for seed in range(1, options.seeds + 1):
            if (camera, seed) not in designs:
                designs[camera, seed] = designed(options.tool, camera, seed)
                if options.store:
                    item = {"camera": camera, "seed": seed, "found": designs[camera, seed]}
                    with options.store.open("a", encoding="utf-8") as file:
                        file.write(json.dumps(item) + "\n")
        spreads.append(spread_of(camera, [designs[camera, seed] for seed in range(1, options.seeds + 1)]))
    share = sum(spread <= REQUIRED for spread in spreads) / len(spreads)
    print(f"{share:.0%} of {len(spreads)} cameras within {REQUIRED:.0%}")
    met = share >= SHARE_OF_CAMERAS and max(spreads) <= REQUIRED_OF_ALL if options.random else share == 1
    sys.exit(not met)


if __name__ == "__main__":
    main()

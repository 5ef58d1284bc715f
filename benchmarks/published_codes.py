#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Compares published codes with codes of `design` for the same camera, and prints the table of
docs/comparison.md. Needs NumPy.

    published_codes.py TOFSMITH FOLDER ... [--camera paper-10f0] [--effort 1] [--store FILE.jsonl]

Codes are .npz files with modfs and demodfs, or pairs NAME-light.npy, NAME-gates.npy. If the second
half of the columns is the complement of the first, they are two taps of one exposure. The peak of
the camera is raised if a code needs it. Our code is designed for that camera with the same number
of exposures and taps. Both are evaluated on the same 40000 new trials per light level: circular
error, geometric mean over the levels. Codes of rows of one exposure are compared by rows.py.
"""

import argparse
import json
import subprocess
import tempfile
from pathlib import Path

import numpy as np

TRIALS, JUDGING_SEED = 40000, 77


def run(*words):
    done = subprocess.run([*map(str, words), "--json", "--quiet"], capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, words))}\n{done.stderr}")
    return json.loads(done.stdout)


def codes_in(folder):
    """Name of each code for `tofsmith`, with its light and gates (N, K)."""
    for path in sorted(folder.rglob("*.npz")):
        with np.load(path) as arrays:
            if {"modfs", "demodfs"} <= set(arrays):
                yield str(path), arrays["modfs"], arrays["demodfs"]
    for light in sorted(folder.rglob("*-light.npy")):
        gates = light.with_name(light.name.replace("-light.npy", "-gates.npy"))
        arrays = [np.load(path) for path in (light, gates)]
        along_rows = [a.T if a.ndim == 2 and a.shape[1] > a.shape[0] else a for a in arrays]
        yield f"{light},{gates}", along_rows[0].reshape(len(along_rows[1]), -1), along_rows[1]


def judged(code, light, gates, arguments):
    """Name, exposures, taps, peak factor, both errors and a standard error [mm]."""
    columns = gates.shape[1]
    half = columns // 2
    taps = 2 if columns % 2 == 0 and np.allclose(gates[:, :half] + gates[:, half:], gates.max()) else 1
    exposures = columns // taps
    camera = run(arguments.tool, "cameras", arguments.camera)
    # `tofsmith` keeps the scale of archives and normalizes the brightest light of pairs to mean 1.
    peak = light.max() if code.endswith(".npz") else light.max() / light.mean(0).max()
    peak = max(camera["camera"]["light"]["peak_factor"], float(peak))
    words = ["--camera", arguments.camera, "--set", f"sensor.taps={taps}", "--set",
             'operating.error="circular"', "--set", f"light.peak_factor={peak!r}"]
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "design"
        best = run(arguments.tool, "design", *words, "--exposures", exposures, "--effort",
                   arguments.effort, "-o", out)["best"]
        order = ["--taps", 2, "--tap-order", "blocked"] if taps == 2 else []
        theirs = run(arguments.tool, "evaluate", code, *words, *order, "--trials", TRIALS, "--seed",
                     JUDGING_SEED)["codes"][0]
        ours = run(arguments.tool, "evaluate", out / "codes" / f"{best}.code.json", *words,
                   "--trials", TRIALS, "--seed", JUDGING_SEED)["codes"][0]["circular"]
    errors = [1e3 * theirs["circular"]["geometric_mean_m"], 1e3 * ours["geometric_mean_m"],
              1e3 * ours["geometric_mean_se_m"]]
    return [theirs["name"], exposures, taps, peak, errors]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("tool")
    parser.add_argument("folders", nargs="+", type=Path)
    parser.add_argument("--camera", default="paper-10f0")
    parser.add_argument("--effort", default="1")
    parser.add_argument("--store", type=Path, help="what is in it is not done again")
    arguments = parser.parse_args()
    kept = {}
    if arguments.store and arguments.store.exists():
        for line in arguments.store.read_text(encoding="utf-8").splitlines():
            item = json.loads(line)
            kept[item["code"]] = item["found"]
    print("| code | exposures | taps | peak factor | theirs (mm) | ours (mm) | ratio |\n"
          "|---|---|---|---|---|---|---|")
    worse = 0
    for folder in arguments.folders:
        for code, light, gates in codes_in(folder):
            if code not in kept:
                kept[code] = judged(code, light, gates, arguments)
                if arguments.store:
                    with arguments.store.open("a", encoding="utf-8") as file:
                        file.write(json.dumps({"code": code, "found": kept[code]}) + "\n")
            name, exposures, taps, peak, (theirs, ours, error) = kept[code]
            worse += ours > theirs + 4 * error
            print(f"| `{name}` | {exposures} | {taps} | {peak:.4g} | {theirs:.2f} | "
                  f"{ours:.2f} ± {error:.2f} | {theirs / ours:.2f} |", flush=True)
    raise SystemExit(1 if worse else 0)


if __name__ == "__main__":
    main()

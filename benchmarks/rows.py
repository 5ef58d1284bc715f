#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Designs rows of one exposure for the cameras of published learned codes and compares the errors:
N = 1024 time bins at 5 MHz, 1000 photons in total, response exp(-(t / sigma)^2), and either no
limit on the light or at most a fraction P of all photons per bin (then light and sensor both have
the response).

    benchmarks/rows.py [--tofsmith build/apps/tofsmith] [--rows 8] [--trials 20000] [--cells 0,1,..]
                       [--codes FOLDER ...]
    benchmarks/rows.py --gated          8 exposures of one tap instead of rows, 100 photons in total
    benchmarks/rows.py --least SIGMA    smallest Cramer-Rao bounds of 4, 5 and 6 tones; needs NumPy

Circular errors [mm] by normalized cross-correlation (with --decoder plain: of rows that are not
whitened): mean absolute errors and, in columns called rms, root mean square errors. `learned` and
`gates` are published mean absolute errors of learned codes and of codes of separate exposures
converted to rows. `histogram` is the bound of all 1024 bins with our light. At a tenth of the light
our codes are compared with a truncated Fourier series. With --codes, your codes are evaluated on
the same trials: FOLDER/SIGMA-P-RATIO/light.npy and rows.npy, for example 10-none-1 or 5-.015-.1.
"""

import argparse
import json
import math
import subprocess
import tempfile
import time
from pathlib import Path

SAMPLES, FREQUENCY_HZ = 1024, 5e6
RATIOS = (1, .1)  # signal / background
# sigma [bins], P, then learned and gates at both ratios
CELLS = [
    (10, None, (6.8, 14.5), (7.3, 16.8)),
    (20, None, (13.9, 31.0), (13.6, 27.7)),
    (30, None, (19.6, 40.2), (21.2, 42.4)),
    (1, .005, (30.8, 77.9), (19.9, 50.2)),
    (1, .015, (24.3, 65.8), (10.7, 23.2)),
    (1, .030, (17.4, 49.0), (11.1, 23.4)),
    (5, .005, (15.7, 36.9), (18.8, 41.5)),
    (5, .015, (10.7, 26.8), (11.2, 24.3)),
    (5, .030, (10.4, 25.1), (10.7, 22.1)),
    (10, .005, (25.3, 61.3), (21.1, 50.8)),
    (10, .015, (11.5, 24.2), (12.4, 28.9)),
    (10, .030, (10.6, 22.1), (12.7, 26.0)),
]
ASKED = .93  # limit of the ratio to the better of learned and gates


def camera_toml(sigma_bins, peak, signal_to_background, photons, readout="rows", decoder=None):
    """The response exp(-(t / sigma)^2) is a Gaussian with an attenuation of 3 dB at its cutoff."""
    sigma_s = sigma_bins / (SAMPLES * FREQUENCY_HZ)
    cutoff_hz = math.sqrt(.5 * math.log(2)) / (math.pi * sigma_s)
    response = f'{{ kind = "gaussian", cutoff_hz = {cutoff_hz!r} }}'
    peak_factor = SAMPLES if peak is None else peak * SAMPLES
    sensor = "" if peak is None else f"impulse_response = {response}\n"
    if decoder is not None:
        sensor += f'decoder = "{decoder}"\n'
    return (f"fundamental_frequency_hz = {FREQUENCY_HZ}\nexposure_s = 1\nsamples = {SAMPLES}\n"
            f"[light]\npeak_factor = {peak_factor}\nimpulse_response = {response}\n"
            f'[sensor]\nreadout = "{readout}"\nread_noise_e = 0\n{sensor}'
            f"[operating]\nsignal_e_per_s = [{photons}]\n"
            f"ambient_e_per_s = [{photons / signal_to_background}]\nerror = \"circular\"\n")


def run(tool, *arguments):
    done = subprocess.run([tool, *arguments, "--json"], capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join([tool, *arguments])}\n{done.stderr}")
    return json.loads(done.stdout)


def errors_of(report):
    """Mean absolute and root mean square circular error [mm]."""
    return [1e3 * report[kind]["geometric_mean_m"] for kind in ("circular", "circular_rmse")]


def judged(tool, codes, camera, arguments):
    """Reports of the codes, on the same trials."""
    return run(tool, "evaluate", *codes, "--camera", str(camera), "--trials", str(arguments.trials),
               "--seed", "11", "--method", arguments.method)["codes"]


def codes_of(folders, name):
    """NPY pairs for one camera."""
    pairs = []
    for folder in folders:
        light, rows = (Path(folder) / name / f"{part}.npy" for part in ("light", "rows"))
        if rows.exists():
            pairs.append(f"{light},{rows}")
    return pairs


def least_bounds(sigma_bins):
    """Smallest bounds of all sets of tones up to the 16th, as mean absolute errors. Uses the
    shortest pulse, which is optimal without a limit on the light."""
    import itertools

    import numpy as np

    bins, range_mm = np.arange(SAMPLES), 1e3 * 299792458 / (2 * FREQUENCY_HZ)
    light = np.exp(-(np.minimum(bins, SAMPLES - bins) / sigma_bins) ** 2.0)
    light /= light.sum()
    spectrum = np.fft.rfft(light)
    slope = np.fft.irfft(spectrum * 2j * np.pi * np.arange(len(spectrum)), SAMPLES)
    tones = np.arange(1, 17)
    angle = 2 * np.pi * tones[:, None] * bins / SAMPLES
    rows = np.stack([np.cos(angle), np.sin(angle)], 1).reshape(-1, SAMPLES)

    def error_mm(information):
        return range_mm * math.sqrt(2 / math.pi * np.linalg.inv(information)[0, 0])

    for ratio in RATIOS:
        counts = 1000 * light + 1000 / ratio / SAMPLES
        columns = np.stack([1000 * slope, light, np.full(SAMPLES, 1 / SAMPLES)])
        covariance, mean = (rows * counts) @ rows.T, rows @ columns[:2].T
        print(f"S/B {ratio}: histogram {error_mm((columns / counts) @ columns.T):.2f} mm")
        for number in (4, 5, 6):
            found = []
            for chosen in itertools.combinations(range(len(tones)), number):
                at = [k for tone in chosen for k in (2 * tone, 2 * tone + 1)]
                seen = np.linalg.solve(covariance[np.ix_(at, at)], mean[at])
                found.append((error_mm(mean[at].T @ seen), tones[list(chosen)].tolist()))
            least, best = min(found)
            print(f"  {2 * number} rows: {least:.2f} mm, tones {best}")


def compare_rows(tool, chosen, photons, arguments):
    print("sigma  P      S/B  asked    ours of asked    rms  learned gates  histogram  "
          "a tenth: ours  Fourier  seconds  yours (rms)")
    met = count = 0
    with tempfile.TemporaryDirectory() as folder:
        for cell in chosen:
            sigma, peak, learned, gates = CELLS[cell]
            for i, ratio in enumerate(RATIOS):
                camera, dim = (Path(folder) / f"{cell}-{i}{end}.toml" for end in ("", "-dim"))
                for path, light in ((camera, photons), (dim, photons / 10)):
                    path.write_text(camera_toml(sigma, peak, ratio, light,
                                                decoder=arguments.decoder))
                out = Path(folder) / f"{cell}-{i}"
                begin = time.monotonic()
                run(tool, "design", str(camera), "--method", "optimize", "--exposures",
                    str(arguments.rows), "--effort", arguments.effort, "--trials", "1000", "-o",
                    str(out))
                seconds = time.monotonic() - begin
                name = f"{sigma}-{peak or 'none'}-{ratio}".replace("0.", ".")
                code = str(out / "codes" / f"tones-k{arguments.rows}.code.json")
                own, *others = judged(tool, [code, *codes_of(arguments.codes, name)], camera,
                                      arguments)
                ours, rms = errors_of(own)
                histogram = 1e3 * own["points"][0]["receiver_bound_mae_m"]
                at_a_tenth = [errors_of(report)[0] for report in
                              judged(tool, [code, f"fourier-k{arguments.rows}"], dim, arguments)]
                asked = ASKED * min(learned[i], gates[i])
                met, count = met + (ours <= asked), count + 1
                print(f"{sigma:5} {peak or 'none':>5} {ratio:5} {asked:6.1f} {ours:7.2f} "
                      f"{ours / asked:8.3f} {rms:6.1f}   {learned[i]:6.1f} {gates[i]:6.1f} "
                      f"{histogram:9.2f} {at_a_tenth[0]:14.1f} {at_a_tenth[1]:8.1f} {seconds:8.1f}  "
                      + " ".join("{:.2f} ({:.1f})".format(*errors_of(r)) for r in others),
                      flush=True)
    print(f"{met} of {count} cells as asked")


def compare_gated(tool, chosen, photons, arguments):
    """Compares codes of eight exposures that share the light, on cameras without peak limit."""
    hamiltonian = "hamiltonian-k5"  # switching times are multiples of 1/30 of the period
    print("sigma  S/B    ours     rms  Hamiltonian K = 5     rms  best family      seconds")
    with tempfile.TemporaryDirectory() as folder:
        for cell in (c for c in chosen if CELLS[c][1] is None):
            sigma = CELLS[cell][0]
            for ratio in RATIOS:
                camera = Path(folder) / f"{cell}-{ratio}.toml"
                camera.write_text(camera_toml(sigma, None, ratio, photons, "separate"))
                begin = time.monotonic()
                design = run(tool, "design", str(camera), "--exposures", "8", "--effort",
                             arguments.effort, "--trials", str(arguments.trials))["codes"]
                seconds = time.monotonic() - begin
                ours = min(errors_of(code) for code in design if code["method"] == "optimize")
                family, its_name = min((errors_of(code)[0], code["name"]) for code in design
                                       if code["method"] == "family")
                fits = run(tool, "evaluate", hamiltonian, "--camera", str(camera), "--set",
                           "samples=1020", "--trials", str(arguments.trials))["codes"][0]
                print("{:5} {:5} {:7.1f} {:7.1f} {:18.1f} {:7.1f}  {:7.1f} {:10} {:6.1f}".format(
                    sigma, ratio, *ours, *errors_of(fits), family, its_name, seconds), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--tofsmith", default="build/apps/tofsmith")
    parser.add_argument("--rows", type=int, default=8)
    parser.add_argument("--photons", type=float, help="1000; with --gated 100")
    parser.add_argument("--trials", type=int, default=20000)
    parser.add_argument("--effort", default="1")
    parser.add_argument("--method", default="zncc", choices=["zncc", "ml"])
    parser.add_argument("--decoder", default="whitened", choices=["whitened", "plain"],
                        help="for --method zncc")
    parser.add_argument("--cells", default="", help="numbers of cells, from 0; all")
    parser.add_argument("--codes", nargs="*", default=[], help="folders of codes of yours")
    parser.add_argument("--gated", action="store_true", help="separate exposures of one tap")
    parser.add_argument("--least", type=float, metavar="SIGMA", help="bounds of all sets of tones")
    arguments = parser.parse_args()
    if arguments.gated and arguments.decoder != "whitened":
        parser.error("--decoder is for rows: omit it with --gated")
    if arguments.least:
        least_bounds(arguments.least)
        return
    tool = arguments.tofsmith
    chosen = [int(c) for c in arguments.cells.split(",") if c] or range(len(CELLS))
    compare = compare_gated if arguments.gated else compare_rows
    compare(tool, chosen, arguments.photons or (100 if arguments.gated else 1000), arguments)


if __name__ == "__main__":
    main()

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Fig. 2: a target, its trivial factorization, designed waveforms; the ablation of Sec. 5.1."""

from typing import Any

import numpy as np

import tofsmith
from tofsmith import Camera, Waveform

from ._study import Study
from .cameras import paper_camera
from .pairs import ZERO_RMS, Pair, ideal_targets, pair_of, pair_panels

PEAK, F_MAX_IN_F0 = 15, 10
WEIGHT = 3e-4  # lambda of problem (6)
FAMILIES = ("hamiltonian-k3", "hamiltonian-k4", "hamiltonian-k5", "sinusoid-k4", "square-k4",
            "gray-k4")


def reproduce(study: Study) -> None:
    """Makes the figure: a target, and waveforms that cameras can generate for it."""
    unlimited, limited = paper_camera(PEAK), paper_camera(PEAK, F_MAX_IN_F0)

    # 1. The target: correlation function 3 of the Hamiltonian code K = 4.
    target = ideal_targets("hamiltonian-k4")[:, 2]
    n = len(target)

    # 2. Its trivial factorization: a pulse of one sample, which no light source can generate, and
    #    the target itself. With the shortest pulse that the peak allows, it is not exact.
    def pulse_and_target(duty: float, samples: Any) -> Pair:
        pulse = Waveform.binary([[0, duty]], 1 / duty)
        return Pair(pulse, Waveform.sampled(samples), unlimited, samples)

    trivial = pulse_and_target(1 / n, target)
    clipped_rms = pulse_and_target(1 / PEAK, target).residual_rms()
    trivial_rms = max(pulse_and_target(1 / n, samples).residual_rms()
                      for family in FAMILIES for samples in ideal_targets(family).T)

    # 3. Waveforms designed within the peak, without and with a band limit. The search does not
    #    know the answer.
    def designed(camera: Camera) -> tuple[Pair, float]:
        found, = tofsmith.factorize("hamiltonian-k4", camera, measurements=[2], keep_naive=False,
                                    random_starts=study.pick(30, 10), seed=study.seed)
        return pair_of(found, camera), found.best.residual_rms

    free, free_rms = designed(unlimited)
    band, band_rms = designed(limited)

    # 4. Statements of the paper.
    study.state(trivial_rms < 1e-9,
                "Every target has a trivial factorization: an impulse as modulation, the target "
                "itself as demodulation.",
                f"Largest residual of the targets of {len(FAMILIES)} families: {trivial_rms:.1e} rms.")
    study.state(trivial.modulation.peak > PEAK,
                "The trivial factorization violates the peak limit.",
                f"An impulse of unit mean power on N = {n} samples has peak {trivial.modulation.peak:g}. "
                f"With the shortest pulse that p = {PEAK} allows, the residual is {clipped_rms:.3f} rms.")
    binary = all(arm.is_binary for pair in (free, band) for arm in (pair.modulation, pair.demodulation))
    keeps_peak = max(free.modulation.peak, band.modulation.peak) <= PEAK + 1e-9
    share = band_rms / target.std()
    study.state(keeps_peak and binary and free_rms < clipped_rms and share < 0.25,
                "The designed functions keep the limits and approach the same target.",
                f"Peak {free.modulation.peak:.3g}, residual "
                f"{0.0 if free_rms < ZERO_RMS else free_rms:.4f} rms without a band limit; peak "
                f"{band.modulation.peak:.3g}, residual {band_rms:.4f} rms ({100 * share:.0f} % of the "
                f"target's variation) at {F_MAX_IN_F0} f0. All binary: {'yes' if binary else 'no'}.")
    pairs = {"trivial": trivial, "no limit": free, f"{F_MAX_IN_F0} f0": band}
    study.picture("pairs", pair_panels(pairs, "hamiltonian-k4"),
                  f"K = 4, code 3, p = {PEAK}. No light source can emit the impulse of height {n}. At "
                  f"{F_MAX_IN_F0} f0 the arms smooth the waveforms, and sharp corners are lost.")

    # 5. Without total variation, with it, and projected to binary waveforms.
    total_variation_ablation(study, unlimited)


def shape(waveforms: tuple[Waveform, Waveform], samples: int) -> list[float]:
    """Returns for modulation and demodulation: total variation divided by the maximum (2 for one
    pulse), and the share of samples within 1 % of 0 or of the maximum."""
    values = []
    for waveform, top in zip(waveforms, (waveforms[0].peak, 1.0)):
        x = waveform.cell_averages(samples)
        values.append(float(np.abs(np.diff(x, append=x[0])).sum() / top))
        values.append(float(np.mean((x < 0.01 * top) | (x > 0.99 * top))))
    return values


def total_variation_ablation(study: Study, camera: Camera) -> None:
    """Compares medians over random starts of the alternation, for two targets."""
    starts = study.pick(20, 6)
    columns = ("tv_m", "ends_m", "tv_d", "ends_d", "residual_rms")
    rows: list[dict[str, Any]] = []
    drawn = {}
    for family, code in (("hamiltonian-k3", 1), ("hamiltonian-k4", 3)):
        shapes: dict[str, list[list[float]]] = {"no TV": [], "TV": [], "binary": []}
        for start in range(starts):
            without, held = (
                tofsmith.alternate(family, camera, measurement=code - 1, start=start, seed=study.seed,
                                   total_variation_weight=weight, max_iterations=60)
                for weight in (0.0, WEIGHT))
            for name, waveforms, residual_rms in (
                    ("no TV", without.relaxed, without.relaxed_residual_rms[-1]),
                    ("TV", held.relaxed, held.relaxed_residual_rms[-1]),
                    ("binary", held.playable, held.playable_residual_rms.min())):
                shapes[name].append([*shape(waveforms, camera.samples), float(residual_rms)])
                if start == 0 and code == 1:
                    drawn[name] = Pair(*waveforms, camera, ideal_targets(family)[:, 0])
        for name, measured in shapes.items():
            rows.append({"target": f"K = {family[-1]}, code {code}", "variant": name}
                        | dict(zip(columns, np.median(measured, axis=0).tolist())))
    study.table("ablation", rows)
    without_tv, with_tv, binary = rows[0::3], rows[1::3], rows[2::3]
    study.state([all(a[tv] > 1.25 * c[tv] for a, c in zip(without_tv, binary)) for tv in ("tv_m", "tv_d")],
                "Without the total-variation term the solutions fluctuate (Sec. 5.1).",
                f"Medians over {starts} starts: " + "; ".join(
                    f"{a['target']}: TV of m / max m {a['tv_m']:.1f} ({b['tv_m']:.1f} with TV, "
                    f"{c['tv_m']:.1f} binary), of d {a['tv_d']:.2f} ({b['tv_d']:.2f}, {c['tv_d']:.2f})"
                    for a, b, c in zip(without_tv, with_tv, binary)) + ".",
                "These targets run from 0 to 1, so the bounds alone make the demodulation binary.")
    study.state(min(min(row["ends_m"], row["ends_d"]) for row in with_tv) >= 0.9,
                "With the total-variation term they are near-binary.",
                f"Samples within 1 % of 0 or the maximum at lambda = {WEIGHT:g}: " + "; ".join(
                    f"{row['target']}: {100 * row['ends_m']:.0f} % of m, {100 * row['ends_d']:.0f} % of d"
                    for row in with_tv) + ".")
    at_ends = [min(row["ends_m"], row["ends_d"]) for row in binary]
    study.state(min(at_ends) == 1, "After reprojection they are binary.",
                "Share of samples at 0 or the maximum: " + ", ".join(f"{e:.0%}" for e in at_ends) + ".")
    study.picture("ablation", pair_panels(drawn, "hamiltonian-k3"),
                  "K = 3, code 1, from the same random waveforms: without total variation, with it, and "
                  "its binary projection. All correlation functions match the target.")

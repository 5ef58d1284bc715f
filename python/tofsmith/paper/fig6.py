# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Fig. 6: two K = 5 codes at 10 f0: binary inputs, smooth outputs."""

import numpy as np

import tofsmith

from ._study import FAILS, HOLDS, IN_PART, Study
from .cameras import paper_camera
from .pairs import POINTS, pair_of, pair_panels

PEAK, F_MAX_IN_F0 = 15, 10
SHOWN = (0, 2)  # the slowest code, and the fastest that still follows its target


def reproduce(study: Study) -> None:
    """Makes the figure: all five correlation functions, factorized within the band limit."""
    camera = paper_camera(PEAK, F_MAX_IN_F0)
    found = tofsmith.factorize("hamiltonian-k5", camera, seed=study.seed,
                               random_starts=study.pick(30, 10))
    pairs = [pair_of(one, camera) for one in found]
    rows = []
    for one, pair in zip(found, pairs):
        seen = pair.correlation(camera.samples)
        arms = (pair.modulation, pair.demodulation)
        rows.append({
            "residual_rms": one.best.residual_rms,
            "share_of_variation": one.best.residual_rms / one.target_variation_rms,
            "coefficient": float(np.corrcoef(seen, one.target)[0, 1]),
            "contrast": float(seen.std() / one.target.std()),
            "modulation_duty": arms[0].duty, "demodulation_duty": arms[1].duty,
            "steepest_step": max(float(np.abs(np.diff(output, append=output[0])).max() / arm.peak)
                                 for arm, output in zip(arms, pair.outputs(POINTS))),
        })

    binary = all(pair.modulation.is_binary and pair.demodulation.is_binary for pair in pairs)
    study.state(binary, "The inputs are binary.",
                f"All {len(pairs)} pairs: {'yes' if binary else 'no'}; modulation at peak "
                f"{pairs[0].modulation.peak:.3g}, the limit being {PEAK}.")
    steepest = max(row["steepest_step"] for row in rows)
    study.state(steepest < 0.25, "The outputs, smoothed by the arms, are not.",
                f"Between neighbours of {POINTS} points of the period no output changes by more than "
                f"{100 * steepest:.0f} % of the input's peak; the inputs change by all of it.")
    follows = [row["coefficient"] > 0.9 for row in rows]
    contrast = all(row["contrast"] > 0.5 for row in rows)
    study.state(HOLDS if all(follows) and contrast else IN_PART if all(follows[i] for i in SHOWN)
                else FAILS,
                "The correlation functions of the smoothed outputs still resemble their targets.",
                "Code 1 to 5: correlation coefficient with the target "
                + ", ".join(f"{row['coefficient']:.3f}" for row in rows) + "; contrast "
                + ", ".join(f"{row['contrast']:.2f}" for row in rows) + " of the target's.",
                "The fastest targets repeat at several times f0, where 10 f0 leave little contrast.")
    shown = {f"code {i + 1}": pairs[i] for i in SHOWN}
    study.picture("codes", pair_panels(shown, "hamiltonian-k5"),
                  f"Codes 1 and 3 of the Hamiltonian K = 5 set at p = {PEAK} and {F_MAX_IN_F0} f0.")
    study.table("codes", rows)

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Fig. 8: depth error of two-bucket cameras."""

from . import surfaces
from ._study import FAILS, HOLDS, IN_PART, Study
from .cameras import paper_camera
from .surfaces import Panel, compare, together

PEAK, LIMITS_IN_F0 = 15, (10, 5)
OURS, ONE_TAP = "hamiltonian-k4-redesigned", "hamiltonian-k4-one-tap"
BASELINES = {  # with the second buckets each exposure measures two phases
    "multifrequency-1x2-7x2": "dual-frequency sinusoid (4 phases at f0, 4 at 7 f0, from 4 exposures)",
    "sinusoid-k2": "sinusoid (4 phases from 2 exposures)",
}


def reproduce(study: Study) -> None:
    """Makes the figure: all codes on both cameras."""
    panels = {f"p = {PEAK}, {limit} f0": measure_camera(study, limit) for limit in LIMITS_IN_F0}

    # 1. Statements of the paper.
    for baseline, words in BASELINES.items():
        compared = {title: compare(panel[OURS], panel[baseline]) for title, panel in panels.items()}
        study.state(together(list(compared.values())).verdict,
                    "On two-bucket cameras at 10 f0 and 5 f0 the redesigned Hamiltonian code (4 "
                    f"exposures, 8 values) beats the {words}.",
                    ". ".join(f"{title}: {one.counts()}; {baseline} has {one.factors()} times its error, "
                              f"{one.mean:.2f} on average" for title, one in compared.items()) + ".")
    gains = {title: compare(panel[OURS], panel[ONE_TAP]) for title, panel in panels.items()}
    study.state(FAILS if any(one.mean < 1 for one in gains.values())
                else IN_PART if any(one.worse for one in gains.values()) else HOLDS,
                "The method extends to two-bucket sensors: K exposures give 2K values.",
                "Error of K = 4 with one tap over that of two buckets, in the same total time: "
                + "; ".join(f"{one.factors()}, {one.mean:.2f} on average ({title})"
                            for title, one in gains.items()) + ".")

    # 2. Figures and numbers.
    surfaces.show_surfaces(study, panels)
    study.table("means", surfaces.mean_rows(panels))


def measure_camera(study: Study, f_max_in_f0: float) -> Panel:
    """Evaluates redesigned codes of 3 to 6 exposures, the baselines, and K = 4 with one tap."""
    one_tap = paper_camera(PEAK, f_max_in_f0)
    camera = one_tap.replace(name=f"{one_tap.name}-two-bucket", sensor={"taps": 2})
    measured = [surfaces.measure_surface(study, code, camera)
                for code in study.codes(camera, (3, 4, 5, 6), BASELINES)]
    # The same light and time with one tap shows the gain of the second bucket.
    single = study.redesigned(4, one_tap).renamed(ONE_TAP)
    measured.append(surfaces.measure_surface(study, single, one_tap))
    return {surface.report.code: surface for surface in measured}

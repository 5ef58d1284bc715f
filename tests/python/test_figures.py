# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Every figure draws, in matplotlib and as Plotly JSON."""

import matplotlib.pyplot as plt
import numpy as np
import pytest

import tofsmith as ts
from tofsmith import figures, plot


@pytest.fixture(scope="module")
def things(camera):
    reports = [ts.evaluate(name, camera, trials=20) for name in ("square-k4", "hamiltonian-k3")]
    scene = ts.built_in_scene("ball", 24, 18)
    return {"camera": camera, "reports": reports, "scene": scene}


codes = ["square-k4", "hamiltonian-k3"]
drawings = {
    "waveforms": lambda of, t: of.waveforms("hamiltonian-k4", t["camera"]),
    "coding_curve": lambda of, t: of.coding_curve(codes, t["camera"]),
    "depth_error_map": lambda of, t: of.depth_error_map(t["reports"]),
    "depth_error_curves": lambda of, t: of.depth_error_curves(t["reports"], kind="circular"),
    "depth_maps": lambda of, t: of.depth_maps({"a": t["scene"].depth_m, "b": t["scene"].depth_m}),
    "point_cloud": lambda of, t: of.point_cloud(t["scene"].depth_m, t["scene"].lens),
}


@pytest.mark.parametrize("name", drawings)
def test_figures_are_plotly_documents(name, things):
    figure = drawings[name](figures, things)
    assert set(figure) >= {"data", "layout"} and figure["data"]


@pytest.mark.parametrize("name", drawings)
def test_plots_draw_and_leave_the_users_style(name, things, tmp_path):
    before = plt.rcParams["font.size"]
    drawings[name](plot, things).savefig(tmp_path / "figure.pdf")
    plt.close("all")
    assert plt.rcParams["font.size"] == before and (tmp_path / "figure.pdf").stat().st_size > 2000


def test_correlation_functions_draw_on_a_given_figure(things):
    figure = plt.figure()
    assert plot.correlation_functions("square-k4", things["camera"], figure=figure) is figure
    two_bucket = things["camera"].replace(sensor={"taps": 2, "readout": "difference"})
    plot.waveforms("square-k4", two_bucket)
    plt.close("all")


def test_figures_refuse_what_they_cannot_draw(things):
    for of in (plot, figures):
        with pytest.raises(ValueError, match="kind: got str 'mean'; needs one of linear, circular"):
            of.depth_error_map(things["reports"], kind="mean")
        with pytest.raises(ValueError, match="reports: got none"):
            of.depth_error_curves([])
        with pytest.raises(ValueError, match=r"depth: got shape \(3,\); needs \(H, W\)"):
            of.depth_maps(np.ones(3))

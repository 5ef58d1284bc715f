# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Every figure is drawn in matplotlib and as an HTML page."""

import matplotlib.pyplot as plt
import numpy as np
import pytest

import tofsmith as ts
from tofsmith import figures, plot


@pytest.fixture(scope="module")
def things(camera):
    reports = [ts.evaluate(name, camera, trials=20) for name in ("square-k4", "hamiltonian-k3")]
    scene = ts.built_in_scene("ball", 24, 18)
    peak, signal = (column.ravel() for column in np.meshgrid([5.0, 10.0], [1e3, 1e4, 1e5]))
    sweep = ts.SweepResults({
        "code": np.array(codes).repeat(6), "light.peak_factor": np.tile(peak, 2),
        "signal_e_per_s": np.tile(signal, 2), "linear_mde_m": 1e3 / np.tile(signal * peak, 2),
        "circular_mde_m": np.ones(12)})
    return {"camera": camera, "reports": reports, "scene": scene, "sweep": sweep}


codes = ["square-k4", "hamiltonian-k3"]
drawings = {
    "waveforms": lambda of, t: of.waveforms("hamiltonian-k4", t["camera"]),
    "coding_curve": lambda of, t: of.coding_curve(codes, t["camera"]),
    "depth_error_map": lambda of, t: of.depth_error_map(t["reports"]),
    "depth_error_curves": lambda of, t: of.depth_error_curves(t["reports"], kind="circular"),
    "sweep_map": lambda of, t: of.sweep_map(t["sweep"], "light.peak_factor", "signal_e_per_s"),
    "depth_maps": lambda of, t: of.depth_maps({"a": t["scene"].depth_m, "b": t["scene"].depth_m}),
    "point_cloud": lambda of, t: of.point_cloud(t["scene"].depth_m, t["scene"].lens),
}


@pytest.mark.parametrize("name", drawings)
def test_figures_are_pages_with_documents(name, things, tmp_path):
    figure = drawings[name](figures, things)
    assert figure.document["kind"] in ("lines", "curves", "map", "image", "cloud")
    assert figure.document.get("panels") or figure.document["rows"][0]["panels"]
    figure.save(tmp_path / "figure.html")
    assert (tmp_path / "figure.html").read_text().endswith("</html>\n")
    assert figure._repr_html_().startswith("<iframe srcdoc=")


@pytest.mark.parametrize("name", drawings)
def test_plots_do_not_change_the_users_style(name, things, tmp_path):
    before = plt.rcParams["font.size"]
    drawings[name](plot, things).savefig(tmp_path / "figure.pdf")
    plt.close("all")
    assert plt.rcParams["font.size"] == before and (tmp_path / "figure.pdf").stat().st_size > 2000


@pytest.mark.parametrize("width, inches", [("column", 3.5), ("page", 7.16)])
@pytest.mark.parametrize("name", drawings)
def test_plots_are_as_wide_as_the_columns_of_a_paper(name, width, inches, things):
    class Wide:
        def __getattr__(self, function):
            return lambda *given, **keys: getattr(plot, function)(*given, width=width, **keys)

    assert drawings[name](Wide(), things).get_figwidth() == pytest.approx(inches)
    plt.close("all")


def test_different_bounds_have_separate_labels(camera):
    names = ("sinusoid-k3", "sinusoid-k5")
    reports = [ts.evaluate(name, camera, trials=20) for name in names]
    labels = plot.depth_error_curves(reports).axes[0].get_legend_handles_labels()[1]
    assert labels == ["bound for sinusoid-k3", "bound for sinusoid-k5", *names]
    labels = plot.depth_error_curves(reports[:1]).axes[0].get_legend_handles_labels()[1]
    assert labels == ["bound of any code", "sinusoid-k3"]
    plt.close("all")


def test_correlation_functions_draw_on_a_given_figure(things):
    figure = plt.figure()
    assert plot.correlation_functions("square-k4", things["camera"], figure=figure) is figure
    two_bucket = things["camera"].replace(sensor={"taps": 2, "readout": "difference"})
    plot.waveforms("square-k4", two_bucket)
    plt.close("all")


def test_sweep_maps_average_over_all_other_axes(things):
    sweep = things["sweep"]
    twice = ts.SweepResults({name: np.concatenate([column, column[:-1]])
                             for name, column in sweep.columns.items()})
    twice.columns["linear_mde_m"][12:] *= 4
    axis = plot.sweep_map(twice, "light.peak_factor", "signal_e_per_s").axes[1]
    mean_mm = np.ma.getdata(axis.images[0].get_array())
    assert mean_mm.shape == (3, 2) and np.isnan(mean_mm[2, 1])  # one of two items is unfinished
    assert mean_mm[0, 0] == pytest.approx(1e3 * 2 * 1e3 / 5e3)
    plt.close("all")


def test_figures_reject_unsupported_input(things):
    for of in (plot, figures):
        with pytest.raises(ValueError, match="kind: got str 'mean'; needs one of linear, circular"):
            of.depth_error_map(things["reports"], kind="mean")
        with pytest.raises(ValueError, match="reports: got none"):
            of.depth_error_curves([])
        with pytest.raises(ValueError, match="x: got 'peak'; needs a column of numbers that vary: "
                                             "light.peak_factor, signal_e_per_s"):
            of.sweep_map(things["sweep"], "peak", "signal_e_per_s")
        with pytest.raises(ValueError, match="y: got 'signal_e_per_s' as x"):
            of.sweep_map(things["sweep"], "signal_e_per_s", "signal_e_per_s")
        with pytest.raises(ValueError, match=r"depth: got shape \(3,\); needs \(H, W\)"):
            of.depth_maps(np.ones(3))
    with pytest.raises(ValueError, match="width: got str 'wide'; needs one of column, page"):
        plot.waveforms("hamiltonian-k4", things["camera"], width="wide")


def test_error_maps_use_the_cameras_error_kind_and_show_standard_errors(things):
    report = ts.evaluate("square-k4", things["camera"].replace(operating={"error": "circular"}),
                         trials=20)
    for kind, errors_m in (("circular", report.circular_se_m), ("linear", report.linear_se_m)):
        figure = plot.depth_error_map(report, kind=None if kind == report.kind else kind)
        assert figure.axes[-1].get_ylabel() == f"mean depth error, {kind} (mm)"
        cells = figure.axes[0].texts
        assert len(cells) == len(errors_m)
        shown = sorted(float(cell.get_text().split("± ")[1]) for cell in cells)
        np.testing.assert_allclose(shown, np.sort(1e3 * errors_m), rtol=0.06, atol=0.5)
        plt.close("all")
    linear = things["reports"][0]
    assert linear.kind == "linear"
    assert figures.depth_error_map(report) == figures.depth_error_map(report, kind="circular")
    assert figures.depth_error_map(linear) == figures.depth_error_map(linear, kind="linear")


def test_binary_waveforms_are_drawn_by_their_switching_times(things):
    # The 7 edges per period are not on cell borders; averaging over cells would blur them.
    on = [[0.0, 0.123456], [0.2, 0.41], [0.5003, 0.77]]
    light, gate = ts.Waveform.binary(on, 1.5), ts.Waveform.binary(on)
    # The part beyond the end of the period wraps around to its beginning.
    late = plot.waveforms("hamiltonian-k3", things["camera"]).axes[7].patches[0].get_data()
    np.testing.assert_allclose(late.values, [0, 1, 0, 1, 0])
    np.testing.assert_allclose(late.edges, [0, 0, 1 / 6, 2 / 3, 1, 1], atol=1e-9)
    code = ts.CodeSet.from_waveforms([light], [gate], samples=things["camera"].samples)
    figure = plot.waveforms(code, things["camera"])
    for axis, level in zip(figure.axes, (1.5, 1.0)):
        values, edges, _ = axis.patches[0].get_data()
        np.testing.assert_allclose(values, level * np.array([0, 1, 0, 1, 0, 1, 0]))
        np.testing.assert_allclose(edges, [0, *np.ravel(on), 1])
    plt.close("all")
    sampled = plot.waveforms("sinusoid-k3", things["camera"]).axes[0].patches[0].get_data()
    assert len(sampled.values) == len(sampled.edges) - 1 > 100
    plt.close("all")


def test_depth_differences_have_a_diverging_scale(things):
    depth_m = things["scene"].depth_m
    difference_m = depth_m - np.nanmean(depth_m)
    for shown, label, map_name in ((depth_m, "depth", "viridis"),
                                   (difference_m, "depth difference", "diverging")):
        colours = figures.depth_maps(shown).document["colours"]
        assert (colours["label"], colours["map"]) == (label, map_name)
        figure = plot.depth_maps(shown)
        assert figure.axes[-1].get_ylabel() == f"{label} (m)"
        low, high = figure.axes[0].images[0].get_clim()
        assert (low == -high) == (map_name == "diverging")
        plt.close("all")

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Captures with multipath equal the command line; multipath maps and losses of generators."""

import json

import numpy as np
import pytest

import tofsmith as ts
from conftest import run

code = "multifrequency-1x3-2x2-3x2-5x2"


@pytest.fixture(scope="module")
def small():
    return ts.Camera("paper-10f0", samples=60,
                     operating={"signal_e_per_s": [1e5], "ambient_e_per_s": [1e3]})


def test_trials_continue_until_the_target(small):
    report = ts.evaluate("hamiltonian-k4", small, trials=100, target_standard_error=0.05)
    assert report.points_short_of_target == 0 and report.point_trials[0] > 100
    assert report.linear_se_m[0] <= 0.05 * report.linear_mde_m[0]
    assert report.trials == report.point_trials.max() and report.point_trials.dtype == np.int64
    few = ts.evaluate("hamiltonian-k4", small, trials=100, target_standard_error=1e-4,
                      max_trials=200)
    assert few.points_short_of_target == 1 and few.trials <= 200


def test_multipath_captures_equal_the_command(cli, tmp_path):
    file = tmp_path / "raw.npy"
    scene = ts.built_in_scene("wall", 8, 6)
    light = {"signal_e_per_s": 1e6, "ambient_e_per_s": 1e3}
    direct = ts.capture(scene, code, "paper-10f0", **light)
    for option, words, keywords in (
            ("--multipath", ["delta=0.8,ratio=0.3"], {"returns": [(0.8, 0.3)]}),
            ("--tail", [0.5, "--tail-ratio", 0.4], {"tail": ts.ExponentialTail(0.5, 0.4)})):
        run(cli, "simulate", "wall", "--width", 8, "--height", 6, "--code", code, "--camera", "paper-10f0", "--signal", 1e6,
            "--ambient", 1e3, option, *words, "-o", file, "--force")
        raw = ts.capture(scene, code, "paper-10f0", **light, **keywords)
        assert np.array_equal(raw, np.load(file)) and raw.sum() > direct.sum()
    run(cli, "simulate", "corner", "--width", 8, "--height", 6, "--code", code, "--camera", "paper-10f0", "--signal", 1e6,
        "--ambient", 1e3, "--bounces", 1, "--bounce-rays", 32, "-o", file, "--force")
    bounced = ts.capture_staged("corner", code, "paper-10f0", width=8, height=6, bounces=1,
                                bounce_rays=32, **light)
    assert np.array_equal(bounced.raw[0], np.load(file))
    gathered = ts.bounced_light("corner", "paper-10f0", width=8, height=6, rays=32)
    corner = ts.built_in_scene("corner", 8, 6)
    assert np.array_equal(ts.capture(corner, code, "paper-10f0", **light, returns=gathered),
                          bounced.raw[0])
    pixels = 48
    listed = ts.MultipathReturns(np.arange(pixels + 1), scene.depth_m.ravel() + np.float32(0.8),
                             np.full(pixels, 0.3))
    behind = ts.capture(scene, code, "paper-10f0", **light, returns=[(0.8, 0.3)])
    assert np.array_equal(ts.capture(scene, code, "paper-10f0", **light, returns=listed), behind)
    pulse = ts.Transients(np.array([1.0, 0, 0]), bin_m=1e-3)
    assert np.allclose(ts.capture(scene, code, "paper-10f0", **light, transients=pulse), direct,
                       atol=5 * np.sqrt(direct.max()))


def test_multipath_maps_are_consistent_with_the_law_and_the_bound(small):
    report = ts.multipath_error(code, small, delay_m=[0.8, 2], ratio=[0.1, 0.3, 0.6], tail_m=[0.5],
                                signal_e_per_s=[1e6], ambient_e_per_s=1e3, trials=40)
    assert report.why_no_two_returns == "" and len(report.maps) == 1
    cells = report.maps[0].points
    assert cells.error_m.shape == (3, 2) and report.maps[0].tails.error_m.shape == (3, 1)
    assert cells.delay_m[0].tolist() == [0.8, 2] and cells.ratio[:, 0].tolist() == [0.1, 0.3, 0.6]
    assert np.allclose(cells.law_m, cells.ratio * cells.delay_m / (1 + cells.ratio))
    assert cells.law_m[1, 1] == ts.single_path_bias_m(0.3, 2)
    assert report.maps[0].single.error_m.shape == () and np.all(cells.gain() > 0)
    bound = ts.MultipathBound(code, small)
    sigma = bound.sigma_m(1e6, 1e3, 0.3, 2)
    assert sigma.shape == (60,)
    assert bound.mae_m(sigma) == pytest.approx(cells.cramer_rao_mae_m[1, 1])
    assert bound.tail_sigma_m(1e6, 1e3, ts.ExponentialTail(0.5, 0.3)).shape == (60,)


def test_losses_of_exported_waveforms_are_evaluated(tmp_path):
    camera = ts.Camera("prototype", operating={"signal_e_per_s": [1e5], "ambient_e_per_s": [1e3]})
    folder = tmp_path / "bench"
    written = ts.export_waveforms("hamiltonian-k3", camera, folder, "keysight-arb", samples=100)
    assert sorted(written.files) == sorted(folder.iterdir())
    assert written.files[-1].name == "manifest.json"
    assert written.manifest == json.loads((folder / "manifest.json").read_text())
    assert written.camera.light.generator is not None
    loss = ts.generator_loss("hamiltonian-k3", written.camera, trials=500)
    assert loss.correlation_change.shape == (3,) and loss.ratio("circular") > 0.5
    assert loss.nominal.of("linear").geometric_mean_m > 0 and loss.uncalibrated_ratio() > 0.5
    with pytest.raises(OSError, match="exists"):
        ts.export_waveforms("hamiltonian-k3", camera, folder, "keysight-arb", samples=100)
    assert "keysight-arb" in [f.name for f in ts.waveform_formats()]


def test_options_are_passed_to_evaluations_and_decoders(small):
    every = ts.evaluate("hamiltonian-k4", small, trials=200, draw_every_measurement=True)
    assert every.circular_mde_m[0] != ts.evaluate("hamiltonian-k4", small, trials=200).circular_mde_m[0]
    error_m, se_m = ts.table_depth_error_m(ts.DecodingTable.of_code("hamiltonian-k4", small), 1e5, 1e3)
    assert 0 < se_m < error_m
    image = ts.Decoder(code, small, method="two-return").decode(
        ts.capture(np.full((4, 5), 3.0), code, small, signal_e_per_s=1e8, returns=[(1.5, 0.4)]))
    assert {plane.shape for plane in (image.returns, image.delay_m, image.ratio)} == {(4, 5)}


def test_built_in_scenes_are_seen_through_the_given_lens():
    lens = ts.Lens(fx_px=20.0, fy_px=21.0, cx_px=9.0, cy_px=6.5, width_px=24, height_px=14)
    scene = ts.built_in_scene("wall", lens=lens)
    assert scene.depth_m.shape == (14, 24)
    np.testing.assert_allclose(ts.points_m(scene.depth_m, lens)[..., 2], 0.5, rtol=1e-6)

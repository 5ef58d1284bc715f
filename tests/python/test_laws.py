# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""The package gives the same results as the command line and as formulas."""

import pickle
import subprocess
import sys

import numpy as np
import pytest

import decode_bins
import tofsmith as ts
from conftest import run


def test_cameras_are_equal_from_names_files_and_keywords(tmp_path):
    by_name = ts.Camera("paper-10f0", light={"peak_factor": 5}, samples=120)
    file = tmp_path / "mine.toml"
    file.write_text(by_name.to_toml())
    assert ts.Camera(file) == by_name == ts.Camera("paper-10f0").replace(
        samples=120, light={"peak_factor": 5})
    assert by_name.light.peak_factor == 5 and by_name.sensor.read_noise_e == 20
    assert by_name.light.impulse_response == ts.ImpulseResponse("hann", f_max_hz=150e6)
    assert by_name.range_m == pytest.approx(299792458 / 30e6)
    assert abs(by_name.transfer(10)[10]) == pytest.approx(1 / 25, rel=0.05)
    assert pickle.loads(pickle.dumps(by_name)) == by_name and by_name != ts.Camera("paper-5f0")


def test_every_table_of_a_camera_file_is_an_attribute():
    for key in ts.camera_keys():
        assert hasattr(ts.Camera, key.partition(".")[0]), key


def test_depths_and_markers_are_keywords(camera):
    weights = np.arange(1, 51)
    there = camera.replace(operating={"depths": weights})
    assert there.operating.depths == tuple(weights) and there.operating.working_distance_m is None
    assert camera.operating.depths is None and there.replace(samples=60).operating.depths == tuple(weights)
    near = camera.replace(operating={"working_distance_m": (1, 3)})
    assert near.operating.working_distance_m == (1.0, 3.0)
    marked = camera.replace(raw={"saturated": [65535, float("nan")], "invalid": [0]})
    assert marked.raw.invalid == (0.0,) and camera.raw == ts.RawMarkers()
    assert marked.raw.saturated[0] == 65535.0 and np.isnan(marked.raw.saturated[1])
    with pytest.raises(ValueError, match="operating.depths = weights that are all 0"):
        camera.replace(operating={"depths": np.zeros(50)})


def test_a_lens_is_a_pinhole_and_a_blur(camera):
    blurred = camera.replace(lens={"blur": "gaussian", "blur_sigma_px": 0.5})
    assert blurred.lens is None and blurred.blur == ts.LensBlur(blur="gaussian", blur_sigma_px=0.5)
    pinhole = ts.centred_lens(4, 3)
    assert camera.replace(lens=pinhole).lens == pinhole and camera.replace(lens=pinhole).blur is None


def test_staged_captures_equal_the_command(cli, tmp_path):
    raw, truth = tmp_path / "raw.npy", tmp_path / "truth.npy"
    near, far = tmp_path / "near.npy", tmp_path / "far.npy"
    camera = ts.Camera("paper-10f0", exposure_s=8e-3, sensor={"readout_gap_s": 1e-3},
                       lens={"blur": "gaussian", "blur_sigma_px": 0.5, "pixel_samples": 2})
    camera.write(tmp_path / "lens.toml")
    run(cli, "simulate", "moving-hand", "--width", 24, "--height", 18, "--code", "hamiltonian-k4",
        "--camera", tmp_path / "lens.toml", "--frames", 3, "--seed", 5, "-o", raw, "--truth", truth,
        "--truth-near", near, "--truth-far", far)
    made = ts.capture_staged("moving-hand", "hamiltonian-k4", camera, width=24, height=18,
                             frames=3, seed=5)
    assert made.raw.shape == (3, 18, 24, 4) and np.array_equal(made.raw, np.load(raw))
    for mine, file in ((made.depth_m, truth), (made.near_m, near), (made.far_m, far)):
        assert mine.shape == (3, 18, 24) and np.array_equal(mine, np.load(file), equal_nan=True)
    middle_s = 2 * 12e-3 + 0.5 * 11e-3
    then = ts.built_in_scene("moving-hand", 24, 18, time_s=middle_s)
    assert np.array_equal(made.depth_m[2], then.depth_m, equal_nan=True)
    assert not np.array_equal(made.depth_m[0], made.depth_m[2], equal_nan=True)
    still = ts.capture("ball", "hamiltonian-k4", "paper-10f0", seed=2)
    assert np.array_equal(
        still, ts.capture(ts.built_in_scene("ball"), "hamiltonian-k4", "paper-10f0", seed=2))


def test_measured_impulse_responses_are_keywords():
    samples = np.array([1.0, 2.0, 1.0])
    camera = ts.Camera(fundamental_frequency_hz=15e6, light={
        "impulse_response": {"kind": "file", "samples": samples, "time_step_s": 1e-9}})
    assert camera.light.impulse_response.samples == (1.0, 2.0, 1.0)


def test_codes_are_preserved_by_arrays_files_and_pickles(camera, tmp_path):
    code = ts.build_family("hamiltonian-k4", camera)
    assert (code.exposures, code.taps, code.measurements, code.samples) == (4, 1, 4, 120)
    again = ts.CodeSet.from_arrays(code.modulation, code.demodulation, name=code.name)
    assert np.array_equal(again.demodulation, code.demodulation)
    assert again.demodulation_waveforms()[0].is_binary
    assert pickle.loads(pickle.dumps(code)) == code
    for name in ("code.code.json", "code.npz"):
        ts.write_code(tmp_path / name, code)
        assert np.array_equal(ts.read_code(tmp_path / name).modulation, code.modulation)
    two = code.with_two_buckets()
    assert two.taps == 2 and np.allclose(two.demodulation.reshape(120, 4, 2).sum(axis=2), 1)
    waveform = ts.Waveform.binary([[0.25, 0.5]], 4.0)
    assert waveform.mean == 1.0 and waveform.delayed(0.25).on_intervals.tolist() == [[0.5, 0.75]]
    assert not len(waveform.coefficients)
    cosines = ts.Waveform.cosines([0.5, 0.1, 0.05j])  # minus sines of twice the frequency
    assert cosines.mean == 0.5 and not cosines.is_binary and not len(cosines.samples)
    assert cosines.coefficients.tolist() == [0.5, 0.1, 0.05j]
    middle = (np.arange(1000) + 0.5) / 1000
    expected = 0.5 + 0.2 * np.cos(2 * np.pi * middle) - 0.1 * np.sin(4 * np.pi * middle)
    assert np.allclose(cosines.cell_averages(1000), expected, atol=1e-5)


def test_rows_are_a_code_with_bounds():
    camera = ts.Camera(fundamental_frequency_hz=5e6, exposure_s=1, samples=60,
                       sensor={"readout": "rows", "read_noise_e": 3},
                       light={"impulse_response": {"kind": "gaussian", "cutoff_hz": 30e6}})
    weights = np.random.default_rng(1).normal(size=(60, 5))
    code = ts.CodeSet.from_rows(np.arange(60.0), weights)
    assert code.is_rows and pickle.loads(pickle.dumps(code)) == code
    assert not ts.build_family("hamiltonian-k4", "paper-10f0").is_rows
    covariance = ts.ForwardModel(code, camera).covariance_e2(7.5, 0, 600)
    assert np.allclose(covariance, 10 * weights.T @ weights + 9 * np.eye(5))
    mae_m = ts.CramerRaoBound(code, camera).mae_m(1e3, 600)
    assert 0 < ts.HistogramBound(code, camera).mae_m(1e3, 600) < mae_m


def test_models_and_bounds_have_the_shapes_of_their_arguments(camera):
    model = ts.ForwardModel("hamiltonian-k4", camera)
    z = np.array([[0.0, 17.25], [60.5, 119.9]])
    mu = model.expected_electrons(z, 1e4, 1e3)
    assert np.allclose(mu, model.exposure_s * (1e4 * model.correlation(z) + 1e3 * model.ambient_gain))
    assert np.allclose(model.variance_e2(z, 1e4, 1e3), mu + model.constant_variance_e2)
    table = model.correlation_table()
    assert np.allclose(table[::4], model.correlation(np.arange(0, 120, 4)))
    curve = ts.coding_curve_in_space(table)
    assert curve.shape == (120, 3) and ts.coding_curve_rank(table) >= 3
    steps = np.diff(np.vstack([table, table[:1]]), axis=0)
    assert ts.coding_curve_length(table) == pytest.approx(np.linalg.norm(steps, axis=1).sum())
    report = ts.evaluate("square-k4", camera, trials=200)
    bound = ts.CramerRaoBound("square-k4", camera)
    point = report.signal_e_per_s[3], report.ambient_e_per_s[3]
    assert bound.mae_m(*point) == report.cramer_rao_mae_m[3]
    assert bound.sigma_m(*point).shape == (480,)
    assert ts.ReceiverBound(camera, 4).mae_m(*point) == report.receiver_bound_mae_m[3]
    assert ts.DirectTofBound(camera).mae_m(*point) == report.direct_tof_bound_mae_m[3]


def layouts(raw):
    """Returns the same frame in other types and layouts."""
    planar = np.ascontiguousarray(np.moveaxis(raw, -1, 0))
    padded = np.zeros((raw.shape[0], raw.shape[1] + 3, 2 * raw.shape[2]), np.float32)
    padded[:, 1:-2, ::2] = raw
    read_only = raw.copy()
    read_only.flags.writeable = False
    yield "float64", raw.astype(np.float64), "interleaved"
    yield "Fortran order", np.asfortranarray(raw), "interleaved"
    yield "planar", planar, "planar"
    yield "view with gaps", padded[:, 1:-2, ::2], "interleaved"
    yield "read-only", read_only, "interleaved"
    yield "turned round twice", raw[::-1, ::-1].copy()[::-1, ::-1], "interleaved"


def test_layouts_and_types_do_not_change_depth(camera):
    raw = ts.capture(ts.Scene(np.linspace(0.5, 9, 600).reshape(20, 30)), "hamiltonian-k4", camera,
                     signal_e_per_s=1e5)
    decoder = ts.Decoder("hamiltonian-k4", camera)
    truth = decoder.decode(raw)
    for name, array, layout in layouts(raw):
        depth = decoder.decode(array, layout=layout, planes=["depth_m"]).depth_m
        assert np.array_equal(depth, truth.depth_m, equal_nan=True), name
    stack = np.stack([raw, raw[::-1]])
    both = decoder.decode(stack)
    assert np.array_equal(both.depth_m[1], truth.depth_m[::-1], equal_nan=True)
    out = ts.DepthImage(depth_m=np.zeros((20, 30), np.float32), bin=np.zeros((20, 30), np.int32))
    assert decoder.decode(raw, out=out) is out
    assert np.array_equal(out.depth_m, truth.depth_m, equal_nan=True) and out.bin.max() < 120
    offset = np.full((20, 30), 0.25, np.float32)
    moved = decoder.decode(raw, delay_offset_m=offset).depth_m
    difference = (truth.depth_m - moved - 0.25 + 1) % camera.range_m - 1
    assert np.nanmax(np.abs(difference)) < 1e-4


@pytest.mark.parametrize("item", range(12))
def test_bins_of_random_codes_equal_brute_force(item):
    """A few of the random codes that scripts/differential.sh tests for hours."""
    assert decode_bins.check_item(seed=7, item=item, pixels=4000) in (0, 4000)


def test_a_wrong_bin_is_detected():
    rng = np.random.default_rng(1)
    table = rng.normal(size=(50, 4))
    raw = decode_bins.random_frame(rng, table, 300)
    raw[~np.isfinite(raw)] = 0
    centred = raw[0] - raw[0].mean(axis=1, keepdims=True)
    unit = table - table.mean(axis=1, keepdims=True)
    unit /= np.linalg.norm(unit, axis=1, keepdims=True)
    best = (centred.astype(float) @ unit.T).argmax(axis=1)[None]
    assert decode_bins.wrong_bins(table, raw, best).size == 0
    best[0, 17] = (best[0, 17] + 1) % 50
    best[0, 40] = -1
    assert list(decode_bins.wrong_bins(table, raw, best)) == [17, 40]


@pytest.mark.parametrize("method, code", [("ml", "hamiltonian-k4"), ("unwrap", "multifrequency-k5"),
                                          ("two-return", "hamiltonian-k8"),
                                          ("tail", "hamiltonian-k8")])
def test_every_method_recovers_depth(method, code):
    camera = ts.Camera("paper-30x", samples=240, sensor={"read_noise_e": 0})
    if code == "hamiltonian-k8":
        camera, code = ts.Camera("paper-10f0", samples=240), "multifrequency-1x3-2x2-3x2-5x2"
    model = ts.ForwardModel(code, camera)
    z = np.linspace(3, 230, 40)
    raw = model.expected_electrons(z, 1e6, 1e3).astype(np.float32)
    decoder = ts.Decoder(code, camera, method=method)
    image = decoder.decode(raw[None])
    error = (image.depth_m[0] / camera.bin_m - z + 120) % 240 - 120
    assert np.nanmax(np.abs(error)) < 0.5
    assert np.allclose(decoder.decode_depth_bins(raw), z, atol=0.5)
    assert (image.returns is not None) == (method in ("two-return", "tail"))


def test_design_keeps_baselines_and_reports_results(camera):
    quick = {"random_starts": 2, "max_iterations": 2, "refined": 2, "structured_starts": False}
    later = {"ratio": [0.2, 0.4], "delay_m": [0.5, 3], "weight": 0.2}
    meets = camera.replace(operating={"multipath": later})
    assert meets.operating.multipath == ts.OperatingMultipath((0.2, 0.4), (0.5, 3.0), 0.2)
    chi = ts.ForwardModel("hamiltonian-k3", "paper-30x").correlation_table()
    result = ts.design(meets, method="factorize", target=chi, trials=1000, search_trials=100,
                       baselines=["hamiltonian-k3"], factorize=quick)
    assert {c.method for c in result.candidates} >= {"factorize", "family"}
    assert result.winner is result.by_ranking_error()[0]
    designed = next(c for c in result.candidates if c.method == "factorize")
    assert designed.is_designed and len(designed.per_measurement) == 3
    for measurement in designed.per_measurement:
        assert len(measurement.objective) == len(measurement.playable_residual_rms)
    baseline = result["hamiltonian-k3"]
    assert baseline.error.trials == 1000
    assert baseline.multipath.single_path_linear_m[0] > baseline.error.linear.geometric_mean_m
    assert baseline.multipath.two_return_linear_m is None  # three-step codes cannot separate them


def test_sweeps_run_resume_and_read_exports(cli, tmp_path):
    file, store = tmp_path / "sweep.toml", tmp_path / "store.sqlite"
    file.write_text('camera = "paper-10f0"\nset = ["samples=60"]\n'
                    'codes = ["square-k4", "hamiltonian-k3"]\ntrials = 20\n[[axis]]\n'
                    'key = "light.peak_factor"\nvalues = [10, 15]\n[[axis]]\n'
                    'key = "signal_e_per_s"\nvalues = [1e4]\n[[axis]]\n'
                    'key = "ambient_e_per_s"\nvalues = [1e3]\n')
    results = ts.run_sweep(file, store)
    assert (results.items, results.finished, len(results)) == (4, 4, 4)
    assert results["linear_mde_m"].tolist() == ts.read_sweep(file, store)["linear_mde_m"].tolist()
    assert len(results.where(code="square-k4", **{"light.peak_factor": 15})) == 1
    for kind in ("npz", "csv", "json"):
        path = tmp_path / f"export.{kind}"
        run(cli, "sweep", file, "--store", store, "--status", "--export", path)
        export = ts.read_sweep_export(path)
        assert export["code"].tolist() == results["code"].tolist()
        assert np.array_equal(export["circular_mde_m"], results["circular_mde_m"])


def test_files_of_depth_and_points(tmp_path):
    depth = np.array([[1.0, np.nan], [2.5, 3.0]], np.float32)
    for name in ("d.npy", "d.exr", "d.pfm", "d.png"):
        ts.write_depth(tmp_path / name, depth)
        assert np.allclose(ts.read_depth(tmp_path / name), depth, atol=1e-3, equal_nan=True), name
    lens = ts.centred_lens(2, 2)
    points = ts.points_m(depth, lens)
    assert np.allclose(np.linalg.norm(points, axis=-1), depth, equal_nan=True)
    assert np.allclose(ts.radial_from_z(ts.z_from_radial(depth, lens), lens), depth, equal_nan=True)
    ts.write_points(tmp_path / "p.ply", points, {"intensity": depth})
    assert b"element vertex 3" in (tmp_path / "p.ply").read_bytes()
    raw = np.arange(24, dtype=np.float32).reshape(2, 3, 4)
    ts.write_raw(tmp_path / "raw.npz", raw)
    assert np.array_equal(ts.read_raw(tmp_path / "raw.npz", measurements=4), raw[None])


def test_import_loads_few_modules():
    said = subprocess.run(
        [sys.executable, "-c", "import tofsmith.plot, sys; print('matplotlib' in sys.modules)"],
        capture_output=True, text=True)
    assert said.stdout == "False\n", said.stderr

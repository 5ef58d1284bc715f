# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Calibrations return and write the same as the command line; decoding accepts their results."""

import json
import re

import numpy as np
import pytest

import tofsmith as ts
from conftest import page_without_command, run

base = ts.Camera("paper-10f0", samples=60)
narrow = {"kind": "hann", "f_max_hz": 75e6}
sensor = {"impulse_response": narrow, "adc_bits": 12, "gain_e_per_dn": 8, "black_level_dn": 100}


def printed(cli, directory, *arguments):
    """Runs the command line with --json in a directory and returns the printed document."""
    return json.loads(run(cli, "--json", "calibrate", *arguments, directory=directory))


def pair(values):
    return tuple(np.nan if v is None else v for v in (values["value"], values["standard_error"]))


@pytest.fixture(scope="module")
def both(tmp_path_factory):
    """Two folders, for the files of the command line and of Python."""
    folders = tmp_path_factory.mktemp("command"), tmp_path_factory.mktemp("python")
    base.write(folders[0] / "base.toml")
    return folders


def same(both, *names):
    for name in names:
        assert (both[0] / name).read_bytes() == (both[1] / name).read_bytes(), name


def same_camera(both, name):
    """The command line omits defaults, which Camera.write() writes."""
    assert ts.Camera(both[0] / name) == ts.Camera(both[1] / name), name


def same_page(both, name):
    assert page_without_command(both[0] / name) == page_without_command(both[1] / name)


@pytest.fixture(scope="module")
def scope(both):
    """A noisy Gaussian pulse in nanoseconds."""
    t = np.arange(400) * 0.1
    values = np.exp(-((t - 20) / 1.5) ** 2 / 2) + 0.01 * np.random.default_rng(1).normal(size=400)
    path = both[0] / "scope.csv"
    np.savetxt(path, np.stack([t, values], 1), "%.6f", ",", header="time_ns,volt", comments="")
    return path


def test_impulse_response_equals_the_command(both, scope, cli):
    said = printed(cli, both[0], "impulse-response", scope, "--camera", "base.toml", "-o", "mine.toml",
                "--report", "mine.html")
    found = ts.calibrate_impulse_response(scope, base)
    for name in ("excitation", "background", "height", "snr_db", "delay_s", "fit_is_good", "notes"):
        assert getattr(found, name) == said[name], name
    assert found.bandwidth_hz == pair(said["bandwidth_hz"])
    assert [f.response.kind for f in found.fits] == [f["kind"] for f in said["fits"]]
    assert [f.parameter_hz for f in found.fits] == [pair(f["parameter_hz"]) for f in said["fits"]]
    written = found.write_camera(both[1] / "mine.toml", base)
    same(both, "mine.toml", "mine-response.csv")
    found.write_report(both[1] / "mine.html", source=str(scope))
    same_page(both, "mine.html")
    np.testing.assert_allclose(written.transfer(9), found.camera(base).transfer(9), rtol=1e-6)
    fit, whole = found.camera(base, arm="sensor", kind="gaussian"), found.camera(base, arm="system")
    assert (fit.light, fit.sensor.impulse_response) == (base.light, found.fits[0].response)
    assert (whole.light.impulse_response.kind, whole.sensor.impulse_response.kind) == ("file", "none")


@pytest.fixture(scope="module")
def sweep():
    """A flat target of 3 x 4 pixels at 60 delays plus the first one again, with arms of 75 MHz."""
    camera = base.replace(light={"impulse_response": narrow}, sensor={"impulse_response": narrow})
    model = ts.ForwardModel("hamiltonian-k4", camera)
    rng = np.random.default_rng(2)
    bins = np.append(np.arange(60), 0)
    clean = np.stack([model.expected_electrons(bins + o, 1e6, 0) for o in rng.normal(0, 0.3, 12)], 1)
    frames = clean.reshape(61, 3, 4, 4) + rng.normal(0, 10, (61, 3, 4, 4))
    return ts.DelaySweep(bins / 60, frames.astype(np.float32))


def test_delay_sweep_equals_the_command(both, sweep, cli):
    measured = sweep
    ts.write_raw(both[0] / "frames.npy", measured.frames)
    np.savetxt(both[0] / "shifts.txt", measured.delay_periods, "%.17g")
    said = printed(cli, both[0], "correlation", "frames.npy", "--shifts", "shifts.txt",
                "--shift-unit", "period", "--camera", "base.toml", "--table", "table.npz",
                "--offset-map", "offset.npy", "--gain-map", "gain.npy", "-o", "fitted.toml",
                "--report", "sweep.html")
    read = ts.read_delay_sweep(both[0] / "frames.npy", base, shifts=both[0] / "shifts.txt",
                               unit="period")
    np.testing.assert_array_equal(read.frames, measured.frames)
    np.testing.assert_array_equal(read.delay_periods, measured.delay_periods)
    found = ts.calibrate_correlation(measured, base)
    found.write_table(both[1] / "table.npz")
    found.write_maps(both[1] / "offset.npy", both[1] / "gain.npy")
    fits = ts.fit_ideal_codes(found, base)
    fits[0].camera(base).write(both[1] / "fitted.toml")
    same(both, "table.npz", "offset.npy", "gain.npy")
    same_camera(both, "fitted.toml")
    ts.write_correlation_report(both[1] / "sweep.html", found, fits, source="frames.npy")
    same_page(both, "sweep.html")
    assert found.light_drift == pair(said["light_drift"])
    for fit, entry in zip(fits, said["ideal_codes"], strict=True):
        assert (fit.code, fit.residual, fit.exposure) == tuple(
            entry[name] for name in ("code", "residual", "exposure"))
        assert np.array_equal([h.ratio for h in fit.harmonics],
                              [pair(h["ratio"]) for h in entry["harmonics"]], equal_nan=True)
    assert fits[0].code == "hamiltonian-k4"


def test_noise_equals_the_command(both, cli):
    rng = np.random.default_rng(3)
    levels = [np.round(100 + rng.poisson(e, (2, 32, 32, 1)) / 8 + rng.normal(0, 2.5, (2, 32, 32, 1)))
              for e in (0, 800, 4000, 12000)]
    names = ["dark.npy", "a.npy", "b.npy", "c.npy"]
    for name, frames in zip(names, levels):
        ts.write_raw(both[0] / name, frames)
    said = printed(cli, both[0], "noise", *names[1:], "--dark", names[0], "--camera", "base.toml",
                "-o", "noisy.toml", "--report", "noise.html")
    found = ts.photon_transfer(levels[1:], base, dark=levels[0])
    found.camera(base).write(both[1] / "noisy.toml")
    same_camera(both, "noisy.toml")
    found.write_report(both[1] / "noise.html")
    same_page(both, "noise.html")
    assert found.gain_e_per_dn == pair(said["gain_e_per_dn"])
    assert [p.mean_dn for p in found.points] == [p["mean_dn"] for p in said["points"]]
    assert found.full_well_e is None


def test_noise_of_differences_requires_their_code():
    camera = base.replace(sensor=sensor | {"taps": 2, "readout": "difference", "read_noise_e": 20.0})
    dark, *levels = (ts.capture(np.full((48, 48), 2.0), "sinusoid-k4", camera, signal_e_per_s=signal,
                                ambient_e_per_s=0.0, seed=i, frames=2)
                     for i, signal in enumerate((0.0, 3e5, 6e5, 9e5)))
    assert ts.photon_transfer(levels, camera, dark=dark, code="sinusoid-k4").buckets == 2
    with pytest.raises(ValueError, match="code: got none"):
        ts.photon_transfer(levels, camera, dark=dark)
    with pytest.raises(ValueError, match="code: is only valid with"):
        ts.photon_transfer(levels, base, dark=dark, code="sinusoid-k4")


def test_drift_with_two_temperatures_is_that_of_the_command(both, cli):
    light = np.array([20, 26, 32, 38, 44, 38, 32, 26, 20.0])
    sensor = np.array([20, 20, 23, 28, 33, 37, 36, 33, 29.0])
    truth = base.replace(temperature={
        "reference_c": 20.0, "offset_m_per_c": 2e-3,
        "sensor": {"reference_c": 20.0, "offset_m_per_c": -1e-3}})
    scene = np.linspace(1, 8, 64, dtype=np.float32).reshape(8, 8)
    frames = np.concatenate([
        ts.capture(scene, "sinusoid-k4", truth.at_temperature(l, s), signal_e_per_s=1e7,
                   ambient_e_per_s=0.0, falloff=False, seed=i)[None]
        for i, (l, s) in enumerate(zip(light, sensor))])
    ts.write_raw(both[0] / "sweep.npy", frames)
    rows = "".join(f"{f},{l},{s}\n" for f, (l, s) in enumerate(zip(light, sensor)))
    (both[0] / "degrees.csv").write_text("frame,light_c,sensor_c\n" + rows)
    said = printed(cli, both[0], "temperature", "sweep.npy", "--temperatures", "degrees.csv",
                   "--light-column", "light_c", "--sensor-column", "sensor_c",
                   "--code", "sinusoid-k4", "--camera", "base.toml", "--reference-c", "20",
                   "--sensor-reference-c", "20", "-o", "warms.toml", "--report", "drifts.html")
    found = ts.calibrate_temperature(frames, light, "sinusoid-k4", base,
                                     sensor_temperature_c=sensor)
    camera = found.camera(base, reference_c=20, sensor_reference_c=20)
    camera.write(both[1] / "warms.toml")
    same_camera(both, "warms.toml")
    found.write_report(both[1] / "drifts.html", source="sweep.npy")
    same_page(both, "drifts.html")
    assert found.sensor.offset_m_per_c == pair(said["sensor"]["offset_m_per_c"])
    assert found.hysteresis_m == pair(said["hysteresis_m"])
    assert camera.at_temperature(44, 33).temperature.sensor.now_c == 33
    alone = ts.calibrate_temperature(frames, light, "sinusoid-k4", base)
    one = alone.camera(base, reference_c=20)
    assert alone.sensor is None and one.temperature.sensor is None
    assert one.at_temperature(44).temperature.now_c == 44
    printed(cli, both[0], "temperature", "sweep.npy", "--temperatures", "degrees.csv",
            "--light-column", "light_c", "--code", "sinusoid-k4", "--camera", "base.toml",
            "--reference-c", "20", "-o", "one.toml")
    one.write(both[1] / "one.toml")
    same_camera(both, "one.toml")
    with pytest.raises(ValueError, match="no .temperature."):
        base.at_temperature(30.0)
    with pytest.raises(ValueError, match="no .temperature.sensor."):
        base.replace(temperature={"offset_m_per_c": 1e-3}).at_temperature(30.0, 30.0)


def test_stray_light_equals_the_command(both, cli):
    target = np.full((8, 30, 30, 4), 100.0)
    target[:, 12:16, 12:16] += [900, 500, 200, 700]
    target += np.random.default_rng(4).normal(0, 3, target.shape)
    ts.write_raw(both[0] / "target.npy", target)
    camera = base.replace(sensor=sensor)
    camera.write(both[0] / "dn.toml")
    said = printed(cli, both[0], "stray-light", "target.npy", "--camera", "dn.toml", "-o",
                   "kernel.npy", "--report", "stray.html")
    found = ts.calibrate_stray_light(target, camera)
    found.write(both[1] / "kernel.npy")
    same(both, "kernel.npy")
    found.write_report(both[1] / "stray.html", source="target.npy")
    same_page(both, "stray.html")
    assert found.total == pair(said["total"])
    kernel = np.full((5, 5), 0.004, np.float32)
    raw = np.full((9, 9, 4), 200.0, np.float32)
    clean = ts.remove_stray_light(raw, kernel, "hamiltonian-k4", camera)
    assert clean.shape == raw.shape and clean[0, 0, 0] > 203
    walls = np.full((9, 9), 2.0, np.float32)
    plain, seen = (ts.capture(walls, "hamiltonian-k4", "paper-10f0", signal_e_per_s=1e9, **more)
                   for more in ({}, {"stray_light": kernel}))
    assert seen[0, 0, 0] < plain[0, 0, 0]


frames = np.ones((4, 2, 2, 4))
delays = np.arange(4) / 4


def calibrated(*arguments, **options):
    return lambda: ts.calibrate_correlation(ts.DelaySweep(*arguments), base, **options)


refusals = [
    (lambda: ts.calibrate_impulse_response([1, 2], base), TypeError, "record: got list [1, 2]; needs a tofsmith.ResponseRecord"),
    (lambda: ts.calibrate_impulse_response(ts.ResponseRecord(np.ones(40), 1.0), base), ValueError, "record.time_step_s: got 1 s; needs > 0 and at most the camera's period of 6.667e-08 s"),
    (lambda: ts.calibrate_impulse_response(ts.ResponseRecord(np.ones((4, 4)), 1e-10), base), ValueError, "record.values: got shape (4, 4); needs (T,)"),
    (lambda: ts.calibrate_impulse_response(ts.ResponseRecord(np.ones(40), 1e-10), base), ValueError, "record = constant; must contain a response"),
    (lambda: ts.calibrate_impulse_response(ts.ResponseRecord(np.r_[np.zeros(30), 1, np.zeros(30)], 1e-10), base, excitation="ramp"), ValueError, "ramp"),
    (lambda: ts.read_response_record("/nowhere/a.csv"), OSError, "/nowhere/a.csv"),
    (lambda: ts.read_response_record("a.csv", decimal="dot"), ValueError, "dot"),
    (lambda: ts.read_delay_sweep("a.csv", base, unit="h"), ValueError, "h"),
    (calibrated(delays, frames[0]), ValueError, "sweep.frames: got shape (2, 2, 4); needs (F, H, W, K)"),
    (calibrated(delays[:3], frames), ValueError, "3"),
    (calibrated(delays / 9, frames), ValueError, "period"),
    (calibrated(delays * np.nan, frames), ValueError, "sweep.delay_periods: got nan at 0; needs finite numbers"),
    (calibrated(delays, frames, target_distance_m=1.0), ValueError, "requires the camera's [lens]"),
    (calibrated(delays, frames, dark=frames[0]), ValueError, "dark: got shape (2, 2, 4); needs (F, H, W, K)"),
    (calibrated(delays, frames, geometry_m=frames), ValueError, "geometry_m: got shape (4, 2, 2, 4); needs (H, W)"),
    (lambda: ts.calibrate_correlation(3, base), TypeError, "sweep: got int 3; needs a tofsmith.DelaySweep"),
    (lambda: ts.fit_ideal_codes(frames, base), TypeError, "found: got an array of shape"),
    (lambda: ts.photon_transfer([np.ones((2, 4, 4, 1))], base), ValueError, "dark frames = 0; must be > 0, or the black level must be given"),
    (lambda: ts.photon_transfer([frames[0]], base), ValueError, "levels[0]: got shape (2, 2, 4); needs (F, H, W, K)"),
    (lambda: ts.photon_transfer([frames], base, black_level_dn="0"), TypeError, "black_level_dn: got str '0'; needs a number"),
    (lambda: ts.photon_transfer([frames], base.replace(sensor={"taps": 2, "readout": "difference"})), ValueError, "mean of differences"),
]


@pytest.mark.parametrize("call, kind, message", refusals, ids=[r[2][:50] for r in refusals])
def test_rejects_bad_input_by_name(call, kind, message):
    with pytest.raises(kind, match=re.escape(message)):
        call()


def test_existing_files_are_kept(both, scope, sweep):
    found = ts.calibrate_impulse_response(scope, base)
    path = both[1] / "kept.toml"
    found.write_camera(path, base)
    for write in (lambda: found.write_camera(path, base), lambda: base.write(path)):
        with pytest.raises(OSError, match="already exists; .* overwrite=True"):
            write()
    means = ts.DelaySweep(sweep.delay_periods, sweep.frames.mean((1, 2), keepdims=True))
    with pytest.raises(ValueError, match="a table of means, which has no pixels"):
        ts.calibrate_correlation(means, base).write_maps(both[1] / "map.npy")


def test_kinect_frequencies_have_their_own_offsets_and_contrasts():
    camera, code = ts.Camera("kinect-v2"), "multifrequency-2x3-10x3-15x3"
    real = camera.replace(playback={"offset_rad": [0.78, -2.16, 0.24]},
                          sensor={"modulation_contrast": [0.6, 0.45, 0.37]})
    rows, columns = np.mgrid[0:30, 0:40]
    depth = np.stack([0.8 + 0.7 * f + 0.5 * np.sin(rows / 9 + columns / 13) for f in range(5)])
    raw = np.stack([ts.capture(one.astype(np.float32), code, real, signal_e_per_s=2e6,
                               ambient_e_per_s=1e5, falloff=False, seed=f).reshape(30, 40, 9)
                    for f, one in enumerate(depth)])
    found = ts.calibrate_correlation(raw, camera, reference=depth, code=code)
    assert [its.frequency_hz for its in found.frequencies] == [16e6, 80e6, 120e6]
    for decoder in (ts.Decoder(found.decoding_table(camera)), ts.Decoder(code, found.camera(camera))):
        image = decoder.decode(raw[2])
        assert (image.status == 0).mean() > 0.98
        assert np.abs(image.depth_m - depth[2])[image.status == 0].max() < 0.15


def frames_and_depth():
    """A camera with four phases, frames (4, 40, 48, 4) of its own scale, and their depth."""
    camera = base.replace(fundamental_frequency_hz=60e6, sensor={
        "taps": 2, "readout": "difference", "drain": False})
    rows, columns = np.mgrid[0:40, 0:48]
    nominal = camera.range_m * (np.arange(4)[:, None, None] + 0.5 + 0.5 * np.sin(
        rows / 9 + columns / 7)) / 4
    phase = 2 * np.pi * nominal / camera.range_m
    raw = 2e4 * np.cos(phase[..., None] - np.arange(4) * np.pi / 2)
    raw = (raw + np.random.default_rng(3).normal(size=raw.shape) * 100).astype(np.float32)
    return camera, raw, (nominal - 0.4 - 0.01 * np.cos(4 * phase)) % camera.range_m


def test_the_kind_of_reference_depth_is_as_its_file_states(tmp_path):
    camera, raw, depth = frames_and_depth()
    lens = ts.Lens(fx_px=40.0, fy_px=40.0, cx_px=23.5, cy_px=19.5)
    camera = camera.replace(lens=lens)
    z_m = ts.z_from_radial(depth[0].astype(np.float32), lens)
    np.savez(tmp_path / "z.npz", depth=z_m, depth_is_z=np.ones(1, np.uint8))

    def terms(reference, **kind):
        return ts.calibrate_correlation(raw[:1], camera, reference=reference, code="sinusoid-k4",
                                        **kind).terms

    assert terms(tmp_path / "z.npz") == terms(z_m, reference_kind="z") != terms(z_m)
    with pytest.raises(OSError, match="kind z; expected radial"):
        terms(tmp_path / "z.npz", reference_kind="radial")


def test_reference_depth_equals_the_command(both, cli):
    camera, raw, depth = frames_and_depth()
    camera.write(both[0] / "phases.toml")
    np.save(both[0] / "frames.npy", raw)
    np.save(both[0] / "depth.npy", depth)
    said = printed(cli, both[0], "correlation", "frames.npy", "--reference", "depth.npy", "--code",
                   "sinusoid-k4", "--camera", "phases.toml", "--table", "wiggle.npz")
    found = ts.calibrate_correlation(raw, camera, reference=depth, code="sinusoid-k4")
    assert {t["name"]: (t["value_m"], t["standard_error_m"]) for t in said["terms"]} == found.terms
    found.write_table(both[1] / "wiggle.npz")
    same(both, "wiggle.npz")
    found.write_report(both[1] / "page.html", source="my camera")
    assert "Depth of my camera against a reference" in (both[1] / "page.html").read_text()
    assert ts.Decoder(found.decoding_table(camera)).decode(raw[0]).depth_m.shape == (40, 48)
    with pytest.raises(ValueError, match="code: got None"):
        ts.calibrate_correlation(raw, camera, reference=depth)

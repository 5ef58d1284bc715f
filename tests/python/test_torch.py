# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""tofsmith.torch: gradients equal finite differences, values equal the library."""

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import tofsmith as ts

torch = pytest.importorskip("torch", reason="PyTorch is not installed: apt install python3-torch")
from torch.autograd import gradcheck  # noqa: E402

from tofsmith import torch as tst  # noqa: E402

root = Path(__file__).resolve().parents[2]
N = 24
cameras = {
    "limited": ts.Camera("paper-10f0", samples=N),
    "causal, dark, quantized": ts.Camera(
        "paper-10f0", samples=N, light={"impulse_response": {"kind": "lowpass", "cutoff_hz": 60e6}},
        sensor={"impulse_response": {"kind": "gaussian", "cutoff_hz": 90e6}, "gain_e_per_dn": 4.0,
                "dark_current_e_per_s": 500.0, "adc_bits": 12, "full_well_e": 1e5}),
    "two taps, circular": ts.Camera(
        "paper-10f0", samples=N, operating={"error": "circular"},
        sensor={"taps": 2, "drain": False, "modulation_contrast": 0.7}),
    "differences": ts.Camera(
        "paper-10f0", samples=N,
        sensor={"taps": 2, "drain": False, "readout": "difference", "dark_current_e_per_s": 500.0}),
}
every_camera = pytest.mark.parametrize("camera", cameras.values(), ids=cameras.keys())


def doubles(values):
    return torch.as_tensor(np.asarray(values), dtype=torch.float64)


def waveforms(camera, seed=1):
    """Returns smooth waveforms of three exposures with random perturbations, valid for the camera.
    """
    random = np.random.default_rng(seed)
    taps, time = camera.sensor.taps, np.arange(N) / N
    places = np.arange(3) / 3
    light = np.exp(-0.5 * (np.sin(np.pi * (time[:, None] - 0.2 * places)) / 0.3) ** 2)
    light *= 1 + 0.2 * random.random(light.shape)
    gates = 0.42 + 0.38 * np.sin(2 * np.pi * (time[:, None] - places)) * (0.9 + 0.1 * random.random((N, 3)))
    if taps == 2:
        gates = np.stack([gates, 1 - gates], axis=-1).reshape(N, 6)
    return doubles(light / light.mean(0)), doubles(gates)


def table_of(camera, seed=1):
    return tst.measurement_table(*waveforms(camera, seed), camera)


def pixels(camera, count=7, seed=2):
    random = np.random.default_rng(seed)
    return (doubles(camera.range_m * random.random(count)), doubles(1e4 * (5 + random.random(count))),
            doubles(1e4 * random.random(count)))


def given(table):
    return [t for t in table if t is not None]


def holds(function, *inputs):
    """Returns whether the gradient equals finite differences to 1e-6, relative to the function."""
    tensors = [t.detach().clone().requires_grad_() for t in inputs]
    size = function(*tensors).detach().abs().max()
    return gradcheck(lambda *x: function(*x) / size, tensors, rtol=1e-6, atol=1e-6)


@every_camera
def test_values_equal_the_library(camera):
    modulation, demodulation = waveforms(camera)
    table = tst.measurement_table(modulation, demodulation, camera)
    code = ts.CodeSet.from_arrays(modulation.numpy(), demodulation.numpy(), taps=camera.sensor.taps)
    model = ts.ForwardModel(code, camera)
    np.testing.assert_allclose(table.correlation, model.correlation_table(), rtol=0, atol=1e-12)
    np.testing.assert_allclose(table.ambient_gain, model.ambient_gain, rtol=0, atol=1e-12)
    depth_bin = np.random.default_rng(3).uniform(-N, 2 * N, 40)
    depth_m = doubles(depth_bin * camera.range_m / N)
    for light in ((1e5, 1e4), (1e4, 0.0)):
        np.testing.assert_allclose(tst.expected_electrons(table, camera, depth_m, *light),
                                   model.expected_electrons(depth_bin, *light), rtol=1e-7, atol=1e-6)
        np.testing.assert_allclose(tst.variance_e2(table, camera, depth_m, *light),
                                   model.variance_e2(depth_bin, *light), rtol=1e-7)
        np.testing.assert_allclose(tst.cramer_rao_bound_m(table, camera, *light),
                                   ts.CramerRaoBound(code, camera).sigma_m(*light), rtol=1e-6)


@every_camera
def test_gradients_equal_finite_differences(camera):
    made = tst.MeasurementTable
    table, (depth_m, signal, ambient) = table_of(camera), pixels(camera)
    shares = doubles(np.random.default_rng(4).standard_normal((len(given(table)), 1, 1)))
    assert holds(lambda m, d: sum(s * t for s, t in zip(shares, given(
        tst.measurement_table(m, d, camera)))), *waveforms(camera))
    unit = (depth_m, signal / 1e4, ambient / 1e4)
    for function in (tst.expected_electrons, tst.variance_e2,
                     lambda *x: tst.capture(*x, seed=5)):
        assert holds(lambda z, s, a, *t: function(made(*t), camera, z, 1e4 * s, 1e4 * a), *unit,
                     *given(table))
    y = tst.capture(table, camera, depth_m, signal, ambient, seed=5) / 1e4
    heat = doubles(np.random.default_rng(6).uniform(0.2, 0.4, 7)) * y.var()
    assert holds(lambda y, h, *t: tst.soft_decode(1e4 * y, made(*t), camera, 1e8 * h), y, heat,
                 *given(table))
    assert holds(lambda y, h, *t: tst.soft_depth_error_m(1e4 * y, depth_m, made(*t), camera, 1e8 * h),
                 y, heat, *given(table))
    # Bounds change rapidly where depth information almost vanishes: use smaller steps.
    assert holds(lambda s, a, *t: tst.cramer_rao_bound_m(
        made(*(0.1 * x for x in t)), camera, 1e5 * s, 1e4 * a).log(),
        doubles([1.0, 0.3]), doubles([1.0, 0.5]), *(10 * x for x in given(table)))


@every_camera
def test_captures_have_the_mean_and_variance_of_the_camera(camera):
    table, trials = table_of(camera), 20000
    light = (doubles(3.1).expand(trials), 1e5, 1e4)
    y = tst.capture(table, camera, *light, seed=7)
    mean, variance = (f(table, camera, 3.1, 1e5, 1e4) for f in (tst.expected_electrons, tst.variance_e2))
    assert ((y.mean(0) - mean).abs() < 4 * (variance / trials).sqrt()).all()
    assert ((y.var(0) / variance - 1).abs() < 4 * (2 / trials) ** 0.5).all()
    assert torch.equal(y, tst.capture(table, camera, *light, seed=7))
    assert not torch.equal(y, tst.capture(table, camera, *light, seed=8))


def test_a_sharp_decoder_finds_every_depth_without_noise():
    for camera in cameras.values():
        table, (depth_m, signal, ambient) = table_of(camera), pixels(camera, 50)
        y = tst.expected_electrons(table, camera, depth_m, signal, ambient)
        found = tst.soft_decode(y, table, camera, 1e-2)
        # The decoder interpolates linearly between these few bins.
        assert (found - depth_m).abs().max() < 0.25 * camera.range_m / N
        error = tst.soft_depth_error_m(y, depth_m, table, camera, 1e-2)
        torch.testing.assert_close(error, (found - depth_m).abs(), rtol=0, atol=1e-3)


@every_camera
def test_a_batch_equals_a_loop(camera):
    codes = [waveforms(camera, seed) for seed in (1, 2, 3)]
    batch = tst.measurement_table(*(torch.stack(w) for w in zip(*codes)), camera)
    lights = [pixels(camera, 70, seed) for seed in (4, 5, 6)]
    light = [torch.stack(column) for column in zip(*lights)]
    y = tst.expected_electrons(batch, camera, *light)
    depth = tst.soft_decode(y, batch, camera, 1e4)
    bound = tst.cramer_rao_bound_m(batch, camera, light[1][:, :2], 1e4)
    for b, (code, of_code) in enumerate(zip(codes, lights)):
        table = tst.measurement_table(*code, camera)
        assert torch.equal(table.correlation, batch.correlation[b])
        one = tst.expected_electrons(table, camera, *of_code)
        assert torch.equal(one, y[b])
        assert torch.equal(tst.soft_decode(one, table, camera, 1e4), depth[b])
        assert torch.equal(tst.cramer_rao_bound_m(table, camera, of_code[1][:2], 1e4), bound[b])
    image = tst.expected_electrons(table, camera, light[0].reshape(3, 2, 35), 1e5, 1e4)
    assert image.shape == (3, 2, 35, y.shape[-1])


def test_results_are_bit_identical_for_any_number_of_threads():
    camera = cameras["two taps, circular"]
    modulation, demodulation = (w.requires_grad_() for w in waveforms(camera))
    depth_m, signal, ambient = pixels(camera, 3000)

    def gradients():
        table = tst.measurement_table(modulation, demodulation, camera)
        y = tst.capture(table, camera, depth_m, signal, ambient, seed=1)
        error = tst.soft_depth_error_m(y, depth_m, table, camera, 1e4)
        loss = error.mean() + tst.cramer_rao_bound_m(table, camera, 1e5, 1e4).mean()
        return torch.autograd.grad(loss, (modulation, demodulation))

    try:
        ts.set_threads(1)
        one = gradients()
        ts.set_threads(3)
        three = gradients()
    finally:
        ts.set_threads(0)
    assert all(torch.equal(a, b) for a, b in zip(one, three))


def test_many_codes_on_many_threads_give_equal_results():
    camera = cameras["limited"]
    code = (w.float().expand(200, -1, -1) for w in waveforms(camera))
    table = tst.measurement_table(*code, camera)
    y = tst.capture(table, camera, torch.rand(3), 1e5, 1e4, seed=1)
    try:
        ts.set_threads(6)
        found = [tst.soft_decode(y, table, camera, 1e4) for _ in range(50)]
    finally:
        ts.set_threads(0)
    assert all(torch.equal(found[0], again) for again in found)


def test_float32_is_accurate():
    camera = cameras["two taps, circular"]
    depth_m, signal, ambient = pixels(camera, 50)
    answers = []
    for dtype in (torch.float64, torch.float32):
        leaves = [w.to(dtype).requires_grad_() for w in waveforms(camera)]
        table = tst.measurement_table(*leaves, camera)
        y = tst.capture(table, camera, depth_m.to(dtype), signal.to(dtype), ambient.to(dtype), seed=1)
        error = tst.soft_depth_error_m(y, depth_m.to(dtype), table, camera, 1e4)
        assert error.dtype == dtype
        answers.append([error, *torch.autograd.grad(error.sum(), leaves)])
    for double, single in zip(*answers):
        assert (double - single).norm() < 1e-3 * double.norm()


def test_rejects_bad_input_by_name():
    camera = cameras["limited"]
    modulation, demodulation = waveforms(camera)
    table, (depth_m, signal, ambient) = table_of(camera), pixels(camera)
    y = tst.expected_electrons(table, camera, depth_m, signal, ambient)
    nan = depth_m.clone()
    nan[3] = float("nan")
    made = tst.measurement_table
    cases = [
        (lambda: made(modulation.T, demodulation, camera), "demodulation: got shape .24, 3.; needs"),
        (lambda: made(modulation.float(), demodulation, camera), "float64; needs torch.float32"),
        (lambda: made(modulation.int(), demodulation, camera), "modulation: got torch.int32"),
        (lambda: made(modulation.numpy(), demodulation, camera), "needs a torch.Tensor"),
        (lambda: made(modulation[:4], demodulation[:4], camera), "samples = 4"),
        (lambda: made(modulation[:0], demodulation[:0], camera), "empty"),
        (lambda: made(modulation.to("meta"), demodulation, camera), "on meta"),
        (lambda: made(modulation, demodulation, "no-such-camera"), "no-such-camera"),
        (lambda: made(modulation, demodulation, camera.replace(sensor={"tap_mismatch": 0.1, "taps": 2})),
         "demodulation: got shape"),
        (lambda: made(modulation, demodulation, camera.replace(exposure_s=[0.1, 0.2])), "exposures = 3"),
        (lambda: tst.expected_electrons(table, camera, nan, signal, ambient), "depth_m: got nan at .3"),
        (lambda: tst.expected_electrons(table, camera, depth_m, -signal, ambient), "signal_e_per_s: got -"),
        (lambda: tst.expected_electrons(table, camera, depth_m, signal[:3], ambient), "broadcast"),
        (lambda: tst.expected_electrons(table[0], camera, depth_m, signal, ambient), "measurement_table"),
        (lambda: tst.expected_electrons(table, cameras["two taps, circular"], depth_m, 1.0, 1.0),
         "multiple of the 2 taps"),
        (lambda: tst.expected_electrons(table, cameras["differences"], depth_m, 1.0, 1.0),
         "table.shot_correlation"),
        (lambda: tst.capture(table, camera, depth_m, signal, ambient, seed=-1), "seed: got -1"),
        (lambda: tst.soft_decode(y.T, table, camera, 1.0), "electrons: got shape"),
        (lambda: tst.soft_decode(y, table, camera, 0.0), "temperature_e2: got 0"),
        (lambda: tst.soft_depth_error_m(y, depth_m.requires_grad_(), table, camera, 1.0), "depth_m: .*detach"),
        (lambda: tst.cramer_rao_bound_m(table._replace(ambient_gain=table.correlation), camera, 1.0, 1.0),
         "table.ambient_gain: got shape"),
    ]
    for case, message in cases:
        with pytest.raises((ValueError, TypeError, OSError), match=message):
            case()
    error = tst.expected_electrons(table, camera, 1.0, signal.requires_grad_(), 1.0)
    gradient, = torch.autograd.grad((error**2).sum(), signal, create_graph=True)
    with pytest.raises(RuntimeError, match="once_differentiable"):
        gradient.sum().backward()


def test_the_example_reduces_its_loss(tmp_path):
    done = subprocess.run(
        [sys.executable, "-B", root / "examples" / "python" / "learn_a_code.py", "5", "3"],
        cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert re.search(r"optimize: .* mm\nlearned code: .* mm\nlearned code, learned decoder: .* mm",
                     done.stdout), done.stdout

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Errors name the invalid argument, its value and the requirement."""

import re
import warnings
from functools import cache

import numpy as np
import pytest

import tofsmith as ts

raw = np.ones((4, 5, 4), np.float32)
depth = np.ones((2, 2))


@cache
def decoder():
    return ts.Decoder("hamiltonian-k4", ts.Camera("paper-10f0", samples=60))


def read_only_plane():
    plane = np.zeros((4, 5), np.float32)
    plane.flags.writeable = False
    return ts.DepthImage(depth_m=plane)


def out_of(array):
    return ts.DepthImage(depth_m=array)


refusals = [
    (lambda: decoder().decode(raw.astype(bool)), ValueError, "raw: got dtype bool; needs float32, float64, uint16 or uint8"),
    (lambda: decoder().decode(raw.astype(">f4")), ValueError, "raw: got dtype >f4; needs"),
    (lambda: decoder().decode(raw.astype(complex)), ValueError, "raw: got dtype complex128; needs"),
    (lambda: decoder().decode(raw.astype(object)), ValueError, "raw: got dtype object; needs"),
    (lambda: decoder().decode(raw[0]), ValueError, "raw: got shape (5, 4); needs (H, W, K) or (F, H, W, K)"),
    (lambda: decoder().decode(raw[..., :3]), ValueError, "raw: got shape (4, 5, 3); needs 4 measurements"),
    (lambda: decoder().decode(np.ones((4, 6, 7), np.float32)), ValueError, "layout='planar' would fit"),
    (lambda: decoder().decode(np.ones((0, 5, 4), np.float32)), ValueError, "raw: got shape (0, 5, 4); needs"),
    (lambda: decoder().decode(raw, layout="KHW"), ValueError, "layout: got str 'KHW'; needs one of interleaved, planar"),
    (lambda: decoder().decode([[1.0]]), TypeError, "raw[0]: got list [1.0]; needs a numpy.ndarray"),
    (lambda: decoder().decode(np.zeros(20, np.dtype([("a", "f4"), ("b", "u1")]))["a"].reshape(1, 5, 4)), ValueError, "needs a multiple of the 4 bytes"),
    (lambda: decoder().decode(raw, planes=["deep"]), ValueError, "planes: got str 'deep'; needs one of depth_m, signal"),
    (lambda: decoder().decode(raw, planes=["delay_m"]), ValueError, "planes: got str 'delay_m'; needs one of"),
    (lambda: decoder().decode(raw, planes=[]), ValueError, "planes: got none; needs at least one"),
    (lambda: decoder().decode(raw, out=read_only_plane()), ValueError, "out.depth_m: got a read-only array; needs one that can be written"),
    (lambda: decoder().decode(raw, out=out_of(np.zeros((4, 5)))), ValueError, "out.depth_m: got dtype float64; needs float32"),
    (lambda: decoder().decode(raw, out=out_of(np.zeros((5, 4), np.float32))), ValueError, "out.depth_m: got shape (5, 4); needs shape (4, 5)"),
    (lambda: decoder().decode(raw, out=out_of(np.zeros((5, 4), np.float32).T)), ValueError, "needs C order without gaps"),
    (lambda: decoder().decode(raw, out=np.zeros((4, 5))), TypeError, "out: got an array of shape (4, 5) and dtype float64; needs a tofsmith.DepthImage"),
    (lambda: decoder().decode(raw, gain=np.ones(3)), ValueError, "gain: got shape (3,); needs (H, W)"),
    (lambda: decoder().decode(raw, progress=3), TypeError, "progress: got int 3; needs a function"),
    (lambda: ts.Decoder("hamiltonian-k4", "paper-10f0", method="znc"), ValueError, "method: got str 'znc'; needs one of zncc, ml"),
    (lambda: ts.Decoder("hamiltonian-k4", "paper-10f0", low_signal_sigma="3"), TypeError, "low_signal_sigma: got str '3'; needs a number"),
    (lambda: ts.Filter("hamiltonian-k4", "paper-10f0", strength="weak"), ValueError, "strength: got str 'weak'; needs one of light, normal, strong"),
    (lambda: ts.Filter("hamiltonian-k4"), TypeError, "camera: got None; needs a tofsmith.Camera"),
    (lambda: ts.Decoder("hamiltonian-k4", "paper-10f0").decode_recording("r.npy", "d.npz", time_filter={"max_difference_sigma": 4}), ValueError, "time_filter: got dict"),
    (lambda: ts.decode(np.ones((2, 3, 4)), "hamiltonian-k4", "paper-10f0", filter=3), TypeError, "filter: got int 3; needs one of light, normal, strong, or a dict"),
    (lambda: ts.Decoder("hamiltonian-k4"), TypeError, "camera: got None; needs a tofsmith.Camera"),
    (lambda: ts.Decoder("hamiltonian-k4", 15e6), TypeError, "camera: got float 15000000.0; needs a tofsmith.Camera"),
    (lambda: ts.Decoder(3, "paper-10f0"), TypeError, "code: got int 3; needs a tofsmith.CodeSet"),
    (lambda: ts.Camera("paper-10f0", light={"peak_factr": 5}), ValueError, "did you mean"),
    (lambda: ts.Camera("paper-10f0", samples=2**40), ValueError, "samples"),
    (lambda: ts.Camera(samples=120), ValueError, "fundamental_frequency_hz"),
    (lambda: ts.Camera("paper-10f0", samples=None), TypeError, "samples: got NoneType None; needs a number, text"),
    (lambda: ts.Camera(b"paper-10f0"), TypeError, "name_or_path: got bytes"),
    (lambda: ts.Camera.from_toml("samples = 1\n", "mine.toml"), OSError, "mine.toml: found no fundamental_frequency_hz"),
    (lambda: ts.CodeSet.from_arrays(np.ones((8, 2)), np.ones((8, 3))), ValueError, "demodulation: got shape (8, 3); needs (8, 2)"),
    (lambda: ts.CodeSet.from_arrays(np.ones(8), np.ones((8, 3))), ValueError, "modulation: got shape (8,); needs (N, E)"),
    (lambda: ts.CodeSet.from_arrays(np.full((8, 1), np.nan), np.ones((8, 1))), ValueError, "modulation: got nan at (0, 0); needs finite numbers"),
    (lambda: ts.CodeSet.from_arrays(np.array([["a"]]), np.ones((8, 1))), ValueError, "modulation: got dtype <U1; needs real numbers"),
    (lambda: ts.CodeSet.from_arrays(np.ones((0, 0)), np.ones((8, 1))), ValueError, "modulation: got shape (0, 0), which is empty"),
    (lambda: ts.CodeSet.from_rows(np.ones(8), np.full((8, 4), np.inf)), ValueError, "rows: got inf at (0, 0); needs finite numbers"),
    (lambda: ts.CodeSet.from_arrays(np.ones((8, 1)), 2 * np.ones((8, 1))), ValueError, "demodulation"),
    (lambda: ts.read_code("/nowhere/a.json"), OSError, "/nowhere/a.json"),
    (lambda: ts.ForwardModel("hamiltonian-k4", "paper-10f0").correlation([1.0, np.inf]), ValueError, "depth_bin: got inf at 1; needs finite"),
    (lambda: ts.ForwardModel("hamiltonian-k4", "paper-10f0").correlation_table(10**9), ValueError, "points: got 1000000000; needs a whole number from 1"),
    (lambda: ts.evaluate("hamiltonian-k4", "paper-10f0", trials=2.5), TypeError, "trials: got float 2.5; needs a whole number"),
    (lambda: ts.evaluate("hamiltonian-k4", "paper-10f0", seed=-1), ValueError, "seed: got int -1; needs a whole number from 0"),
    (lambda: ts.evaluate("hamiltonian-k4", "paper-10f0", depth="grid"), ValueError, "depth = grid; must be uniform or bins"),
    (lambda: ts.robustness("square-k4", "paper-10f0", bandwith=0.1), TypeError, "did you mean bandwidth?"),
    (lambda: ts.CramerRaoBound("square-k4", "paper-10f0").mae_m(-1, 0), ValueError, "signal_e_per_s: got -1; needs a number >= 0"),
    (lambda: ts.ReceiverBound("paper-10f0", 0), ValueError, "exposures: got 0; needs a whole number from 1"),
    (lambda: ts.capture(depth[0], "square-k4", "paper-10f0"), ValueError, "depth_m: got shape (2,); needs (H, W)"),
    (lambda: ts.capture(ts.Scene(depth, albedo=np.ones((3, 2))), "square-k4", "paper-10f0"), ValueError, "albedo: got shape (3, 2); needs shape (2, 2) as of depth_m"),
    (lambda: ts.capture(-depth, "square-k4", "paper-10f0"), ValueError, "depth_m"),
    (lambda: ts.capture(3, "square-k4", "paper-10f0"), TypeError, "scene: got int 3; needs a tofsmith.Scene"),
    (lambda: ts.capture("bookz", "square-k4", "paper-10f0"), OSError, "did you mean books?"),
    (lambda: ts.load_scene("books", scale_m=2), ValueError, "scale_m = 2; is only valid with a mesh"),
    (lambda: ts.load_scene("books", width=0), ValueError, "width = 0; must be in [1, 16384]"),
    (lambda: ts.design("paper-10f0", method="guess"), ValueError, "method = guess; must be factorize"),
    (lambda: ts.design("paper-10f0", effort=0.001), ValueError, "effort = 0.001; must be 0 or in [0.01, 100]"),
    (lambda: ts.design("paper-10f0", effort=0, method="optimize"), ValueError, "effort = 0; must be > 0 for methods"),
    (lambda: ts.design("paper-10f0", target=np.ones((5, 2, 2))), ValueError, "target: got shape (5, 2, 2); needs (N, K)"),
    (lambda: ts.DecodingTable.of_measured(np.ones((16, 4))), ValueError, "range_m: got None"),
    (lambda: ts.DecodingTable.of_measured(np.ones((16, 4)), range_m=10), ValueError, "correlation"),
    (lambda: ts.write_depth("/nowhere/d.npy", depth), OSError, "/nowhere"),
    (lambda: ts.write_raw("/tmp/x.npy", np.ones((2, 2))), ValueError, "raw: got shape (2, 2); needs (F, H, W, K)"),
    (lambda: ts.read_sweep_export("x.txt"), OSError, "expected .npz, .csv or .json"),
    (lambda: ts.run_sweep("codes = 3\n", "/nowhere/store.sqlite"), OSError, "sweep:1"),
    (lambda: ts.evaluate("square-k4", "paper-10f0", target_standard_error=1.5), ValueError, "target_standard_error = 1.5; "),
    (lambda: ts.evaluate("square-k4", "paper-10f0", target_standard_error="1%"), TypeError, "target_standard_error: got str '1%'; needs a number"),
    (lambda: ts.evaluate("square-k4", "paper-10f0", target_standard_error=0.1, max_trials=0), ValueError, "max_trials = 0; "),
    (lambda: ts.evaluate("square-k4", "paper-10f0", draw_every_measurement=1), TypeError, "draw_every_measurement: got int 1; needs True or False"),
    (lambda: ts.generator_loss("square-k4", "prototype", trails=9), TypeError, "did you mean trials?"),
    (lambda: ts.table_depth_error_m("square-k4", 1, 1), TypeError, "table: got str 'square-k4'; needs a tofsmith.DecodingTable"),
    (lambda: ts.multipath_error("square-k4", "paper-10f0", ratio=[2]), ValueError, "ratio"),
    (lambda: ts.multipath_error("square-k4", "paper-10f0", delay_m=["far"]), TypeError, "delay_m: got list ['far']; needs a list of numbers"),
    (lambda: ts.multipath_error("square-k4", "paper-10f0", decoding={"treshold": 9}), ValueError, "did you mean threshold?"),
    (lambda: ts.MultipathBound("square-k4", "paper-10f0").sigma_m(1e4, -1, 0.1, 1), ValueError, "ambient_e_per_s: got -1; needs a number >= 0"),
    (lambda: ts.MultipathBound("square-k4", "paper-10f0").tail_sigma_m(1e4, 0, 0.5), TypeError, "tail: got float 0.5; needs a tofsmith.ExponentialTail"),
    (lambda: ts.capture(depth, "square-k4", "paper-10f0", returns=[1, 2]), ValueError, "returns: got shape (2,); needs (returns, 2)"),
    (lambda: ts.capture(depth, "square-k4", "paper-10f0", returns=[(np.nan, 0.1)]), ValueError, "returns: got nan at (0, 0); needs finite numbers"),
    (lambda: ts.capture(depth, "square-k4", "paper-10f0", returns=ts.MultipathReturns(np.arange(4), np.ones(3), np.ones(3))), ValueError, "returns.first: got shape (4,); needs shape (5,)"),
    (lambda: ts.capture(depth, "square-k4", "paper-10f0", returns=ts.MultipathReturns(np.arange(5), np.full(4, 2), np.ones(3))), ValueError, "returns.ratio: got shape (3,); needs shape (4,)"),
    (lambda: ts.capture(depth, "square-k4", "paper-10f0", returns=ts.MultipathReturns(np.array([0, 9, 2, 3, 4]), np.full(4, 2), np.ones(4))), ValueError, "returns"),
    (lambda: ts.capture(depth, "square-k4", "paper-10f0", returns=ts.MultipathReturns(np.ones(5), np.ones(4), np.ones(4))), ValueError, "returns.first: got dtype float64; needs whole numbers"),
    (lambda: ts.capture(depth, "square-k4", "paper-10f0", tail=(1, 2)), TypeError, "tail: got tuple (1, 2); needs a tofsmith.ExponentialTail"),
    (lambda: ts.capture(depth, "square-k4", "paper-10f0", tail=ts.ExponentialTail(-1)), ValueError, "mean_delay_m = -1; "),
    (lambda: ts.capture(depth, "square-k4", "paper-10f0", transients=ts.Transients(np.ones((3, 2, 4)), 0.1)), ValueError, "transients.light: got shape (3, 2, 4); needs (T,) or (2, 2, T)"),
    (lambda: ts.capture(depth, "square-k4", "paper-10f0", transients=ts.Transients(np.array([1, np.inf]), 0.1)), ValueError, "transients.light: got inf at 1; needs finite"),
    (lambda: ts.export_waveforms("square-k4", "paper-10f0", "/tmp/none", "keysight-arc"), ValueError, "did you mean keysight-arb?"),
    (lambda: ts.export_waveforms("square-k4", "paper-10f0", "/tmp/none", "csv", bits=99), ValueError, "bits"),
    (lambda: ts.export_waveforms("square-k4", "paper-10f0", "/proc/none", "csv"), OSError, "/proc/none: "),
    (lambda: ts.write_report("/nowhere"), OSError, "/nowhere: contains no design.json"),
    (lambda: ts.write_evaluation_report("a.html", ["square-k4"], "paper-10f0", []), ValueError, "reports: got 0; needs one for each of 1 codes"),
    (lambda: ts.write_evaluation_report("a.html", ["square-k4"], "paper-10f0", [3]), TypeError, "reports: got int 3; needs a tofsmith.DepthErrorReport"),
    (lambda: ts.write_evaluation_report("a.html", "square-k4", "paper-10f0", ts.evaluate("square-k4", ts.Camera("paper-10f0", operating={"signal_e_per_s": [1e4]}), trials=10)), ValueError, "reports: got "),
    (lambda: ts.set_threads(-1), ValueError, "threads: got -1; needs a whole number from 0"),
]


@pytest.mark.parametrize("call, kind, message", refusals, ids=[r[2][:50] for r in refusals])
def test_rejects_bad_input_by_name(call, kind, message):
    with pytest.raises(kind, match=re.escape(message)):
        call()


def test_errors_store_their_details():
    with pytest.raises(ValueError) as refused:
        ts.build_family("square-k1", "paper-10f0")
    assert refused.value.field == "code"
    assert refused.value.value == "square-k1"
    assert refused.value.rule.startswith("phase steps = 1; must be >= 2")
    with pytest.raises(OSError) as missing:
        ts.read_depth("/none/depth.npy")
    assert str(missing.value).startswith(missing.value.place)


def test_unsuitable_codes_are_reported_or_raise():
    code = ts.build_family("hamiltonian-k3", "paper-10f0")
    assert ts.why_not_playable(code, "paper-10f0") is None
    two_taps = ts.Camera("paper-10f0", sensor={"taps": 2})
    with pytest.raises(ValueError) as refused:
        ts.require_fits(code, two_taps)
    assert ts.why_not_playable(code, two_taps) == str(refused.value)


def test_existing_files_are_kept(tmp_path):
    path = tmp_path / "depth.npy"
    ts.write_depth(path, depth)
    with pytest.raises(OSError, match="already exists; .* overwrite=True"):
        ts.write_depth(path, depth)
    ts.write_depth(path, 2 * depth, overwrite=True)
    assert ts.read_depth(path)[0, 0] == 2


def test_arrays_in_place_of_codes_cause_no_warning():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(TypeError, match="code: got an array of shape"):
            ts.Decoder(np.ones((10, 4)), "paper-10f0")
        sweep = ts.SweepResults({"code": np.array(["a", "b"]), "linear_mde_m": np.ones(2),
                                 "circular_mde_m": np.ones(2)})
        assert len(sweep.where(code="a")) == 1 and len(sweep.where(code=5)) == 0

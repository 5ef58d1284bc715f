# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Objects behave as expected by users of NumPy and notebooks."""

import copy
import html
import pickle
import subprocess
import sys

import numpy as np
import pytest

import tofsmith as ts

raw = np.random.default_rng(2).poisson(900, (6, 8, 4)).astype(np.uint16)


class Tensor:
    """The common interface of torch, xarray and similar arrays."""

    def __init__(self, values):
        self.values = values

    def __array__(self, dtype=None):
        return self.values if dtype is None else self.values.astype(dtype)


@pytest.fixture
def decoder():
    return ts.Decoder("hamiltonian-k4", "paper-10f0", min_confidence=0.3)


def test_raw_accepts_anything_numpy_converts_to_an_array(decoder):
    truth = decoder.decode(raw)
    assert decoder.decode(Tensor(raw)) == truth
    assert decoder.decode([Tensor(raw[..., k]) for k in range(4)]) == truth
    assert decoder.decode(np.ma.masked_array(raw)) == truth
    mask = np.zeros(raw.shape, bool)
    mask[2, 3, 1] = True
    masked = decoder.decode(np.ma.masked_array(raw, mask))
    assert masked.status[2, 3] == ts.PixelStatus.invalid
    assert (masked.status != ts.PixelStatus.invalid).sum() == 47
    kept = masked.status != ts.PixelStatus.invalid
    assert np.array_equal(masked.depth_m[kept], truth.depth_m[kept], equal_nan=True)


def test_all_number_types_decode_like_float32(decoder):
    truth = decoder.decode(raw)
    for kind in (np.int16, np.int32, np.int64, np.uint32, np.uint64, np.float16, np.float32):
        assert decoder.decode(raw.astype(kind)) == truth, kind


def test_a_scalar_replaces_a_constant_map():
    depth_m = np.full((6, 8), 2.0, np.float32)
    maps = {name: np.full((6, 8), 0.5, np.float32) for name in ("albedo", "cosine", "ambient_scale")}
    numbers = ts.Scene(depth_m, albedo=0.5, cosine=0.5, ambient_scale=0.5)
    captured = [ts.capture(scene, "hamiltonian-k4", "paper-10f0")
                for scene in (numbers, ts.Scene(depth_m, **maps))]
    assert np.array_equal(*captured)
    with pytest.raises(TypeError, match="albedo: got str 'half'; needs a number"):
        ts.capture(ts.Scene(depth_m, albedo="half"), "hamiltonian-k4", "paper-10f0")


def test_objects_are_equal_if_their_contents_are(decoder):
    image, other = decoder.decode(raw), decoder.decode(raw)
    assert image == other
    other.depth_m[0, 0] += 1
    assert image != other
    assert image != decoder.decode(raw, planes=["depth_m"])
    assert image != 3
    scene = ts.load_scene("table-top", width=8, height=6)
    assert scene == ts.load_scene("table-top", width=8, height=6)
    assert scene != ts.load_scene("room", width=8, height=6)
    assert scene != ts.Scene(scene.depth_m, scene.albedo, scene.cosine)


def test_reprs_are_short_and_notebooks_get_a_picture(decoder):
    image = decoder.decode(raw)
    scene = ts.load_scene("table-top")
    code = ts.build_family("hamiltonian-k4", "paper-10f0")
    for value, words in ((image, "<DepthImage 6 x 8: "), (scene, "<Scene 240 x 320: "),
                         (decoder, "<Decoder zncc: K = 4, N = 240, range 9.993 m>"),
                         (decoder.table, "<DecodingTable: K = 4, N = 240"), (code, "<CodeSet ")):
        assert repr(value).startswith(words)
        assert len(repr(value)) < 200
    pytest.importorskip("matplotlib")
    for value in (image, scene, code, decoder, decoder.table, ts.Camera("paper-10f0")):
        page = value._repr_html_()
        assert "&lt;" in page.split("<img")[0]
        assert "data:image/png;base64,iVBOR" in page
    assert "img" not in ts.DepthImage()._repr_html_()


def test_notebooks_without_matplotlib_get_the_repr(monkeypatch):
    for name in ("matplotlib", "matplotlib.pyplot"):
        monkeypatch.setitem(sys.modules, name, None)
    scene = ts.load_scene("table-top", width=8, height=6)
    for value in (scene, ts.Camera("paper-10f0")):
        assert value._repr_html_() == f"<code>{html.escape(repr(value))}</code>"


def test_decoders_can_be_copied_and_pickled(decoder, tmp_path):
    assert copy.copy(decoder) is decoder
    assert copy.deepcopy({"decoder": decoder})["decoder"] is decoder
    camera = ts.Camera("paper-10f0", lens={"fx_px": 9.0, "fy_px": 9.0, "cx_px": 4.0, "cy_px": 3.0})
    chi = ts.DecodingTable.of_code("hamiltonian-k4", camera).correlation
    np.savetxt(tmp_path / "table.csv", chi, delimiter=",")
    for made in (decoder, ts.Decoder("hamiltonian-k4", camera, method="ml"),
                 ts.Decoder(ts.DecodingTable.of_measured(chi, camera)),
                 ts.Decoder(ts.DecodingTable.of_measured(chi, range_m=9.0)),
                 ts.Decoder(ts.DecodingTable.load(tmp_path / "table.csv", camera)),
                 ts.Decoder(ts.DecodingTable.load(tmp_path / "table.csv", camera, range_m=9.0,
                                                  reversed=True))):
        again = pickle.loads(pickle.dumps(made))
        assert again.method == made.method
        assert again.decode(raw) == made.decode(raw)
    ts.write_raw(tmp_path / "raw.npy", raw)
    for of, name in ((ts.Decoder("hamiltonian-k4", camera), "a.npy"),
                     (pickle.loads(pickle.dumps(ts.Decoder("hamiltonian-k4", camera))), "b.npy")):
        of.decode_recording(tmp_path / "raw.npy", tmp_path / name, kind="z")
    assert (tmp_path / "a.npy").read_bytes() == (tmp_path / "b.npy").read_bytes()


def test_planes_accept_both_names(decoder, tmp_path):
    image = decoder.decode(raw, planes=["depth", "deviation"])
    assert list(image.planes()) == ["depth_m", "deviation_m"]
    ts.write_raw(tmp_path / "raw.npy", raw)
    done = decoder.decode_recording(tmp_path / "raw.npy", tmp_path / "d.npz",
                                    outputs=["depth_m", "signal"])
    assert done.outputs == ["depth", "signal"]


def test_figure_modules_need_no_separate_import():
    lines = "import tofsmith; tofsmith.plot.waveforms; tofsmith.figures.waveforms; tofsmith.plots"
    done = subprocess.run([sys.executable, "-c", lines], capture_output=True, text=True)
    assert "module 'tofsmith' has no attribute 'plots'" in done.stderr.splitlines()[-1]


def test_only_plot_functions_are_listed():
    from tofsmith import plot

    assert dir(plot) == sorted(plot.__all__)
    drawing = {name for name, value in vars(plot).items()
               if hasattr(value, "__wrapped__") and value.__module__ == plot.__name__}
    assert drawing == set(plot.__all__)


def test_the_atlas_provides_codes_without_a_search():
    entries = ts.atlas()
    assert entries
    for entry in entries:
        assert (entry.code.taps, entry.code.exposures) == (entry.taps, entry.exposures)
        assert 0 < entry.circular_m and 0 < entry.linear_m
    levels = {"signal_e_per_s": [1e4], "ambient_e_per_s": [1e4]}
    camera = ts.Camera("paper-10f0", operating=levels)
    methods = {c.method for c in ts.design(camera, effort=0, trials=1000).candidates}
    assert methods == {"atlas", "family"}
    alone = ts.design(camera, effort=0, trials=1000, atlas_cameras=0)
    assert {c.method for c in alone.candidates} == {"family"}


def test_motion_is_evaluated_and_lowered_by_the_order_of_exposures():
    levels = {"signal_e_per_s": [1e5, 1e6], "ambient_e_per_s": [1e3]}
    camera = ts.Camera("paper-10f0", operating=levels)
    report = ts.motion_error("sinusoid-k4", camera, 1.0, trials=200)
    assert report.velocity_m_per_s == 1.0 and report.rms_bias_m > 0
    assert report.surface.circular_mde_m.shape == report.edge.wrong_ok.shape == (2,)
    assert report.edge.shares.wrong == pytest.approx(report.edge.wrong.mean())
    moving = ts.Camera("paper-10f0", operating=levels | {"velocity_m_per_s": 1.0})
    chosen = ts.design(moving, effort=0, trials=1000, atlas_cameras=0).winner.exposure_order
    assert sorted(chosen.order) == list(range(len(chosen.order)))
    assert chosen.rms_bias_m <= chosen.given_rms_bias_m


def test_interference_is_evaluated_and_ranked():
    levels = {"signal_e_per_s": [1e5, 1e6], "ambient_e_per_s": [1e3]}
    others = {"cameras": 2, "signal_ratio": 0.05}
    camera = ts.Camera("paper-10f0", operating=levels | {"interference": others})
    assert camera.operating.interference == ts.OperatingInterference(cameras=2, signal_ratio=0.05)
    report = ts.interference_error("sinusoid-k4", camera, trials=2000)
    assert report.rms_m > 0 and report.circular_rmse_m.shape == report.wrong_ok.shape == (2,)
    assert report.circular_rmse_m[1] == pytest.approx(report.expected_rmse_m[1], rel=0.1)
    assert report.shares.wrong == pytest.approx(report.wrong.mean())
    winner = ts.design(camera, effort=0, trials=1000, atlas_cameras=0,
                       baselines=["sinusoid-k4", "hamiltonian-k4"]).winner
    assert winner.ranking_error_m == winner.interference.linear.geometric_mean_m
    with pytest.raises(ValueError, match="operating.interference = none; must be given"):
        ts.interference_error("sinusoid-k4", "paper-10f0")


def test_frequencies_of_a_chip_are_found():
    camera = ts.Camera("mlx75027", operating={"working_distance_m": [0.3, 6.0]})
    assert camera.square_light.frequencies_hz == (20e6, 40e6, 60e6, 80e6, 100e6)
    assert ts.Camera("paper-10f0").square_light is None
    found = ts.design(camera, method="frequencies", trials=1000)
    code = found.winner.code
    assert found.winner.method == "frequencies" and code.name.startswith("square-")
    assert not code.exposure_shares or sum(code.exposure_shares) == pytest.approx(1.0)
    first, *others = [1.0 / code.exposures] * code.exposures
    split = code.with_exposure_shares([first - 0.05, others[0] + 0.05, *others[1:]])
    assert ts.CodeSet.from_json(split.to_json()) == split
    with pytest.raises(ValueError, match="must be listed once"):
        camera.replace(light={"frequencies_hz": [20e6, 20e6]})


def test_a_scalar_is_accepted_as_a_list():
    found = ts.design("paper-10f0", exposures=3, effort=0.01, trials=1000, method="factorize")
    designed = [c for c in found.candidates if c.method == "factorize"]
    assert designed and {c.code.exposures for c in designed} == {3}
    assert ts.evaluate("hamiltonian-k4", "paper-10f0", trials=1e2).trials == 100
    light = {"delay_m": 1, "ratio": 0.3, "tail_m": 0.5, "signal_e_per_s": 1e5}
    one, lists = (ts.multipath_error("sinusoid-k4", "paper-10f0", trials=10, **given).maps[0]
                  for given in (light, {key: [value] for key, value in light.items()}))
    assert one.points.single_bias_m == lists.points.single_bias_m


@pytest.mark.parametrize("call, error, text", [
    (lambda: ts.evaluate("paper-10f0", "hamiltonian-k4"), TypeError,
     "camera: got str 'hamiltonian-k4', a code; needs a camera: does the code come first?"),
    (lambda: ts.Decoder("paper-10f0", ts.Camera("paper-10f0")), OSError, "paper-10f0"),
    (lambda: ts.evaluate("paper-10f0", ts.Camera("paper-10f0")), TypeError, "a camera; needs a code"),
    (lambda: ts.CodeSet.from_arrays(np.ones((4, 240)), np.ones((4, 240))), ValueError,
     "turn it over"),
    (lambda: ts.decode("raw.npy", "hamiltonian-k4", "paper-10f0"), TypeError,
     "one per measurement; read_raw('raw.npy') reads one"),
    (lambda: ts.plot.depth_maps("depth.npy"), TypeError, "not the name of a file (read_depth()"),
    (lambda: ts.CodeSet("hamiltonian-k4"), TypeError, "use build_family(name, camera)"),
    (lambda: ts.Camera(fundamental_frequency_hz=20), ValueError, "20 MHz are 20e6"),
    (lambda: ts.design("paper-10f0", exposures=[2.5]), TypeError,
     "exposures: got list [2.5]; needs a list of whole numbers"),
])
def test_misspelt_arguments_are_reported(call, error, text):
    with pytest.raises(error) as caught:
        call()
    assert text in str(caught.value)


def test_mixers_use_signed_weights():
    camera = ts.Camera("paper-10f0", sensor={"demodulation": "signed"})
    assert camera.sensor.demodulation == "signed"
    family = ts.build_family("hamiltonian-k4", camera)
    assert family.is_signed and set(family.demodulation.round(9).flat) == {-1.0, 1.0}
    turns = 2 * np.pi * (np.arange(240) + 0.5) / 240
    weights = np.stack([np.cos(turns - k * np.pi / 2) for k in range(4)], axis=1)
    light = np.repeat(1 + weights[:, :1], 4, axis=1)
    code = ts.CodeSet.from_arrays(light, weights, signed=True, name="analog")
    assert np.allclose(code.demodulation, weights)
    again = pickle.loads(pickle.dumps(code))
    assert again.is_signed and np.allclose(again.demodulation, weights)
    frame = ts.capture(np.full((4, 5), 2.0), code, camera, signal_e_per_s=1e7, falloff=False)
    assert np.allclose(ts.Decoder(code, camera).decode(frame).depth_m, 2.0, atol=0.05)
    with pytest.raises(ValueError, match="in \\[-1, 1\\]"):
        ts.CodeSet.from_arrays(light, 1.5 * weights, signed=True)

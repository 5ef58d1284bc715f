# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""The same request gives the same bytes from the command line, in C++
(tests/apps/three_ways_cli.cpp) and in Python."""

import json
import os
import re
import subprocess

import numpy as np
import pytest

import tofsmith as ts

SMALL = ("--camera", "paper-10f0", "--set", "samples=120")


@pytest.fixture(scope="module")
def camera():
    return ts.Camera("paper-10f0", samples=120)


class Ways:
    """Runs a request in one directory per interface and compares the resulting files."""

    def __init__(self, cli, folder):
        self.cli = cli
        self.folders = {way: folder / way for way in ("command", "cpp", "python")}
        for way in self.folders.values():
            way.mkdir()

    def give(self, name, content):
        """Writes an input file into every directory."""
        for folder in self.folders.values():
            if isinstance(content, np.ndarray):
                np.save(folder / name, content)
            else:
                (folder / name).write_bytes(content)

    def run(self, *command, way="command"):
        done = subprocess.run(command, cwd=self.folders[way], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr

    def command(self, *arguments):
        self.run(self.cli, "--quiet", *arguments)

    def cpp(self, request):
        program = os.environ.get("TOFSMITH_THREE_WAYS")
        if not program:
            pytest.skip("TOFSMITH_THREE_WAYS does not name the program in C++")
        self.run(program, request, way="cpp")

    def files(self, way):
        folder = self.folders[way]
        return {str(path.relative_to(folder)): path.read_bytes()
                for path in folder.rglob("*") if path.is_file()}

    def same(self, *ignored, change=lambda content: content):
        """Compares all files except `ignored`; returns their names."""
        found = {way: {name: change(content) for name, content in self.files(way).items()
                       if name not in ignored} for way in self.folders}
        for way in ("cpp", "python"):
            assert sorted(found[way]) == sorted(found["command"]), way
            for name, content in found[way].items():
                assert content == found["command"][name], (way, name)
        return sorted(found["command"])


@pytest.fixture
def ways(cli, tmp_path, monkeypatch):
    made = Ways(cli, tmp_path)
    monkeypatch.chdir(made.folders["python"])
    return made


def test_codes(ways, camera):
    for name in ("code.json", "code.npz"):
        ways.command("codes", "hamiltonian-k4", *SMALL, "-o", name)
        ts.write_code(name, ts.load_code("hamiltonian-k4", camera))
    ways.cpp("codes")
    assert len(ways.same()) == 2


def capture(camera):
    return ts.capture(ts.built_in_scene("table-top", 40, 30), "hamiltonian-k4", camera,
                      signal_e_per_s=1e6, ambient_e_per_s=1e4, seed=5, frames=3)


def test_simulate(ways, camera):
    ways.command("simulate", "table-top", "--width", "40", "--height", "30", "--code",
                 "hamiltonian-k4", *SMALL, "--signal", "1e6", "--ambient", "1e4", "--seed", "5",
                 "--frames", "3", "-o", "raw.npy")
    ts.write_raw("raw.npy", capture(camera))
    ways.cpp("simulate")
    # Only the command line writes code and camera next to the frames, for later decoding.
    assert ways.same("raw.camera.toml", "raw.code.json") == ["raw.npy"]


def test_decode(ways, camera):
    raw = capture(camera)
    ways.give("raw.npy", raw)
    counts = np.round(np.clip(raw, 0, 65535)).astype("<u2")
    ways.give("planar.npy", np.moveaxis(raw, 3, 1).copy())
    ways.give("dump.bin", b"head" + np.moveaxis(counts, 3, 1).tobytes())
    ways.give("dump.raw.toml", b"width = 40\nheight = 30\nmeasurements = 4\nheader_bytes = 4\n"
              b"bits = 16\n")
    ways.give("table.npy", ts.ForwardModel("hamiltonian-k4", camera).correlation_table())
    ways.give("offset.npy", np.full((30, 40), 0.125, np.float32))
    ways.give("gain.npy", np.linspace(0.5, 2, 1200, dtype=np.float32).reshape(30, 40))
    for k in range(4):
        ways.give(f"p{k}.npy", raw[..., k].astype(np.int32))
    given = list(ways.files("python"))

    def command(name, output, *more, code="hamiltonian-k4"):
        ways.command("decode", name, "--code", code, *SMALL, "-o", output, *more)

    decoder = ts.Decoder("hamiltonian-k4", camera)
    for output in ("d.npy", "d.npz", "d.exr", "d.pfm", "d.png", "d.ply", "d.pcd"):
        command("raw.npy", output, "--view-deg", "60")
        result = decoder.decode_recording("raw.npy", output, view_deg=60)
        assert [str(file) for file in result.files] == [
            output.replace(".", f"-{frame}.") for frame in range(3)]

    command("raw.npy", "z.npz", "--outputs", "bin,depth,deviation", "--kind", "z", "--view-deg",
            "60", "--frame", "1")
    result = decoder.decode_recording("raw.npy", "z.npz", outputs=["bin", "depth", "deviation"],
                                      kind="z", view_deg=60, frame=1)
    assert (result.first_frame, result.outputs) == (1, ["bin", "depth", "deviation"])

    command("raw.npy", "stack.npy", "--method", "ml", "--outputs", "depth,status", "--stack",
            "--offset-map", "offset.npy", "--gain-map", "gain.npy", "--memory-mb", "0.05")
    result = ts.Decoder("hamiltonian-k4", camera, method="ml").decode_recording(
        "raw.npy", "stack.npy", outputs=["depth", "status"], stack=True, offset_map="offset.npy",
        gain_map="gain.npy", memory_mb=0.05)
    assert [file.name for file in result.files] == ["stack.npy", "stack-status.npy"]
    status = np.load("stack-status.npy")
    assert result.frames == [
        {word.name: int((frame == word).sum()) for word in ts.PixelStatus} for frame in status]

    command("planar.npy", "measured.npy", "--layout", "planar", code="table.npy")
    ts.Decoder("table.npy", camera).decode_recording("planar.npy", "measured.npy", layout="planar")

    command("dump.bin", "dump.npz", "--raw-format", "dump.raw.toml")
    result = decoder.decode_recording("dump.bin", "dump.npz", raw_format="dump.raw.toml")
    assert "interpreted as electrons" in result.notes[0]

    phases = [f"p{k}.npy" for k in range(4)]
    ways.command("decode", *phases, "--averaged", "12.5", "--code", "hamiltonian-k4", *SMALL, "-o",
                 "phases.npz")
    result = decoder.decode_recording(phases, "phases.npz", averaged=12.5)
    image = decoder.decode([np.load(phase) for phase in phases], averaged=12.5)
    for frame, file in enumerate(result.files):
        for name, plane in (("depth", image.depth_m),
                            ("deviation", image.deviation_m)):
            np.testing.assert_array_equal(np.load(file)[name], plane[frame])

    command("raw.npy", "filtered.npz", "--filter", "strong", "--filter-set", "trusted_pixels=8",
            "--average", "2", "--outputs", "depth,averaged")
    result = decoder.decode_recording(
        "raw.npy", "filtered.npz", filter={"strength": "strong", "trusted_pixels": 8}, average=2,
        outputs=["depth", "averaged"])
    assert len(result.files) == 2

    command("raw.npy", "added.npz", "--time-filter", "2", "--time-filter-set",
            "max_difference_sigma=4", "--outputs", "depth,averaged")
    decoder.decode_recording(
        "raw.npy", "added.npz", time_filter={"max_frames": 2, "max_difference_sigma": 4},
        outputs=["depth", "averaged"])

    command("raw.npy", "snapped.npz", "--mixed", "snap", "--outputs", "depth,status")
    decoder.decode_recording("raw.npy", "snapped.npz", mixed="snap", outputs=["depth", "status"])

    ways.cpp("decode")
    assert len(ways.same()) == len(given) + 7 * 3 + 1 + 2 + 3 + 3 + 3 + 2 + 3 + 3


def test_decode_rejects_equally(ways, camera):
    ways.give("raw.npy", capture(camera))
    decoder = ts.Decoder("hamiltonian-k4", camera)
    for error, word, arguments, options in (
            (ValueError, "frame = 3", ["--frame", "3"], {"frame": 3}),
            (ValueError, "stack", ["--stack"], {"stack": True}),
            (ValueError, "outputs = delay", ["--outputs", "delay"], {"outputs": ["delay"]}),
            (OSError, "0.001 MB", ["--memory-mb", "0.001"], {"memory_mb": 0.001}),
            (OSError, "to be filtered", ["--filter", "light", "--memory-mb", "0.1"],
             {"filter": "light", "memory_mb": 0.1}),
            (OSError, "to be filtered", ["--time-filter", "9", "--memory-mb", "0.03"],
             {"time_filter": 9, "memory_mb": 0.03})):
        done = subprocess.run(
            [ways.cli, "decode", "raw.npy", "--code", "hamiltonian-k4", *SMALL, "-o", "d.npz",
             *arguments], cwd=ways.folders["command"], capture_output=True, text=True)
        assert done.returncode == (2 if error is ValueError else 1)
        with pytest.raises(error, match=re.escape(word)) as caught:
            decoder.decode_recording("raw.npy", "d.npz", **options)
        assert str(caught.value) in done.stderr
    with pytest.raises(ValueError, match="outputs = deep; must be depth, "):
        decoder.decode_recording("raw.npy", "d.npz", outputs=["deep"])
    with pytest.raises(ValueError, match="filter strength = weak; must be light, normal or strong"):
        decoder.decode_recording("raw.npy", "d.npz", filter="weak")
    with pytest.raises(ValueError, match=r"raw\[1\]: got float64 of shape \(2, 3\); needs float32"):
        decoder.decode([np.ones((2, 3), np.float32), np.ones((2, 3))])
    with pytest.raises(ts.Interrupted):
        decoder.decode_recording("raw.npy", "d.npz", progress=lambda share, step: False)
    assert list(ways.files("python")) == ["raw.npy"]


def test_evaluate(ways, camera):
    ways.command("evaluate", "hamiltonian-k4", *SMALL, "--trials", "500", "--seed", "3", "-o",
                 "evaluation.json")
    ways.cpp("evaluate")
    documents = [ways.files(way)["evaluation.json"] for way in ("command", "cpp")]
    assert documents[0] == documents[1]
    report = ts.evaluate("hamiltonian-k4", camera, trials=500, seed=3)
    (code,) = json.loads(documents[0])["codes"]
    for kind in ("linear", "circular"):
        assert getattr(report, kind).geometric_mean_m == code[kind]["geometric_mean_m"]
        assert getattr(report, kind).mean_se_m == code[kind]["mean_se_m"]
    assert len(code["points"]) == report.circular_mde_m.size
    for name in ("linear_mde_m", "circular_mde_m", "outlier_rate", "cramer_rao_mae_m"):
        assert getattr(report, name).ravel().tolist() == [p[name] for p in code["points"]]


def test_evaluate_at_distances(ways):
    optics = {"source_power_w": 0.5, "wavelength_m": 940e-9, "field_of_view_deg": [70, 55],
              "f_number": 1.2, "pixel_pitch_m": 7e-6, "quantum_efficiency": 0.3,
              "filter_width_m": 30e-9}
    camera = ts.Camera("paper-10f0", samples=120, optics=optics)
    camera.write(ways.folders["command"] / "mine.toml")
    ways.command("evaluate", "hamiltonian-k4", "--camera", "mine.toml", "--distance", "1,4",
                 "--albedo", "0.3", "--klux", "20", "--trials", "500", "-o", "evaluation.json")
    (code,) = json.loads(ways.files("command")["evaluation.json"])["codes"]
    asked = camera.at_distances([1.0, 4.0], albedo=0.3, klux=20)
    report = ts.evaluate("hamiltonian-k4", asked, trials=500)
    assert report.linear_mde_m.ravel().tolist() == [p["linear_mde_m"] for p in code["points"]]
    signals = asked.operating.signal_e_per_s
    assert [p["signal_e_per_s"] for p in code["points"]] == list(signals)
    assert signals[0] == pytest.approx(16 * signals[1])
    assert camera.optics.sunlight_klux is None and asked.optics.sunlight_klux == 20
    with pytest.raises(ValueError, match="optics = none; is required"):
        ts.Camera("paper-10f0").at_distances(1.0)


def test_design(ways, camera):
    ways.command("design", *SMALL, "--method", "factorize", "--exposures", "3",
                 "--effort", "0.01", "--trials", "1000", "-o", "design")
    ts.design(camera, method="factorize", exposures=3, effort=0.01, trials=1000).write("design")
    ways.cpp("design")
    seconds = re.compile(rb'"seconds": ?[-+.\de]+')
    # The page contains the command line; finished codes belong to interrupted runs.
    ignored = [name for name in ways.files("command") if "report.html" in name or "/finished/" in name]
    assert len(ways.same(*ignored, change=lambda content: seconds.sub(b"", content))) >= 5


def test_require(ways):
    levels = {"signal_e_per_s": [1e5], "ambient_e_per_s": [1e4]}
    mine = ways.folders["command"] / "mine.toml"
    ts.Camera("paper-10f0", samples=24, operating=levels).write(mine)
    camera = ts.Camera(mine)
    ways.command("require", "mine.toml", "--error", "20mm", "--vary", "power", "--max-factor", "4",
                 "--exact", "--effort", "0.01", "--trials", "1000", "-o", "found")
    found = ts.find_requirements(camera, 0.02, vary_bandwidth=False, vary_exposure=False,
                                 max_factor=4, exact=True, effort=0.01, trials=1000)
    found.write("found")
    (power,) = found.varied
    assert power.quantity == "power" and power.error_m <= 0.02 and found.map is None
    command, python = ways.files("command"), ways.files("python")
    for name in ("as_it_is.code.json", "power.code.json", "power.camera.toml",
                 "requirements.json"):
        assert command[f"found/{name}"] == python[f"found/{name}"]
    document = json.loads(command["found/requirements.json"])
    assert document["varied"][0]["factor"] == power.factor
    # The written files must give the reported error.
    assert ts.Camera("found/power.camera.toml") == power.camera
    error = ts.evaluate("found/power.code.json", power.camera, trials=1000).circular
    assert error.geometric_mean_m == pytest.approx(power.error_m, rel=0.1)
    with pytest.raises(OSError, match="exists"):
        found.write("found")


def test_export(ways, camera):
    for output in ("export", "one.csv"):
        ways.command("export", "square-k4", "--format", "csv", "--samples", "60", *SMALL,
                     "--no-loss", "-o", output)
        written = ts.export_waveforms("square-k4", camera, output, "csv", samples=60)
    assert [str(file) for file in written.files] == ["one.csv"] and written.notes == []
    with pytest.raises(ValueError, match="output = one.mif; expected .csv of csv, or a directory"):
        ts.export_waveforms("square-k4", camera, "one.mif", "csv")
    (note,) = ts.export_waveforms("square-k4", "paper-10f0", "../fast", "csv").notes
    assert "3600 MHz" in note
    ways.cpp("export")
    assert len(ways.same("export/report.html")) >= 3

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Training sets from scenes in memory are the same as from files on the command line."""

import re
import subprocess

import numpy as np
import pytest

import tofsmith as ts

camera = ts.Camera("paper-10f0", samples=60)
depths = {f"{name}.npy": np.full((6, 8), metres) + np.linspace(0, 0.5, 8)
          for name, metres in (("far", 6.0), ("near", 1.5))}


def test_files_equal_the_command(cli, tmp_path):
    camera.write(tmp_path / "mine.toml")
    (tmp_path / "scenes").mkdir()
    for name, depth_m in depths.items():
        ts.write_depth(tmp_path / "scenes" / name, depth_m)
    command = [cli, "simulate", "scenes", "--kind", "radial", "--code", "hamiltonian-k3", "--camera",
               "mine.toml", "--signal-range", "1e4:1e6", "--seed", "7", "-o", "command"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    options = {"signal_range": (1e4, 1e6), "seed": 7}
    scenes = {"far.npy": depths["far.npy"], "near.npy": lambda: ts.Scene(depths["near.npy"])}
    mine = ts.Camera(tmp_path / "mine.toml")
    run = ts.write_training_set(tmp_path / "python", scenes, "hamiltonian-k3", mine, **options)
    assert (run.scenes, run.written, run.kept, run.failures) == (2, 2, 0, [])
    assert run.index == tmp_path / "python" / "index.json"
    files = sorted(p.relative_to(tmp_path / "command") for p in (tmp_path / "command").rglob("*.*"))
    assert files == sorted(p.relative_to(tmp_path / "python")
                           for p in (tmp_path / "python").rglob("*.*"))
    assert len(files) == 5
    for file in files:
        assert (tmp_path / "command" / file).read_bytes() == (tmp_path / "python" / file).read_bytes()
    again = ts.write_training_set(tmp_path / "python", scenes, "hamiltonian-k3", mine, **options)
    assert (again.written, again.kept) == (0, 2)


def test_an_invalid_scene_is_reported(tmp_path):
    scenes = {"good": depths["far.npy"], "none": lambda: 1 // 0, "flat": np.ones(3)}
    run = ts.write_training_set(tmp_path / "set", scenes, "square-k4", camera, frames=2)
    assert run.written == 1
    failures = sorted(run.failures)
    assert failures[0].startswith("flat: ") and "depth_m: got shape (3,)" in failures[0]
    assert failures[1].startswith("none: ") and "ZeroDivisionError" in failures[1]
    with np.load(next((tmp_path / "set").rglob("*.npz"))) as arrays:
        assert arrays["raw"].shape == (2, 6, 8, 4)
        np.testing.assert_allclose(arrays["true_depth_m"], depths["far.npy"], rtol=1e-6)


def test_a_stopped_run_keeps_finished_frames(tmp_path):
    with pytest.raises(ts.Interrupted):
        ts.write_training_set(tmp_path, depths, "square-k4", camera, progress=lambda f, step: False)
    assert ts.write_training_set(tmp_path, depths, "square-k4", camera).scenes == 2


def made(scenes=depths, **options):
    return lambda: ts.write_training_set("/proc/none", scenes, "square-k4", camera, **options)


refusals = [
    (made([1]), TypeError, "scenes: got list [1]; needs a dict of names and scenes"),
    (made({}), TypeError, "scenes: got dict {}"),
    (made({3: depths["far.npy"]}), TypeError, "scenes: got int 3; needs a text"),
    (made(signal_range=(1e5,)), ValueError,
     "signal_range: got 1 numbers; needs (low_e_per_s, high_e_per_s)"),
    (made(signal_range=(1e5, 1e3)), ValueError, "signal_range"),
    (made(ambient_range=("a", "b")), TypeError,
     "ambient_range: got list ['a', 'b']; needs a list of numbers"),
    (made(shard=(3, 2)), ValueError, "shard"),
    (made(), OSError, "/proc/none"),
]


@pytest.mark.parametrize("call, kind, message", refusals, ids=[r[2][:50] for r in refusals])
def test_rejects_bad_input_by_name(call, kind, message):
    with pytest.raises(kind, match=re.escape(message)):
        call()

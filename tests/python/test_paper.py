# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""tofsmith.paper: verdicts at low effort, resuming, and the command `tofsmith reproduce`."""

import html
import json
import os
import subprocess
import sys

import numpy as np
import pytest

import tofsmith

pytest.importorskip("matplotlib", reason="matplotlib is not installed")
from tofsmith import paper  # noqa: E402
from tofsmith.paper import fig4  # noqa: E402
from tofsmith.paper._study import Study  # noqa: E402
from tofsmith.paper.bench import Plane, Sphere, fit_without_outliers  # noqa: E402
from tofsmith.paper.fig7 import seen_hand  # noqa: E402

HOLDS, IN_PART = "holds", "holds in part"
#: Verdicts in the order of each figure's findings; None if few trials leave them undecided.
VERDICTS = {
    "fig2": [HOLDS, HOLDS, HOLDS, IN_PART, HOLDS, HOLDS],
    "fig3": [HOLDS] * 5,
    "fig4": [IN_PART, None, IN_PART, IN_PART, None, None, HOLDS, HOLDS],
    "fig5": [HOLDS],
    "fig6": [HOLDS, HOLDS, IN_PART],
    "fig7": [HOLDS, IN_PART],
    "fig8": [HOLDS, HOLDS, None],
    "fig9": [HOLDS, None],
    "fig10": [HOLDS, HOLDS, HOLDS],
    "fig11": [HOLDS],
    "table1": [IN_PART],
    "text": [IN_PART, IN_PART, IN_PART, HOLDS, HOLDS],
}


@pytest.fixture(scope="module")
def output(tmp_path_factory):
    """Output folder; figures share designed codes."""
    return tmp_path_factory.mktemp("paper")


@pytest.mark.parametrize("name", paper.items)
def test_figure(name, output):
    findings = paper.reproduce(name, output, fast=True)[name]
    assert len(findings) == len(VERDICTS[name])
    for finding, expected in zip(findings, VERDICTS[name]):
        assert expected is None or finding.verdict == expected, finding
        assert "nan" not in finding.measured.lower().split()
    document = json.loads((output / name / "findings.json").read_text())
    assert document["tofsmith"] == tofsmith.__version__
    for picture, caption in document["pictures"]:
        assert (output / name / f"{picture}.png").read_bytes().startswith(b"\x89PNG")
        assert (output / name / f"{picture}.pdf").read_bytes().startswith(b"%PDF") and caption
    assert f"<h2>{name}: {html.escape(paper.items[name])}</h2>" in (output / "index.html").read_text()


def test_every_camera_of_fig4_supports_the_baselines():
    for limits in fig4.LIMITS.values():
        camera = fig4.paper_camera(*limits)
        for name in fig4.BASELINES:
            assert not tofsmith.why_not_playable(tofsmith.build_family(name, camera), camera)


def test_every_figure_has_expected_verdicts():
    assert set(VERDICTS) == set(paper.items)


def test_finished_figures_are_kept_unless_options_differ(tmp_path):
    kept = []

    def note(name, findings, was_kept):
        kept.append(was_kept)

    first = paper.reproduce("fig5", tmp_path, fast=True, on_item=note)
    picture = (tmp_path / "fig5/response.pdf").read_bytes()
    assert paper.reproduce(["fig5"], tmp_path, fast=True, on_item=note) == first
    with pytest.raises(OSError, match="fig5/findings.json.*coarse.*--force"):
        paper.reproduce("fig5", tmp_path)
    paper.reproduce("fig5", tmp_path, fast=True, overwrite=True, on_item=note)
    assert kept == [False, True, False]
    assert (tmp_path / "fig5/response.pdf").read_bytes() == picture
    (tmp_path / "fig5/findings.json").write_text("{")  # damaged, so it is created again
    paper.reproduce("fig5", tmp_path, fast=True, on_item=note)
    assert kept[-1] is False


def test_foreign_pages_are_not_replaced(tmp_path):
    (tmp_path / "index.html").write_text("<html>mine</html>")
    with pytest.raises(OSError, match="index.html.*--force"):
        paper.reproduce("fig5", tmp_path)
    assert (tmp_path / "index.html").read_text() == "<html>mine</html>"


def test_a_mesh_replaces_the_hand(tmp_path):
    corners = [(x, y, z) for x in (0, 7) for y in (0, 9) for z in (0, 2)]
    faces = [(1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4)]
    lines = ["v {} {} {}".format(*corner) for corner in corners]
    lines += ["f {} {} {}\nf {} {} {}".format(a, b, c, a, c, d) for a, b, c, d in faces]
    (tmp_path / "box.obj").write_text("\n".join(lines))
    study = Study("fig7", tmp_path, fast=True, mesh=str(tmp_path / "box.obj"))
    box = seen_hand(study)
    is_box = np.isfinite(box.depth_m)
    rows, columns = is_box.any(axis=1).sum(), is_box.any(axis=0).sum()
    assert is_box.sum() == rows * columns > 2000 and rows / columns == pytest.approx(9 / 7, rel=0.02)
    assert "box.obj" in study.options()


def test_fits_ignore_a_few_outliers():
    rng = np.random.default_rng(1)
    directions = rng.normal(size=(400, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    centre = np.array([0.1, -0.2, 1.5])
    ball = centre + 0.2 * directions
    ball[:4] *= 1.05
    sphere, rms_m = fit_without_outliers(Sphere, ball)
    assert sphere.radius == pytest.approx(0.2, abs=1e-6) and rms_m < 1e-6
    distance_m = np.linalg.norm(centre)
    assert sphere.depth_m(centre[None] / distance_m)[0] == pytest.approx(distance_m - 0.2, abs=1e-6)
    wall = np.column_stack([rng.uniform(-1, 1, (400, 2)), np.full(400, 2.0)])
    wall[:, 2] += 0.1 * wall[:, 0]
    wall[:4, 2] += 1
    plane, rms_m = fit_without_outliers(Plane, wall)
    assert plane.depth_m(np.array([[0, 0, 1.0]]))[0] == pytest.approx(2.0) and rms_m < 1e-9


@pytest.mark.parametrize("arguments, said", [
    (([], "out"), "names: got none"),
    (("fig99", "out"), "must be all or one of fig2"),
    (("fgi5", "out"), "did you mean fig5?"),
])
def test_rejects_unknown_figures(arguments, said):
    with pytest.raises(paper.UsageError, match=said.replace("?", r"\?")):
        paper.reproduce(*arguments)


def command(directory, *words, python_path=""):
    if "TOFSMITH_CLI" not in os.environ:
        pytest.skip("needs the command line")
    return subprocess.run(
        [os.environ["TOFSMITH_CLI"], "reproduce", *words], cwd=directory, capture_output=True, text=True,
        env=os.environ | {"TOFSMITH_PYTHON": sys.executable, "PYTHONPATH": python_path})


def test_the_command_runs_the_module(tmp_path):
    done = command(tmp_path, "fig5", "--fast", "-o", "out", "--json")
    assert done.returncode == 0, done.stderr
    document = json.loads(done.stdout)
    assert (document["fast"], document["seed"], document["output"]) == (True, 1, "out/index.html")
    assert document["items"][0]["findings"][0]["verdict"] == HOLDS
    again = command(tmp_path, "fig5", "--fast", "-o", "out")
    assert "fig5: Impulse responses and their band limits (finished before)" in again.stdout


def test_the_command_rejects_like_other_commands(tmp_path):
    for words, code, said in ((["fig99"], 2, "must be all or one of fig2"),
                              (["fig5", "--mesh", "cow.obj"], 2, "only fig7"),
                              (["fig7", "--mesh", "none.obj"], 1, "none.obj")):
        done = command(tmp_path, *words)
        assert done.returncode == code and said in done.stderr, done.stderr
        assert "Traceback" not in done.stderr


def test_a_missing_matplotlib_is_reported(tmp_path):
    (tmp_path / "matplotlib.py").write_text("raise ImportError('hidden by a test')")
    # The package of the build comes first on the path, followed by a fake matplotlib.
    done = command(tmp_path, "fig5", python_path=str(tmp_path))
    assert done.returncode == 1
    assert "apt install python3-matplotlib" in done.stderr and "Traceback" not in done.stderr

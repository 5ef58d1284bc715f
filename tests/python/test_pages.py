# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Reports and the paper's figures are those of the command line."""

import pickle
import re
import subprocess

import pytest

import tofsmith as ts
from conftest import page_without_command


def run(cli, directory, *arguments):
    done = subprocess.run([cli, *map(str, arguments)], cwd=directory, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def small():
    return ts.Camera("paper-10f0", samples=60,
                     operating={"signal_e_per_s": [1e4, 1e5], "ambient_e_per_s": [1e3]})


def test_an_evaluation_has_the_page_of_the_command(small, cli, tmp_path):
    small.write(tmp_path / "small.toml")
    camera = ts.Camera(tmp_path / "small.toml")
    codes = ["square-k4", "hamiltonian-k3"]
    run(cli, tmp_path, "evaluate", *codes, "--camera", "small.toml", "--trials", 100, "-o", "c.html")
    reports = [ts.evaluate(code, camera, trials=100) for code in codes]
    ts.write_evaluation_report(tmp_path / "p.html", codes, camera, reports)
    assert page_without_command(tmp_path / "c.html") == page_without_command(tmp_path / "p.html")
    again = pickle.loads(pickle.dumps(reports[0]))
    ts.write_evaluation_report(tmp_path / "one.html", codes[0], camera, again)
    with pytest.raises(OSError, match="exists already; .* overwrite=True"):
        ts.write_evaluation_report(tmp_path / "one.html", codes[0], camera, again)


def test_a_design_is_written_as_the_command_writes_it(small, cli, tmp_path):
    result = ts.design(small, method="factorize", exposures=[3], trials=1000, search_trials=100,
                       baselines=["sinusoid-k3"],
                       factorize={"random_starts": 0, "max_iterations": 3})
    result.write(tmp_path / "mine")
    names = {path.name for path in (tmp_path / "mine").iterdir()}
    assert {"camera.toml", "design.json", "details.json", "codes", "report.html"} <= names
    made = page_without_command(tmp_path / "mine" / "report.html")
    run(cli, tmp_path, "report", "mine", "-o", "c.html")
    assert page_without_command(tmp_path / "c.html") == made
    ts.write_report(tmp_path / "mine", tmp_path / "p.html")
    assert (tmp_path / "p.html").read_text() == made
    result.write_report(tmp_path / "alone.html")
    assert "<h1" in (tmp_path / "alone.html").read_text()
    for write in (lambda: result.write(tmp_path / "mine"), lambda: ts.write_report(tmp_path / "mine")):
        with pytest.raises(OSError, match="exists"):
            write()
    with pytest.raises(ValueError, match="pickled"):
        pickle.loads(pickle.dumps(result)).write(tmp_path / "other")


def test_the_paper_is_reproduced_as_by_the_command(cli, tmp_path):
    names = dict(ts.paper_items())
    assert {"fig2", "fig11", "table1", "text"} <= set(names)
    made = ts.reproduce("fig5", tmp_path / "python", fast=True)
    run(cli, tmp_path, "reproduce", "fig5", "--fast", "-o", "command")
    files = [p.relative_to(tmp_path / "python") for p in (tmp_path / "python").rglob("*.*")]
    assert len(files) > 3
    for file in files:
        assert (tmp_path / "command" / file).read_bytes() == (tmp_path / "python" / file).read_bytes()
    assert (made[0].name, made[0].title, made[0].verdict) == ("fig5", names["fig5"], "holds")
    assert made[0].findings[0].statement and not made[0].kept
    assert ts.reproduce(["fig5"], tmp_path / "python", fast=True)[0].kept


refusals = [
    (lambda: ts.write_report("/nowhere"), OSError, "/nowhere: holds no design.json"),
    (lambda: ts.write_evaluation_report("a.html", ["square-k4"], "paper-10f0", []), ValueError, "reports: got 0; needs one for each of 1 codes"),
    (lambda: ts.write_evaluation_report("a.html", ["square-k4"], "paper-10f0", [3]), TypeError, "reports: got int 3; needs a tofsmith.DepthErrorReport"),
    (lambda: ts.write_evaluation_report("a.html", "square-k4", "paper-10f0", ts.evaluate("square-k4", ts.Camera("paper-10f0", operating={"signal_e_per_s": [1e4]}), trials=10)), ValueError, "reports: got "),
    (lambda: ts.reproduce("fig22", "out"), ValueError, "fig2"),
    (lambda: ts.reproduce([], "out"), ValueError, "names: got none"),
    (lambda: ts.reproduce("fig5", "out", fast=1), TypeError, "fast: got int 1; needs True or False"),
]


@pytest.mark.parametrize("call, kind, message", refusals, ids=[r[2][:50] for r in refusals])
def test_bad_input_is_refused_by_name(call, kind, message):
    with pytest.raises(kind, match=re.escape(message)):
        call()

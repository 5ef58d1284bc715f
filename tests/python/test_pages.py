# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Reports and figures of the paper are the same as from the command line."""

import pickle

import pytest

import tofsmith as ts
from conftest import page_without_command, run


@pytest.fixture(scope="module")
def small():
    return ts.Camera("paper-10f0", samples=60,
                     operating={"signal_e_per_s": [1e4, 1e5], "ambient_e_per_s": [1e3]})


def test_evaluation_page_equals_the_command(small, cli, tmp_path):
    small.write(tmp_path / "small.toml")
    camera = ts.Camera(tmp_path / "small.toml")
    codes = ["square-k4", "hamiltonian-k3"]
    run(cli, "evaluate", *codes, "--camera", "small.toml", "--trials", 100, "-o", "c.html",
        directory=tmp_path)
    reports = [ts.evaluate(code, camera, trials=100) for code in codes]
    ts.write_evaluation_report(tmp_path / "p.html", codes, camera, reports)
    assert page_without_command(tmp_path / "c.html") == page_without_command(tmp_path / "p.html")
    again = pickle.loads(pickle.dumps(reports[0]))
    ts.write_evaluation_report(tmp_path / "one.html", codes[0], camera, again)
    with pytest.raises(OSError, match="already exists; .* overwrite=True"):
        ts.write_evaluation_report(tmp_path / "one.html", codes[0], camera, again)


def test_design_files_equal_the_command(small, cli, tmp_path):
    result = ts.design(small, method="factorize", exposures=[3], trials=1000, search_trials=100,
                       baselines=["sinusoid-k3"],
                       factorize={"random_starts": 0, "max_iterations": 3})
    result.write(tmp_path / "mine")
    names = {path.name for path in (tmp_path / "mine").iterdir()}
    assert {"camera.toml", "design.json", "details.json", "codes", "report.html"} <= names
    made = page_without_command(tmp_path / "mine" / "report.html")
    run(cli, "report", "mine", "-o", "c.html", directory=tmp_path)
    assert page_without_command(tmp_path / "c.html") == made
    ts.write_report(tmp_path / "mine", tmp_path / "p.html")
    assert page_without_command(tmp_path / "p.html") == made
    result.write_report(tmp_path / "alone.html")
    assert page_without_command(tmp_path / "alone.html")[1]["sections"]
    for write in (lambda: result.write(tmp_path / "mine"), lambda: ts.write_report(tmp_path / "mine")):
        with pytest.raises(OSError, match="exists"):
            write()
    with pytest.raises(ValueError, match="pickled"):
        pickle.loads(pickle.dumps(result)).write(tmp_path / "other")


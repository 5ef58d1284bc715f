# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Reports, the paper's figures and scripts for generators are those of the command line."""

import os
import pickle
import re
import socket
import subprocess
import threading

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


def test_the_script_of_an_upload_is_that_of_the_command(cli, tmp_path):
    more = {"exposure": 2, "tables": {"samples": 12, "low_v": 0, "high_v": 2}}
    options = ["--exposure", 2, "--samples", 12, "--volts", "0,2"]
    for model in ("SDG2042X", "33522", "AFG3252"):
        said = run(cli, tmp_path, "upload", "hamiltonian-k3", "--dry-run", "--model", model, *options)
        script = ts.upload_script("hamiltonian-k3", "paper-10f0", model, **more)
        assert str(script) == said
        assert [c.plays for c in script.channels] == ["modulation_2", "demodulation_2"]
        assert sum(len(message.data) for message in script.messages) > 0
    assert script.model in {model.name for model in ts.generator_models()}
    whole = ts.upload_script("hamiltonian-k3", "paper-10f0", "33522", all=True)
    assert [len(channel.stored) for channel in whole.channels] == [3, 3]


@pytest.fixture
def stranger():
    """An instrument that is no generator: it answers *IDN? with something else."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        def answer():
            connection, _ = server.accept()
            with connection:
                connection.recv(100)
                connection.sendall(b"Keysight Technologies,34465A,1,2\n")
                while connection.recv(100):
                    pass

        thread = threading.Thread(target=answer, daemon=True)
        thread.start()
        yield f"127.0.0.1:{server.getsockname()[1]}"
        thread.join(10)


def test_an_upload_reaches_the_instrument(stranger):
    with pytest.raises(OSError, match="found the instrument 34465A of Keysight"):
        ts.upload("hamiltonian-k3", "paper-10f0", stranger)


def test_an_upload_is_verified():
    program = os.environ.get("TOFSMITH_SIMULATED_GENERATOR")
    if not program:
        pytest.skip("TOFSMITH_SIMULATED_GENERATOR does not name the simulated generator")
    generator = subprocess.Popen([program, "keysight", "33622A"], stdin=subprocess.PIPE,
                                 stdout=subprocess.PIPE, text=True)
    seen = []
    with generator:
        address = "127.0.0.1:" + generator.stdout.readline().strip()
        report = ts.upload("hamiltonian-k3", "paper-10f0", address, tables={"periods": 1},
                           progress=lambda fraction, step: seen.append(fraction))
        generator.stdin.close()
    assert report.verified, report.message
    assert (report.model, report.channels[0].plays) == ("33622A", "modulation_1")
    assert all(abs(n.read_back - n.requested) <= 1e-3 * abs(n.requested) + 1e-3 for n in report.numbers)
    assert seen and seen[-1] == 1


refusals = [
    (lambda: ts.write_report("/nowhere"), OSError, "/nowhere: holds no design.json"),
    (lambda: ts.write_evaluation_report("a.html", ["square-k4"], "paper-10f0", []), ValueError, "reports: got 0; needs one for each of 1 codes"),
    (lambda: ts.write_evaluation_report("a.html", ["square-k4"], "paper-10f0", [3]), TypeError, "reports: got int 3; needs a tofsmith.DepthErrorReport"),
    (lambda: ts.write_evaluation_report("a.html", "square-k4", "paper-10f0", ts.evaluate("square-k4", ts.Camera("paper-10f0", operating={"signal_e_per_s": [1e4]}), trials=10)), ValueError, "reports: got "),
    (lambda: ts.reproduce("fig22", "out"), ValueError, "fig2"),
    (lambda: ts.reproduce([], "out"), ValueError, "names: got none"),
    (lambda: ts.reproduce("fig5", "out", fast=1), TypeError, "fast: got int 1; needs True or False"),
    (lambda: ts.upload_script("square-k4", "paper-10f0", "SDG1"), ValueError, "must be one of"),
    (lambda: ts.upload_script("square-k4", "paper-10f0", "33522", exposre=1), ValueError, "did you mean exposure?"),
    (lambda: ts.upload_script("square-k4", "paper-10f0", "33522", exposure=9), ValueError, "expected at most 4 and 1"),
    (lambda: ts.upload_script("square-k4", "paper-10f0", "33522", light_channel=0, sensor_channel=0), ValueError, "sensor_channel = 0"),
    (lambda: ts.upload_script("square-k4", "paper-10f0", "33522", filter="none"), ValueError, "filter = none; must be step, normal or off"),
    (lambda: ts.upload_script("square-k4", "paper-10f0", "33522", tables={"bits": 99}), ValueError, "bits"),
    (lambda: ts.upload("square-k4", "paper-10f0", "http://x"), ValueError, "tcp://host:port"),
    (lambda: ts.upload("square-k4", "paper-10f0", "x", timeout_s=0), ValueError, "timeout_s: got 0; needs a number in (0, 3600]"),
]


@pytest.mark.parametrize("call, kind, message", refusals, ids=[r[2][:50] for r in refusals])
def test_bad_input_is_refused_by_name(call, kind, message):
    with pytest.raises(kind, match=re.escape(message)):
        call()


def test_nothing_is_sent_where_nobody_listens():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    with pytest.raises(OSError, match=f"tcp://127.0.0.1:{port}: cannot connect"):
        ts.upload("square-k4", "paper-10f0", f"127.0.0.1:{port}")

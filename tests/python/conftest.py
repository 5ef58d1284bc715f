# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
import json
import os
import subprocess
import sys

import matplotlib
import pytest

sys.dont_write_bytecode = True
matplotlib.use("Agg")


def run(cli, *arguments, directory=None):
    """Runs the command line and returns its standard output."""
    done = subprocess.run([cli, *map(str, arguments)], cwd=directory, capture_output=True,
                          text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def page_without_command(path):
    """Returns a page without its command-line section, which pages written by Python lack."""
    viewer, mark, rest = path.read_text().partition('id="document">')
    text, end, script = rest.partition("</script>")
    assert mark and end and script.rstrip().endswith("</html>")
    document = json.loads(text)
    assert document["title"]
    document["sections"] = [s for s in document["sections"] if s["title"] != "Command"]
    return viewer, document, script


@pytest.fixture(scope="session")
def cli():
    """Path of the command-line program, the reference for the package."""
    path = os.environ.get("TOFSMITH_CLI")
    if not path:
        pytest.skip("TOFSMITH_CLI does not name the command line")
    return path


@pytest.fixture(scope="session")
def camera():
    import tofsmith

    return tofsmith.Camera(
        "paper-10f0",
        samples=120,
        operating={"signal_e_per_s": [1e4, 1e5], "ambient_e_per_s": [1e3, 1e4]},
    )

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
import os
import re
import sys

import matplotlib
import pytest

sys.dont_write_bytecode = True
matplotlib.use("Agg")


def page_without_command(path):
    """A page but for its section on the command line, which Python has none of."""
    text = path.read_text()
    assert "<h1" in text and text.rstrip().endswith("</html>")
    text = re.sub(r'<li><a href="#[\w-]+">Command</a></li>\n', "", text)
    return re.sub(r"<section[^>]*>\s*<h2[^>]*>Command</h2>.*?</section>\n", "", text, flags=re.S)


@pytest.fixture(scope="session")
def cli():
    """The command line, which must say the same as the package."""
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

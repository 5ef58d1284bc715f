# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Every example runs unchanged, and its C++ counterpart prints the same."""

import os
import re
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

folder = Path(__file__).resolve().parents[2] / "examples"
examples = sorted((folder / "python").glob("[0-9]*.py"))
programs = os.environ.get("TOFSMITH_EXAMPLES")


def output_of(command, directory):
    directory.mkdir()
    done = subprocess.run(
        command, cwd=directory, capture_output=True, text=True,
        env=os.environ | {"MPLBACKEND": "Agg"})
    assert done.returncode == 0, done.stderr
    return done.stdout, sorted(path.name for path in directory.iterdir())


@pytest.mark.parametrize("example", examples, ids=lambda path: path.stem)
def test_counterparts_run_and_print_the_same(example, tmp_path):
    said = output_of([sys.executable, "-B", example], tmp_path / "python")
    assert said[0]
    if programs:
        assert output_of([Path(programs) / example.stem], tmp_path / "cpp") == said


tasks = sorted((folder / "python" / "tasks").glob("*.py"))


@pytest.mark.parametrize("task", tasks, ids=lambda path: path.stem)
def test_tasks_run_and_are_short(task, tmp_path):
    printed, files = output_of([sys.executable, "-B", task], tmp_path / "task")
    assert printed and (files or task.stem == "find_the_bandwidth")
    text = task.read_text()
    assert text.count("# %%") >= 2 and len(text.splitlines()) < 60


def snippets():
    for page in ("README.md", "docs/python.md", "docs/calibration.md", "docs/torch.md"):
        text = (folder.parent / page).read_text()
        blocks = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
        assert blocks, page
        needs_torch = pytest.mark.skipif(page == "docs/torch.md" and not find_spec("torch"),
                                         reason="PyTorch is not installed")
        yield pytest.param("".join(blocks), id=page, marks=needs_torch)


@pytest.mark.parametrize("snippet", snippets())
def test_snippets_of_pages_run(snippet, tmp_path):
    output_of([sys.executable, "-B", "-c", snippet], tmp_path / "page")


def test_every_example_has_a_counterpart():
    assert len(examples) == 7
    twins = sorted(path.stem for path in (folder / "cpp").glob("[0-9]*.cpp"))
    assert twins == [path.stem for path in examples]

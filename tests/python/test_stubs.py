# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Types, stubs and docstrings are complete and match the package."""

import inspect
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import tofsmith as ts
from tofsmith import _tofsmith, figures, instruments, plot

root = Path(__file__).resolve().parents[2]


def run_mypy(tmp_path, *arguments):
    environment = os.environ | {"MYPYPATH": str(Path(ts.__file__).parents[1])}
    return subprocess.run(
        [sys.executable, "-m", *arguments],
        capture_output=True, text=True, cwd=tmp_path, env=environment)


def test_types_are_correct(tmp_path):
    pytest.importorskip("mypy", reason="mypy is not installed")
    done = run_mypy(tmp_path, "mypy", "--config-file", str(root / "pyproject.toml"),
                    "--cache-dir", str(tmp_path), "-p", "tofsmith")
    assert done.returncode == 0, done.stdout + done.stderr


def test_stubs_match_the_compiled_module(tmp_path):
    pytest.importorskip("mypy", reason="mypy is not installed")
    # pybind11 adds to every class a metaclass and, without a constructor, an __init__ that raises.
    allowed = tmp_path / "allowed.txt"
    allowed.write_text("tofsmith\\._tofsmith\\.[A-Z]\\w*(\\.__init__)?\n")
    done = run_mypy(tmp_path, "mypy.stubtest", "--allowlist", str(allowed), "--ignore-missing-stub",
                    "--mypy-config-file", str(root / "pyproject.toml"), "tofsmith._tofsmith")
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_package_uses_all_names_of_the_compiled_module():
    """A misspelt name would otherwise only be found when it is used."""
    used: set[str] = set()
    for path in Path(ts.__file__).parent.rglob("*.py"):
        text = path.read_text("utf-8")
        used |= set(re.findall(r"\b_tofsmith\.(?!import\b)(\w+)", text))
        for names in re.findall(r"from \._tofsmith import (\([^)]*\)|.*)", text):
            used |= set(re.findall(r"\w+", names))
    assert used == {name for name in vars(_tofsmith) if not name.startswith("_")}


def public():
    for name in ts.__all__:
        if name != "Interrupted":
            yield f"tofsmith.{name}", getattr(ts, name)
    for module in (figures, instruments, plot):
        for name, value in vars(module).items():
            if not name.startswith("_") and getattr(value, "__module__", "") == module.__name__:
                yield f"{module.__name__}.{name}", value


def test_everything_public_is_documented_and_listed():
    for name, value in public():
        assert inspect.getdoc(value), name
    names = {n for n, v in vars(ts).items() if inspect.isclass(v) or inspect.isfunction(v)}
    assert {n for n in names if not n.startswith("_")} == set(ts.__all__)


def test_parameters_are_documented():
    for name, value in public():
        doc = inspect.getdoc(value) or ""
        if "Parameters\n" in doc and inspect.isfunction(value):
            for parameter in inspect.signature(value).parameters:
                assert parameter in doc, f"{name}: {parameter}"

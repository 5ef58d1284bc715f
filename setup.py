# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""pip install --no-build-isolation . : CMake builds the compiled part of the Python package.

The build directory is build/pip, or that of the environment variable TOFSMITH_CMAKE_BUILD.
"""

import os
import re
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

root = Path(__file__).resolve().parent


def version() -> str:
    """The one that CMakeLists.txt says."""
    found = re.search(r"project\(tofsmith VERSION ([\d.]+)", (root / "CMakeLists.txt").read_text())
    if found is None:
        raise SystemExit("setup.py: found no version in CMakeLists.txt")
    return found.group(1)


def run_telling_progress(command: list) -> None:
    """Runs a build of some minutes. pip hides what it prints, so that its steps, "[12/60] ..", are
    also written to the terminal, if there is one.
    """
    try:
        terminal = open("/dev/tty", "w") if not sys.stdout.isatty() else None
    except OSError:
        terminal = None
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as build:
        for line in build.stdout or ():
            print(line, end="", flush=True)
            step = re.match(r"\[(\d+)/(\d+)\]", line)
            if terminal and step:
                terminal.write(f"\rtofsmith: compiling, step {step[1]} of {step[2]}  ")
                terminal.flush()
    if terminal:
        terminal.write("\n")
        terminal.close()
    if build.returncode:
        raise subprocess.CalledProcessError(build.returncode, command)


class CMakeBuild(build_ext):
    """Builds the target _tofsmith and puts it where setuptools wants it."""

    def build_extension(self, extension: Extension) -> None:
        target = Path(self.get_ext_fullpath(extension.name)).resolve()
        build = Path(os.environ.get("TOFSMITH_CMAKE_BUILD", root / "build" / "pip")).resolve()
        options = {
            "CMAKE_BUILD_TYPE": "Release",
            "TOFSMITH_BUILD_PYTHON": "REQUIRED",
            "TOFSMITH_BUILD_APPS": "OFF",
            "TOFSMITH_BUILD_TESTS": "OFF",
            "BUILD_SHARED_LIBS": "OFF",
            "TOFSMITH_UNITY": "ON",  # compiles in a third of the time
            "Python_EXECUTABLE": sys.executable,
        }
        defines = [f"-D{name}={value}" for name, value in options.items()]
        jobs = ["--parallel"] + ([str(self.parallel)] if self.parallel else [])
        subprocess.run(["cmake", "-S", root, "-B", build, "-G", "Ninja", *defines], check=True)
        run_telling_progress(["cmake", "--build", build, "--target", "_tofsmith", *jobs])
        built = next((build / "python" / "tofsmith").glob("_tofsmith*.so"))
        target.parent.mkdir(parents=True, exist_ok=True)
        self.copy_file(str(built), str(target))


setup(
    version=version(),
    ext_modules=[Extension("tofsmith._tofsmith", sources=[])],
    cmdclass={"build_ext": CMakeBuild},
)

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""pip install --no-build-isolation . : CMake builds the compiled part of the Python package and the
command line, which is installed inside the package, in _prefix/.

Environment variables:
TOFSMITH_CMAKE_BUILD    the build directory (build/pip)
TOFSMITH_CMAKE_OPTIONS  further options for CMake, such as "-DTOFSMITH_USE_OPENCL=OFF"
"""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

root = Path(__file__).resolve().parent


def version() -> str:
    """Returns the version in CMakeLists.txt."""
    found = re.search(r"project\(tofsmith VERSION ([\d.]+)", (root / "CMakeLists.txt").read_text())
    if found is None:
        raise SystemExit("setup.py: found no version in CMakeLists.txt")
    return found.group(1)


def run_telling_progress(command: list) -> None:
    """Runs a build of some minutes. pip hides its output, so its steps, "[12/60] ...", are also
    written to the terminal, if any.
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
    """Builds the extension and the command line and copies them into the package."""

    def build_extension(self, extension: Extension) -> None:
        target = Path(self.get_ext_fullpath(extension.name)).resolve()
        build = Path(os.environ.get("TOFSMITH_CMAKE_BUILD", root / "build" / "pip")).resolve()
        options = {
            "CMAKE_BUILD_TYPE": "Release",
            "TOFSMITH_BUILD_PYTHON": "REQUIRED",
            "TOFSMITH_BUILD_APPS": "ON",
            "TOFSMITH_BUILD_TESTS": "OFF",
            "BUILD_SHARED_LIBS": "OFF",
            "TOFSMITH_UNITY": "ON",  # compiles in a third of the time
            "Python_EXECUTABLE": sys.executable,
        }
        defines = [f"-D{name}={value}" for name, value in options.items()]
        defines += shlex.split(os.environ.get("TOFSMITH_CMAKE_OPTIONS", ""))
        jobs = ["--parallel"] + ([str(self.parallel)] if self.parallel else [])
        subprocess.run(["cmake", "-S", root, "-B", build, "-G", "Ninja", *defines], check=True)
        run_telling_progress(["cmake", "--build", build, "--target", "tofsmith_python", "tofsmith_cli", *jobs])
        # Its file name contains the Python version that CMake built it for.
        built = next((build / "python" / "tofsmith").glob("_tofsmith*.so"))
        made = (built.name, "_camera_fields.py", "_decoded_planes.py", "_option_fields.py",
                "_result_fields.py")
        files = {**{built.with_name(name): target.with_name(name) for name in made},
                 build / "apps" / "tofsmith": target.parent / "_prefix" / "bin" / "tofsmith"}
        lab_page = root / "build-lab" / "lab.html"  # of scripts/lab.sh
        if lab_page.exists():
            files[lab_page] = target.parent / "_prefix" / "share" / "tofsmith" / "lab.html"
        for source, destination in files.items():
            destination.parent.mkdir(parents=True, exist_ok=True)
            self.copy_file(str(source), str(destination))


setup(
    version=version(),
    scripts=["python/command/tofsmith"],
    ext_modules=[Extension("tofsmith._tofsmith", sources=[])],
    cmdclass={"build_ext": CMakeBuild},
)

#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Checks that wheels are portable:

    scripts/wheel/check.py --source SOURCE --build BUILD WHEEL ...

Requirements: at most 25 MB; all shared libraries included except the C library's, with search paths
relative to $ORIGIN; no path of this build in any file; a licence text for every library; no unique
symbols; a tag for a C library at least as new as the files need; and pip rejects the wheel for an
older one. Prints all problems and exits with 1.
"""

import argparse
import pathlib
import re
import subprocess
import sys
import tempfile
import zipfile

from elf import C_LIBRARY, elf_files, needed_libraries, newest_c_library, readelf, search_paths

MAX_BYTES = 25_000_000
REQUIRED = ["tofsmith/__init__.py", "tofsmith/py.typed", "tofsmith/_prefix/bin/tofsmith"]


def problems_of_file(file, tree):
    inside = {path.name: path for path in tree.rglob("*.so*")}
    for path in search_paths(file):
        if not re.fullmatch(r"\$ORIGIN(/[\w.]+)*", path):
            yield f"searches libraries in {path}; expected a path relative to $ORIGIN"
    folders = [(file.parent / path.replace("$ORIGIN", ".")).resolve() for path in search_paths(file)]
    for name in needed_libraries(file):
        if name in C_LIBRARY:
            continue
        if name not in inside or inside[name].parent.resolve() not in folders:
            yield f"needs {name}, which is not in its search path inside the wheel"
    if " UNIQUE " in readelf(file, "--dyn-syms"):
        yield "has unique symbols, which other copies in the process would share"


def problems_of_tag(wheel, newest):
    tag = re.search(r"-cp(\d+)-cp\1-manylinux_(\d+)_(\d+)_(\w+)\.whl$", wheel.name)
    if tag is None:
        yield "has no tag such as cp311-cp311-manylinux_2_36_x86_64"
        return
    python, claimed, machine = tag[1], (int(tag[2]), int(tag[3])), tag[4]
    if claimed < newest:
        yield f"claims to need GLIBC_{claimed[0]}.{claimed[1]}, but needs GLIBC_{newest[0]}.{newest[1]}"
    for version, expected in ((claimed, True), ((2, 31), False), ((claimed[0], claimed[1] - 1), False)):
        with tempfile.TemporaryDirectory() as directory:
            accepted = subprocess.run(
                ["/usr/bin/python3", "-m", "pip", "download", "-q", "--no-index", "--no-deps",
                 "--only-binary=:all:", "--python-version", f"{python[0]}.{python[1:]}",
                 "--platform", f"manylinux_{version[0]}_{version[1]}_{machine}",
                 "--find-links", wheel.parent, "-d", directory, "tofsmith"],
                capture_output=True).returncode == 0
        if accepted != expected:
            yield f"is {'accepted' if accepted else 'rejected'} by pip for glibc {version[0]}.{version[1]}"


def problems_of_tree(tree, build_paths):
    """Problems of an unpacked wheel."""
    for name in REQUIRED:
        if not (tree / name).exists():
            yield f"has no file {name}"
    for path in sorted(tree.rglob("*")):
        content = path.read_bytes() if path.is_file() else b""
        for build_path in build_paths:
            if build_path.encode() in content:
                yield f"{path.relative_to(tree)}: contains the path {build_path} of this build"
    for file in elf_files(tree):
        for problem in problems_of_file(file, tree):
            yield f"{file.relative_to(tree)}: {problem}"
    if not any(path.stat().st_size for path in tree.glob("*.dist-info/licenses/*.txt")):
        yield "has no licences of the libraries in it"
    own = [*tree.glob("tofsmith/_tofsmith*.so"), *tree.glob("tofsmith/_prefix/bin/*"),
           *tree.glob("tofsmith/_prefix/lib/libtofsmith*")]
    hardened = subprocess.run([pathlib.Path(__file__).parents[1] / "check_elf.py", *own],
                              capture_output=True, text=True)
    if hardened.returncode:
        yield hardened.stdout.replace(f"{tree}/", "").strip()


def problems(wheel, build_paths):
    if wheel.stat().st_size > MAX_BYTES:
        yield f"has {wheel.stat().st_size} bytes; expected at most {MAX_BYTES}"
    with tempfile.TemporaryDirectory() as directory, zipfile.ZipFile(wheel) as archive:
        tree = pathlib.Path(directory)
        archive.extractall(tree)
        yield from problems_of_tree(tree, build_paths)
        yield from problems_of_tag(wheel, max(map(newest_c_library, elf_files(tree))))


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--source", required=True, help="directory that must not occur in a file")
    parser.add_argument("--build", required=True, help="another one")
    parser.add_argument("wheels", nargs="+", type=pathlib.Path)
    arguments = parser.parse_args()
    failed = False
    for wheel in arguments.wheels:
        for problem in problems(wheel.resolve(), [arguments.source, arguments.build]):
            print(f"{wheel.name}: {problem}")
            failed = True
    if not failed:
        print(f"{len(arguments.wheels)} wheels are portable")
    sys.exit(failed)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Makes a wheel portable: copies the shared libraries that it uses, except the C library's, into it.

    scripts/wheel/bundle.py --build BUILD -o DIR [--python-root ROOT] WHEEL

Each library is stored as tofsmith/_prefix/lib/NAME-HASH.so.N and found by a search path relative to
$ORIGIN. The hash keeps it apart from other copies in the same process. The licence texts of all
packages that are copied or compiled in become part of the metadata. The platform tag is the version
of the C library that the files need, but at least 2.36.
"""

import argparse
import base64
import hashlib
import os
import pathlib
import platform
import re
import shutil
import subprocess
import sys
import tempfile
import time
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "cmake" / "debian"))
import make_sbom  # noqa: E402
from elf import (  # noqa: E402
    C_LIBRARY, elf_files, make_unique_symbols_global, needed_libraries, needed_symbols,
    newest_c_library)

COMPONENTS = ["core", "gpu", "design", "io", "lab", "report", "sweep", "tool", "python"]
# Source packages whose libraries may be copied; all licences allow it next to Apache-2.0 code.
REVIEWED = {
    "bzip2": "bzip2-1.0.6", "embree": "Apache-2.0", "fmtlib": "MIT",
    "gcc-12": "GPL-3.0-or-later WITH GCC-exception-3.1",
    "gcc-14": "GPL-3.0-or-later WITH GCC-exception-3.1",
    "hdf5": "BSD-3-Clause", "highway": "Apache-2.0 OR BSD-3-Clause", "imath": "BSD-3-Clause",
    "libaec": "BSD-2-Clause", "libmd": "BSD-3-Clause AND BSD-2-Clause AND ISC AND Beerware",
    "libpng1.6": "libpng-2.0", "libzip": "BSD-3-Clause",
    "libzstd": "BSD-3-Clause", "onetbb": "Apache-2.0", "openexr": "BSD-3-Clause",
    "sqlite3": "blessing", "tomlplusplus": "MIT", "xz-utils": "0BSD", "yaml-cpp": "MIT",
    "zlib": "Zlib",
}
# HDF5 needs these libraries for reading from Amazon S3, and libzip needs them for encryption.
# tofsmith uses neither. With the dependencies of libcurl, they would add twenty libraries, and
# OpenSSL inside a wheel would get no security updates. Their functions are replaced by functions
# that return 0, which HDF5 and libzip treat as a failure.
REPLACED = {"libcurl.so.4", "libcrypto.so.3"}
OLDEST_C_LIBRARY = (2, 36)


def fail(message):
    sys.exit(f"bundle.py: {message}")


def run(*command):
    subprocess.run([str(word) for word in command], check=True)


def find_library(name, directories, installed):
    for directory in directories:
        if (directory / name).exists():
            return directory / name
    if name not in installed:
        fail(f"found no library {name}")
    return pathlib.Path(installed[name])


def libraries_used_by(files, directories):
    """Paths of all shared libraries that ELF files use, directly or not, by name."""
    installed = make_sbom.installed_libraries()
    found, waiting = {}, list(files)
    while waiting:
        for name in needed_libraries(waiting.pop()):
            if name not in C_LIBRARY | REPLACED | set(found):
                found[name] = find_library(name, directories, installed)
                waiting.append(found[name])
    return found


def replacement(name, users, output):
    """Builds a library in which every function that `users` need of `name` returns 0."""
    symbols = set().union(*(needed_symbols(file, name) for file in users))
    functions = sorted({symbol for symbol, _ in symbols})
    code = "".join(f"long {function}(void) {{ return 0; }}\n" for function in functions)
    versions = "".join(
        f"{version} {{ global: {'; '.join(s for s, v in sorted(symbols) if v == version)}; local: *; }};\n"
        for version in sorted({version for _, version in symbols}))
    with tempfile.TemporaryDirectory() as directory:
        source, script = (pathlib.Path(directory) / file for file in ("functions.c", "versions"))
        source.write_text(code)
        script.write_text(versions)
        run("cc", "-O2", "-fPIC", "-shared", "-nostdlib", "-fno-builtin",
            f"-Wl,-soname,{output.name},--build-id=none,-z,relro,-z,now,--version-script={script}",
            source, "-o", output)


def hashed_name(name, path):
    stem, dot, suffix = name.partition(".so")
    return f"{stem}-{hashlib.sha256(path.read_bytes()).hexdigest()[:8]}{dot}{suffix}"


def set_search_path(file, folder):
    relative = os.path.relpath(folder, file.parent)
    path = "$ORIGIN" if relative == "." else f"$ORIGIN/{relative}"
    run("patchelf", "--set-rpath", path, file)


def copy_libraries(package, directories):
    """Copies all libraries into _prefix/lib and adapts names and search paths in all files.

    Returns the paths of the copied libraries outside `directories`.
    """
    folder = package / "_prefix" / "lib"
    folder.mkdir(parents=True)
    programs = elf_files(package)
    libraries = libraries_used_by(programs, directories)
    users = [*programs, *libraries.values()]
    names, copies = {}, []
    for name, path in sorted(libraries.items()):
        names[name] = hashed_name(name, path)
        copies.append(folder / names[name])
        shutil.copyfile(path, copies[-1])
    for name in sorted(REPLACED):
        if any(name in needed_libraries(user) for user in users):
            names[name] = f"{name.partition('.so')[0]}-tofsmith.so"
            replacement(name, users, folder / names[name])
    for file in programs + copies:
        file.chmod(0o755)
        run("strip", "--strip-unneeded", file)
        # One kind of change per run: patchelf 0.14 mixes up the arguments of several kinds.
        changes = [(name, names[name]) for name in needed_libraries(file) if name in names]
        if changes:
            run("patchelf", *(word for change in changes for word in ("--replace-needed", *change)), file)
        set_search_path(file, folder)
        if file in copies:
            run("patchelf", "--set-soname", file.name, file)
        make_unique_symbols_global(file)
    return [path for path in libraries.values() if path.parent not in directories]


def licence_texts(build, libraries, python_root):
    """Files with the licence of each package in the wheel, by package."""
    paths = [str(path) for path in libraries] + [str(path.resolve()) for path in libraries]
    paths += [re.sub("^/usr", "", path) for path in paths]
    copied = make_sbom.owners(paths)
    for name, (_, source) in copied.items():
        if source not in REVIEWED:
            fail(f"the wheel would contain a library of {name}; check that its licence allows this, "
                 f"then add the source package {source} to REVIEWED")
    packages = set(copied)
    for component in COMPONENTS:
        packages |= set(make_sbom.packages_compiled_in(build, component)[0])
    documents = pathlib.Path("/usr/share/doc")
    texts = {name: documents / name / "copyright" for name in packages}
    if python_root:
        texts["pybind11-dev"] = python_root / "usr/share/doc/pybind11-dev/copyright"
    for name, text in texts.items():
        if not text.exists():
            fail(f"found no licence of {name} in {text}")
    unowned = [path for path in libraries if not make_sbom.owners(
        [str(path), str(path.resolve()), re.sub("^/usr", "", str(path.resolve()))])]
    if unowned:
        fail(f"{unowned[0]} belongs to no Debian package, so that its licence is unknown")
    return texts


def add_licences(folder, texts):
    """Copies licence texts, and the common licences that they refer to instead of quoting them."""
    folder.mkdir(parents=True, exist_ok=True)
    common = set()
    for name, text in sorted(texts.items()):
        content = text.read_text(errors="replace")
        (folder / f"{name}.txt").write_text(content)
        common |= set(re.findall(r"/usr/share/common-licenses/([\w-]+(?:\.\d+)?)", content))
    for name in sorted(common):
        shutil.copyfile(f"/usr/share/common-licenses/{name}", folder / f"common-{name}.txt")


def tag_of(package):
    extension = next(package.glob("_tofsmith.cpython-*.so"))
    python = "cp" + re.match(r"_tofsmith\.cpython-(\d+)", extension.name)[1]
    major, minor = max([OLDEST_C_LIBRARY, *map(newest_c_library, elf_files(package))])
    return f"{python}-{python}-manylinux_{major}_{minor}_{platform.machine()}"


def set_tag(metadata, tag):
    file = metadata / "WHEEL"
    file.write_text(re.sub(r"^Tag: .*\n(Tag: .*\n)*", f"Tag: {tag}\n", file.read_text(), flags=re.M))


def pack(tree, output):
    """Writes a wheel with its record of hashes; the same files make the same bytes.

    Programs and libraries are compressed with LZMA, which pip supports. With deflate they would be
    a third larger, mostly because of Embree.
    """
    seconds = int(os.environ.get("SOURCE_DATE_EPOCH", "315532800"))  # 1980, the first of zip files
    date = time.gmtime(max(seconds, 315532800))[:6]
    record = next(tree.glob("*.dist-info")) / "RECORD"
    lines = []
    with zipfile.ZipFile(output, "w", zipfile.ZIP_DEFLATED) as archive:
        for path in sorted(path for path in tree.rglob("*") if path.is_file() and path != record):
            name, content = path.relative_to(tree).as_posix(), path.read_bytes()
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            lines.append(f"{name},sha256={digest},{len(content)}\n")
            add_file(archive, name, date, path.stat().st_mode & 0o100, content)
        name = record.relative_to(tree).as_posix()
        add_file(archive, name, date, False, "".join([*lines, f"{name},,\n"]))


def add_file(archive, name, date, is_executable, content):
    entry = zipfile.ZipInfo(name, date)
    entry.external_attr = (0o100755 if is_executable else 0o100644) << 16
    archive.writestr(entry, content, zipfile.ZIP_LZMA if "/_prefix/" in name else zipfile.ZIP_DEFLATED)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", required=True, type=pathlib.Path, help="CMake's directory")
    parser.add_argument("--python-root", type=pathlib.Path, help="as TOFSMITH_PYTHON_ROOT")
    parser.add_argument("-o", "--output", required=True, type=pathlib.Path, help="directory")
    parser.add_argument("wheel", type=pathlib.Path)
    arguments = parser.parse_args()
    build = arguments.build.resolve()
    with tempfile.TemporaryDirectory() as directory:
        tree = pathlib.Path(directory)
        with zipfile.ZipFile(arguments.wheel) as archive:
            for entry in archive.infolist():
                path = archive.extract(entry, tree)
                os.chmod(path, (entry.external_attr >> 16) & 0o777)
        package, metadata = tree / "tofsmith", next(tree.glob("*.dist-info"))
        libraries = copy_libraries(package, [build / "src"])
        add_licences(metadata / "licenses", licence_texts(build, libraries, arguments.python_root))
        tag = tag_of(package)
        set_tag(metadata, tag)
        name = f"{metadata.name.removesuffix('.dist-info')}-{tag}.whl"
        pack(tree, arguments.output / name)
    print(arguments.output / name)


if __name__ == "__main__":
    main()

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Reads and changes ELF files, for the scripts that build and check wheels."""

import re
import struct
import subprocess

# Libraries that every Linux with the GNU C library has.
C_LIBRARY = {"libc.so.6", "libm.so.6", "libdl.so.2", "libpthread.so.0", "librt.so.1",
             "ld-linux-x86-64.so.2", "ld-linux-aarch64.so.1"}
SHT_DYNSYM = 11
STB_GLOBAL, STB_GNU_UNIQUE = 1, 10


def readelf(file, *options):
    return subprocess.run(["readelf", "-W", *options, str(file)], check=True, capture_output=True,
                          text=True).stdout


def elf_files(folder):
    """All ELF files below a folder, sorted."""
    def is_elf(path):
        with path.open("rb") as file:
            return file.read(4) == b"\x7fELF"
    return sorted(path for path in folder.rglob("*") if path.is_file() and is_elf(path))


def needed_libraries(file):
    return re.findall(r"\(NEEDED\).*\[(.*)\]", readelf(file, "-d"))


def search_paths(file):
    return [part for path in re.findall(r"\(R(?:UN)?PATH\).*\[(.*)\]", readelf(file, "-d"))
            for part in path.split(":")]


def needed_versions(file):
    """Symbol versions that a file needs, by library."""
    versions = {}
    library = None
    for line in readelf(file, "-V").splitlines():
        if match := re.search(r"Version: \d+ +File: (\S+) +Cnt:", line):
            library = match[1]
        elif match := re.search(r"Name: (\S+) +Flags: .*Version: \d+", line):
            if library:
                versions.setdefault(library, set()).add(match[1])
        elif "Version definition section" in line or "Version symbols section" in line:
            library = None
    return versions


def needed_symbols(file, library):
    """Pairs of symbol and version that a file needs from a library that has symbol versions."""
    versions = needed_versions(file).get(library, set())
    undefined = re.findall(r" UND (\S+)@(\S+)", readelf(file, "--dyn-syms"))
    return {(symbol, version) for symbol, version in undefined if version in versions}


def newest_c_library(file):
    """The version of the GNU C library that a file needs, such as (2, 36)."""
    versions = {version for library, found in needed_versions(file).items() if library in C_LIBRARY
                for version in found}
    numbers = [re.fullmatch(r"GLIBC_(\d+)\.(\d+)(?:\.\d+)?", version) for version in versions]
    return max(((int(n[1]), int(n[2])) for n in numbers if n), default=(2, 0))


def make_unique_symbols_global(file):
    """Changes unique symbols (STB_GNU_UNIQUE) to global ones.

    The dynamic linker merges unique symbols of the same name across all libraries of a process, no
    matter how these were loaded. A second copy of libstdc++ would share the indices of some locale
    facets with the first one but count them itself: whatever prints a number next throws
    std::bad_cast.
    """
    content = bytearray(file.read_bytes())
    sections, = struct.unpack_from("<Q", content, 0x28)
    size, count = struct.unpack_from("<HH", content, 0x3A)
    for index in range(count):
        kind, = struct.unpack_from("<I", content, sections + index * size + 4)
        offset, length = struct.unpack_from("<QQ", content, sections + index * size + 24)
        if kind != SHT_DYNSYM:
            continue
        for symbol in range(offset, offset + length, 24):
            if content[symbol + 4] >> 4 == STB_GNU_UNIQUE:
                content[symbol + 4] = STB_GLOBAL << 4 | content[symbol + 4] & 15
    file.write_bytes(content)

#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Checks with readelf that programs and libraries are hardened (cmake/TofsmithDefaults.cmake):

    scripts/check_elf.py FILE ...

Requirements: position-independent code; relocations read-only and resolved at start (RELRO,
BIND_NOW); no executable stack and no segment that is both writable and executable; no text
relocations; search paths only relative to $ORIGIN; stack protector; every exported function starts
with ENDBR64 (CET, x86-64); and calls checked by _FORTIFY_SOURCE in at least one of the files.
Prints all violations and exits with 1.
"""

import re
import subprocess
import sys

ENDBR64 = b"\xf3\x0f\x1e\xfa"


def readelf(file, *options):
    return subprocess.run(["readelf", "-W", *options, file], check=True, capture_output=True,
                          text=True).stdout


def exported_functions(symbols):
    """Addresses of the functions defined in the file, by name."""
    found = re.findall(r"^ *\d+: ([0-9a-f]+) +\d+ FUNC +(?:GLOBAL|WEAK) +DEFAULT +\d+ (\S+)",
                       symbols, re.M)
    return {name: int(address, 16) for address, name in found}


def bytes_at(file, segments, address, count):
    """Bytes at an address of the loaded file."""
    for offset, begin, size in segments:
        if begin <= address < begin + size:
            with open(file, "rb") as content:
                content.seek(offset + address - begin)
                return content.read(count)
    return b""


def problems(file):
    header, dynamic = readelf(file, "-h"), readelf(file, "-d")
    program, symbols = readelf(file, "-l"), readelf(file, "--dyn-syms")
    if "DYN" not in header:
        yield "is not position-independent"
    if "INTERP" in program and "PIE" not in dynamic:
        yield "is a program but no PIE"
    if "GNU_RELRO" not in program:
        yield "has no RELRO"
    if not re.search(r"BIND_NOW|Flags:.*\bNOW\b", dynamic):
        yield "does not resolve all symbols at start (BIND_NOW)"
    if not re.search(r"GNU_STACK .* RW +0x", program):
        yield "has an executable stack, or does not say"
    if re.search(r"LOAD .* RWE ", program):
        yield "has a segment that is writable and executable"
    if "TEXTREL" in dynamic:
        yield "has text relocations"
    for path in re.findall(r"R(?:UN)?PATH.*\[(.*)\]", dynamic):
        if any(not part.startswith("$ORIGIN") for part in path.split(":")):
            yield f"searches libraries in {path}"
    if "__stack_chk_fail" not in symbols:
        yield "has no stack protector"
    if "X86-64" in header:
        segments = [tuple(int(number, 16) for number in found) for found in re.findall(
            r"LOAD +(0x\w+) (0x\w+) 0x\w+ (0x\w+)", program)]
        bare = sorted(name for name, address in exported_functions(symbols).items()
                      if bytes_at(file, segments, address, 4) != ENDBR64)
        if bare:
            yield f"has {len(bare)} functions without ENDBR64, such as {bare[0]}"


def main():
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        sys.exit(__doc__)
    files = sys.argv[1:]
    failed = False
    for file in files:
        for problem in problems(file):
            print(f"{file}: {problem}")
            failed = True
    if not any(re.search(r"UND __\w+_chk@", readelf(file, "--dyn-syms")) for file in files):
        print(f"{files[0]}: calls nothing that _FORTIFY_SOURCE checks, nor do the others")
        failed = True
    if not failed:
        print(f"{len(files)} files are hardened")
    sys.exit(failed)


main()

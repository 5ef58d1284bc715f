#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Writes the software bill of materials of a package as SPDX 2.3 (JSON).

The contents are found, not listed: headers that the objects include, from Ninja's dependencies, and
shared libraries that the ELF files need, each with its Debian package. The copyright file next to
this script contains the licences of code that is compiled in. A header with code from a package
that the file does not contain is an error.

    make_sbom.py --name tofsmith --version 0.1.0-1 --component tool --build BUILD --date SECONDS \
                 -o sbom.spdx.json [ELF ...]
"""

import argparse
import datetime
import fnmatch
import hashlib
import json
import pathlib
import platform
import re
import subprocess
import sys

# Folders with the objects of each component.
OBJECTS = {
    "tool": ["apps/CMakeFiles/"],
    "python": ["python/CMakeFiles/_tofsmith.dir/"],
}
# C headers, which only declare symbols of shared libraries.
DECLARATIONS = re.compile(
    r"libc6-dev|linux-libc-dev|libcrypt-dev|libpng-dev|zlib1g-dev|libzip-dev|libhdf5-dev|"
    r"libsqlite3-dev|libmd-dev|libfftw3-dev|libpython3\.\d+-dev|"
    r"opencl-c-headers|python3-numpy|python3-numpy-dev")
DISTRIBUTION = platform.freedesktop_os_release().get("VERSION_CODENAME", "debian")
SPDX_NAMES = {"Expat": "MIT", "BSD-2-clause": "BSD-2-Clause", "BSD-3-clause": "BSD-3-Clause"}


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def spdx_licence(debian):
    words = re.split(r" (and|or|with) ", debian)
    return " ".join(SPDX_NAMES.get(word, word) if i % 2 == 0 else word.upper()
                    for i, word in enumerate(words))


def known_licences(copyright_file):
    """Returns the licences in the copyright file by the names of its paragraphs; `*` is a wildcard."""
    licences = {}
    for paragraph in copyright_file.read_text().split("\n\n"):
        files = re.match(r"Files: (.*)", paragraph)
        licence = re.search(r"^License: (.*)", paragraph, re.M)
        for name in files[1].split() if files and licence else []:
            if name == "*":  # tofsmith itself
                continue
            licences[name] = spdx_licence(licence[1])
    return licences


def licence_of(name, licences):
    """Returns the declared licence of a Debian package, or None."""
    return next((licence for pattern, licence in licences.items()
                 if fnmatch.fnmatchcase(native(name), pattern)), None)


def headers_of(build, component):
    """Returns the system headers that the objects of the component include."""
    folders = OBJECTS.get(component, [f"src/CMakeFiles/tofsmith_{component}.dir/"])
    dependencies, entry = {}, None
    for line in run("ninja", "-C", str(build), "-t", "deps").splitlines():
        if line.startswith("    "):
            dependencies[entry].add(line.strip())
        elif ": #deps" in line:
            entry = line.split(": #deps")[0]
            dependencies[entry] = set()
    found, precompiled = set(), set()
    for name, files in dependencies.items():
        if any(name.startswith(folder) for folder in folders):
            found |= files
            precompiled |= {str(file) for file in files if file.endswith(".gch")}
    for name in dependencies:
        if any(file.endswith(name) for file in precompiled):
            found |= dependencies[name]
    return sorted({str(pathlib.Path(file).resolve()) for file in found if file.startswith("/usr/")})


def owners(files):
    """Returns the Debian packages that contain the files, and their versions."""
    names = set()
    for begin in range(0, len(files), 500):
        listing = subprocess.run(["dpkg-query", "-S", *files[begin:begin + 500]],
                                 capture_output=True, text=True).stdout
        for line in listing.splitlines():
            if not line.startswith("diversion "):
                names.add(line.split(": ")[0].split(",")[0])  # such as libfmt9:arm64
    versions = {}
    for name in sorted(names):
        fields = run("dpkg-query", "-W", "-f=${Version}\t${source:Package}\n", name)
        versions[name.split(":")[0]] = fields.splitlines()[0].split("\t")
    return versions


def native(name):
    """Returns the name of a package without its architecture."""
    return name.removesuffix("-arm64-cross")


def installed_libraries():
    """Returns the paths of the shared libraries of this system by name."""
    paths = {}
    for line in run("/sbin/ldconfig", "-p").splitlines():
        match = re.match(r"\s*(\S+) \(.*\) => (.*)", line)
        if match:
            paths.setdefault(match[1], match[2])
    return paths


def arm_libraries():
    """Returns the paths of arm64 libraries, which ldconfig does not list on other processors."""
    return {file.name: str(file) for folder in ("/usr/lib", "/lib")
            for file in pathlib.Path(folder, "aarch64-linux-gnu").glob("*.so.*")}


def libraries_of(elf_files):
    """Returns the paths of the shared libraries that ELF files need, without tofsmith's."""
    needed, paths = set(), installed_libraries()
    for file in elf_files:
        if pathlib.Path(file).is_symlink():  # to a library of another package
            continue
        described = run("readelf", "-hdW", file)
        if "AArch64" in described:
            paths |= arm_libraries()
        needed |= set(re.findall(r"\(NEEDED\).*\[(.*)\]", described))
    # dpkg lists files below /usr/lib or /lib, as in the package.
    found = [paths[name] for name in sorted(needed) if name in paths]
    return sorted({name for path in found
                   for name in (path, str(pathlib.Path(path).resolve()),
                                re.sub("^/usr", "", str(pathlib.Path(path).resolve())))})


def package(identifier, name, version, licence, source=None):
    item = {"SPDXID": f"SPDXRef-{identifier}", "name": name, "versionInfo": version,
            "downloadLocation": "NOASSERTION", "filesAnalyzed": False,
            "licenseConcluded": "NOASSERTION", "licenseDeclared": licence,
            "copyrightText": "NOASSERTION"}
    if source:
        item["supplier"] = "Organization: Debian"
        item["externalRefs"] = [{
            "referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
            "referenceLocator": f"pkg:deb/debian/{name}@{version.replace('+', '%2B').replace(':', '%3A')}"
                                f"?distro={DISTRIBUTION}&upstream={source.replace('+', '%2B')}"}]
    return item


def packages_compiled_in(build, component):
    """Returns the Debian packages with code in a component, with version, source and, for packages
    in the copyright file, licence."""
    licences = known_licences(pathlib.Path(__file__).with_name("copyright"))
    compiled_in = owners(headers_of(build, component))
    unknown = [name for name in compiled_in
               if not licence_of(name, licences) and not DECLARATIONS.fullmatch(native(name))]
    if unknown:
        sys.exit(f"make_sbom.py: {component} is compiled from headers of "
                 f"{', '.join(unknown)}; name each in cmake/debian/copyright, with its licence, or "
                 "among the DECLARATIONS of cmake/debian/make_sbom.py")
    return {name: found for name, found in compiled_in.items() if licence_of(name, licences)}, licences


def bill_of_materials(arguments):
    compiled_in, licences = packages_compiled_in(arguments.build, arguments.component)
    own = package("Package", arguments.name, arguments.version, "Apache-2.0")
    packages, relationships = [own], [("SPDXRef-DOCUMENT", "DESCRIBES", own)]
    for relation, found in (("CONTAINS", compiled_in), ("DEPENDS_ON", owners(libraries_of(arguments.elf)))):
        for name, (version, source) in found.items():
            identifier = f"{relation.lower().replace('_', '-')}-{name.replace('+', 'p')}"
            packages.append(package(identifier, name, version,
                                    licence_of(name, licences) or "NOASSERTION", source))
            relationships.append(("SPDXRef-Package", relation, packages[-1]))
    document = {
        "spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT",
        "name": f"{arguments.name}-{arguments.version}",
        "creationInfo": {
            "created": datetime.datetime.fromtimestamp(arguments.date, datetime.timezone.utc)
            .strftime("%Y-%m-%dT%H:%M:%SZ"),
            "creators": ["Organization: The tofsmith authors", "Tool: make_sbom.py"]},
        "packages": packages,
        "relationships": [{"spdxElementId": of, "relationshipType": relation,
                           "relatedSpdxElement": item["SPDXID"]}
                          for of, relation, item in relationships]}
    content = hashlib.sha256(json.dumps(document, sort_keys=True).encode()).hexdigest()
    document["documentNamespace"] = f"https://tofsmith.invalid/spdx/{document['name']}-{content[:32]}"
    return document


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--name", required=True, help="of the package")
    parser.add_argument("--version", required=True)
    parser.add_argument("--component", required=True, help="core, design, .., tool or python")
    parser.add_argument("--build", required=True, type=pathlib.Path, help="directory, of Ninja")
    parser.add_argument("--date", required=True, type=int, help="seconds since 1970")
    parser.add_argument("-o", "--output", required=True, type=pathlib.Path)
    parser.add_argument("elf", nargs="*", help="what the package ships")
    arguments = parser.parse_args()
    text = json.dumps(bill_of_materials(arguments), indent=1) + "\n"
    arguments.output.write_text(text)


if __name__ == "__main__":
    main()

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""The bill of materials lists everything compiled in or linked, with versions and licences, and is
reproducible.

    sbom_test.py BUILD PROGRAM
"""

import json
import pathlib
import platform
import subprocess
import sys
import tempfile
import unittest

PROGRAM, BUILD = sys.argv.pop(), sys.argv.pop()
RELEASE = platform.freedesktop_os_release()["VERSION_CODENAME"]
MAKE = pathlib.Path(__file__).parents[2] / "cmake" / "debian" / "make_sbom.py"


class BillOfMaterials(unittest.TestCase):
    def make(self, component, *elf_files):
        with tempfile.TemporaryDirectory() as directory:
            output = pathlib.Path(directory) / "sbom.json"
            subprocess.run([sys.executable, "-B", MAKE, "--name", "p", "--version", "1-1",
                            "--component", component, "--build", BUILD, "--date", "1700000000",
                            "-o", output, *elf_files], check=True)
            return output.read_text()

    def related(self, text, relation):
        document = json.loads(text)
        by_id = {item["SPDXID"]: item for item in document["packages"]}
        return {by_id[r["relatedSpdxElement"]]["name"]: by_id[r["relatedSpdxElement"]]
                for r in document["relationships"] if r["relationshipType"] == relation}

    def test_lists_everything_compiled_in_with_version_and_licence(self):
        text = self.make("tool", PROGRAM)
        self.assertEqual(text, self.make("tool", PROGRAM))
        compiled_in = self.related(text, "CONTAINS")
        self.assertEqual(compiled_in["libcli11-dev"]["licenseDeclared"], "BSD-3-Clause")
        self.assertEqual(compiled_in["libeigen3-dev"]["licenseDeclared"], "MPL-2.0")
        self.assertRegex(" ".join(self.related(text, "DEPENDS_ON")), r"\blibzip\d")
        for item in json.loads(text)["packages"]:
            self.assertRegex(item["versionInfo"], r"^\d")
            for reference in item.get("externalRefs", []):
                self.assertIn(f"?distro={RELEASE}&", reference["referenceLocator"])

    def test_the_licence_of_every_header_is_known(self):
        for component in ("core", "gpu", "design", "io", "report", "lab", "sweep"):
            self.make(component)  # raises an error for an unknown header


unittest.main()

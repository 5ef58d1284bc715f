#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Modules of the Python package import downwards: public modules import private ones, no private
module imports a public one, no module imports the package itself, and imports form no cycle. Imports
inside functions and under TYPE_CHECKING count, too. The topmost modules are the paper's figures,
which use the package like a user, and modules run by commands.

    python_imports_test.py
"""

import ast
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = "tofsmith"
#: Compiled, or written while building.
COMPILED = {f"{PACKAGE}.{module}" for module in ("_tofsmith", "_result_fields")}
USERS = (f"{PACKAGE}.paper", f"{PACKAGE}._upload_command")


def package_sources():
    """Returns the source of each module of the package by name, such as "tofsmith._camera"."""
    sources = {}
    for path in sorted((ROOT / "python" / PACKAGE).rglob("*.py")):
        parts = path.relative_to(ROOT / "python").with_suffix("").parts
        sources[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path.read_text("utf-8")
    return sources


def imported_modules(module, source, modules):
    """Returns the modules of the package that `module` imports, each with the line of the import.
    """
    is_package = any(other.startswith(module + ".") for other in modules)
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            named = [(alias.name, None) for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            up = node.level - (1 if is_package else 0)
            parents = module.split(".")[: len(module.split(".")) - up] if node.level else []
            base = ".".join([*parents, *([node.module] if node.module else [])])
            named = [(base, alias.name) for alias in node.names]
        else:
            continue
        for base, name in named:
            inner = f"{base}.{name}"
            found = inner if name and (inner in modules or inner in COMPILED) else base
            if found.split(".")[0] == PACKAGE and found not in COMPILED:
                yield found, node.lineno


def is_private(module):
    return any(part.startswith("_") for part in module.split("."))


def upward_imports(sources):
    found = []
    for module, source in sources.items():
        if module.startswith(USERS):
            continue
        for imported, line in imported_modules(module, source, sources):
            if imported.startswith(USERS):
                found.append(f"{module}:{line}: imports {imported}, which is above all modules")
            elif imported == PACKAGE:
                found.append(f"{module}:{line}: imports the package itself")
            elif is_private(module) and not is_private(imported):
                found.append(f"{module}:{line}: a private module imports the public {imported}")
    return found


def cycle(sources):
    """Returns modules with cyclic imports, and the modules that import them."""
    imports = {module: {m for m, _ in imported_modules(module, source, sources)} & set(sources)
               for module, source in sources.items()}
    while True:  # repeatedly remove modules that import only removed ones; a cycle remains
        free = {module for module, others in imports.items() if not others & set(imports)}
        if not free:
            return sorted(imports)
        imports = {module: others for module, others in imports.items() if module not in free}


class PythonImports(unittest.TestCase):
    def test_no_module_imports_upwards(self):
        sources = package_sources()
        self.assertGreater(len(sources), 10)
        self.assertEqual(upward_imports(sources), [])

    def test_imports_form_no_cycle(self):
        self.assertEqual(cycle(package_sources()), [])

    def test_detects_violations(self):
        for text in ("from . import plot", "from .plot import waveforms", "import tofsmith.plot",
                     "def f():\n    from . import plot", "from . import Camera", "import tofsmith",
                     "if TYPE_CHECKING:\n    from tofsmith import plot"):
            sources = {"tofsmith": "", "tofsmith._a": text, "tofsmith.plot": ""}
            self.assertEqual(len(upward_imports(sources)), 1, text)
        sources = {"tofsmith": "from ._a import b\nfrom . import _tofsmith",
                   "tofsmith._a": "import os\nfrom . import _tofsmith\nfrom ._b import c",
                   "tofsmith._b": "'''\nfrom . import plot\n'''",
                   "tofsmith.plot": "from . import _b", "tofsmith.sub": "from . import inner",
                   "tofsmith.sub.inner": "from .. import _b"}
        self.assertEqual(upward_imports(sources), [])
        self.assertEqual(cycle(sources), [])
        sources["tofsmith._b"] = "def f():\n    from ._a import b"
        self.assertEqual(cycle(sources), ["tofsmith", "tofsmith._a", "tofsmith._b",
                                          "tofsmith.plot", "tofsmith.sub", "tofsmith.sub.inner"])


if __name__ == "__main__":
    unittest.main()

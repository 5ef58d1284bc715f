# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""A missing component is reported with its Debian package."""

import subprocess
import sys

from tofsmith import _components


def test_a_missing_library_is_reported_with_its_package():
    loader = "libtofsmith_lab.so.0.1: cannot open shared object file: No such file or directory"
    said = str(_components.explained(ImportError(loader, name="_tofsmith")))
    assert "component lab, which is not installed" in said
    assert "apt install libtofsmith-lab0.1 " in said
    assert loader in said


def test_other_errors_are_unchanged():
    error = ImportError("libembree3.so.3: cannot open shared object file")
    assert _components.explained(error) is error


def test_the_package_does_not_need_torch():
    hidden = ("import sys; import tofsmith; assert 'torch' not in sys.modules\n"
              "sys.modules['torch'] = None\n"
              "try: import tofsmith.torch\n"
              "except ImportError as error: print(error)")
    done = subprocess.run([sys.executable, "-B", "-c", hidden], capture_output=True, text=True)
    assert "apt install python3-torch" in done.stdout, done.stderr

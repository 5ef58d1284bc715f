# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Loads the compiled part; says which Debian package to install if a component's library is missing.

Imported before everything that uses the compiled part.
"""

import re


def explained(error: ImportError) -> ImportError:
    """The error, with the package that has the library it misses."""
    missing = re.match(r"libtofsmith_(\w+)\.so\.([\d.]+): cannot open", str(error))
    if missing is None:
        return error
    component, version = missing.groups()
    return ImportError(
        f"tofsmith needs its component {component}, which is not installed. On Debian: "
        f"apt install libtofsmith-{component}{version} ({error})",
        name=error.name, path=error.path)


try:
    from . import _tofsmith as _tofsmith
except ImportError as error:
    raise explained(error) from error

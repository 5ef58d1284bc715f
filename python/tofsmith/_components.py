# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Loads the compiled module. If a library is missing, the error names its Debian package.

Imported before all modules that use the compiled module.
"""

import re


def explained(error: ImportError) -> ImportError:
    """Adds the package with the missing library to an import error."""
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

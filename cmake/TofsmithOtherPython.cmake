# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# Finds the headers of a Python version that this system cannot run, in TOFSMITH_PYTHON_ROOT, for
# scripts/wheel.sh. The extension links against no Python library, so headers are enough. Included
# from cmake/TofsmithDependencies.cmake.

file(GLOB Python_INCLUDE_DIR "${TOFSMITH_PYTHON_ROOT}/usr/include/python3.*")
find_package(Python 3.11 COMPONENTS Development.Module)
set(pybind11_DIR "${TOFSMITH_PYTHON_ROOT}/usr/lib/cmake/pybind11")
# pybind11 would query the interpreter for these.
set(PYTHON_MODULE_EXTENSION
    ".cpython-${Python_VERSION_MAJOR}${Python_VERSION_MINOR}-${CMAKE_LIBRARY_ARCHITECTURE}.so")
set(PYTHON_MODULE_DEBUG_POSTFIX "")
set(PYTHON_IS_DEBUG OFF)

# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# All dependencies are Debian packages, listed in scripts/packages.sh.

# Finds the dependencies of each component. cmake/TofsmithInstall.cmake writes
# tofsmith<Component>Dependencies.cmake, which finds the ones that users of a component need.

if(EMSCRIPTEN)
  include(TofsmithWasm)
  return()
endif()

# core
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(HWY REQUIRED)
find_path(HWY_INCLUDE_DIR hwy/detect_targets.h REQUIRED)
find_package(fmt REQUIRED)
find_path(RANDOM123_INCLUDE_DIR Random123/philox.h REQUIRED)
set(TOFSMITH_HAS_TBB OFF)
if(TOFSMITH_USE_TBB STREQUAL "AUTO")
  find_package(TBB)
elseif(TOFSMITH_USE_TBB)
  find_package(TBB REQUIRED)
endif()
if(TOFSMITH_USE_TBB AND TBB_FOUND)
  set(TOFSMITH_HAS_TBB ON)
else()
  message(STATUS "Without TBB: all work is done in one thread")
endif()
if(TOFSMITH_USE_FFTW OR TOFSMITH_HAS_io)
  find_package(PkgConfig REQUIRED)
endif()
if(TOFSMITH_USE_FFTW)
  pkg_check_modules(FFTW REQUIRED IMPORTED_TARGET fftw3)
  find_library(FFTW_THREADS_LIBRARY fftw3_threads REQUIRED)  # its planner is thread-safe
endif()

if(TOFSMITH_HAS_io OR TOFSMITH_BUILD_TESTS)
  find_package(nlohmann_json REQUIRED)
endif()
if(TOFSMITH_HAS_io)
  find_package(tomlplusplus REQUIRED)
  find_package(OpenEXR REQUIRED)
  find_package(PNG REQUIRED)
  find_package(ZLIB REQUIRED)
  find_package(embree 4 QUIET)
  if(NOT embree_FOUND)
    find_package(embree 3.13 REQUIRED)
  endif()
  find_package(TBB REQUIRED)  # Embree's threads
  pkg_check_modules(LIBZIP REQUIRED IMPORTED_TARGET libzip)
  pkg_check_modules(YAML_CPP REQUIRED IMPORTED_TARGET yaml-cpp)
  pkg_check_modules(HDF5 REQUIRED IMPORTED_TARGET hdf5-serial)  # without MPI
endif()

set(TOFSMITH_HAS_OPENCL OFF)
if(TOFSMITH_HAS_gpu)
  if(TOFSMITH_USE_OPENCL STREQUAL "AUTO")
    find_package(OpenCL)
  elseif(TOFSMITH_USE_OPENCL)
    find_package(OpenCL REQUIRED)
  endif()
  if(TOFSMITH_USE_OPENCL AND OpenCL_FOUND)
    set(TOFSMITH_HAS_OPENCL ON)
  else()
    message(STATUS "Without OpenCL: no device but the processor decodes")
  endif()
endif()

if(TOFSMITH_HAS_lab)
  pkg_check_modules(LIBMD REQUIRED IMPORTED_TARGET libmd)  # SHA-256
endif()

if(TOFSMITH_HAS_report)
  find_package(ZLIB REQUIRED)
endif()

if(TOFSMITH_HAS_sweep)
  find_package(SQLite3 REQUIRED)
endif()

if(TOFSMITH_BUILD_APPS OR TOFSMITH_BUILD_BENCHMARKS)
  find_package(CLI11 REQUIRED)
endif()
if(TOFSMITH_BUILD_TESTS)
  find_package(GTest REQUIRED)
endif()
if(TOFSMITH_BUILD_PYTHON)
  # Debian's Python, which its packages need: another python3 may be first on PATH. pip passes the
  # interpreter it installs for.
  set(Python_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "The python3 to build the package for")
  set(TOFSMITH_PYTHON_ROOT "" CACHE PATH
      "Unpacked Debian packages with the headers of another python3 and its pybind11, to build for")
  if(TOFSMITH_PYTHON_ROOT)
    # The extension links against no Python library, so headers are enough.
    file(GLOB Python_INCLUDE_DIR "${TOFSMITH_PYTHON_ROOT}/usr/include/python3.*")
    find_package(Python 3.11 COMPONENTS Development.Module)
    set(pybind11_DIR "${TOFSMITH_PYTHON_ROOT}/usr/lib/cmake/pybind11")
    # pybind11 would query the interpreter for these.
    set(PYTHON_MODULE_EXTENSION
        ".cpython-${Python_VERSION_MAJOR}${Python_VERSION_MINOR}-${CMAKE_LIBRARY_ARCHITECTURE}.so")
    set(PYTHON_MODULE_DEBUG_POSTFIX "")
    set(PYTHON_IS_DEBUG OFF)
  else()
    find_package(Python 3.11 COMPONENTS Interpreter Development.Module NumPy)
  endif()
  if(Python_FOUND)
    find_package(pybind11)
  endif()
  if(NOT Python_FOUND OR NOT pybind11_FOUND)
    set(consequence WARNING "The Python package is not built")
    if(TOFSMITH_BUILD_PYTHON STREQUAL "REQUIRED")  # for pip and packages
      set(consequence FATAL_ERROR "The Python package cannot be built")
    endif()
    set(missing pybind11-dev)
    if(NOT Python_FOUND)
      set(missing "python3-dev and python3-numpy for ${Python_EXECUTABLE}")
    endif()
    message(${consequence} ": ${missing} is missing. It needs pybind11-dev, python3-dev and "
                           "python3-numpy: scripts/packages.sh python")
    set(TOFSMITH_BUILD_PYTHON OFF)
  endif()
endif()

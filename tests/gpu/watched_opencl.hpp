// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

#include <limits>

namespace tofsmith {

/// OpenCL calls that work on a device. Replacements of the loader's functions return an error on
/// request of a test.
struct Failure {
  int first = std::numeric_limits<int>::max();  ///< first failing call
  int last = std::numeric_limits<int>::max();
  cl_int error = CL_SUCCESS;
  int calls = 0;

  cl_int next() {
    const int call = calls++;
    return call >= first && call <= last ? error : CL_SUCCESS;
  }
};
inline Failure failure;

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

#include <limits>

namespace tofsmith {

/// Calls of OpenCL that work on a device. Functions stand in front of the loader's own, and give an
/// error where a test says so.
struct Failure {
  int first = std::numeric_limits<int>::max();  ///< of those that fail
  int last = std::numeric_limits<int>::max();
  cl_int error = CL_SUCCESS;
  int calls = 0;

  /// The error of the next call.
  cl_int next() {
    const int call = calls++;
    return call >= first && call <= last ? error : CL_SUCCESS;
  }
};
inline Failure failure;

}  // namespace tofsmith

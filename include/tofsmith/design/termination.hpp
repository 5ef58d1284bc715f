// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace tofsmith {

/// Why an iterative method ended.
enum class Termination {
  not_run,          ///< nothing was computed; a result starts this way
  converged,        ///< the method's own test of optimality holds
  stalled,          ///< rounding keeps the method from any further progress
  iteration_limit,  ///< the allowed iterations are used up
};

/// The enumerator's name.
std::string_view to_string(Termination termination);

}  // namespace tofsmith

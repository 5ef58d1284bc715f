// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/design/termination.hpp"

namespace tofsmith {

std::string_view to_string(Termination termination) {
  switch (termination) {
    case Termination::not_run:
      return "not_run";
    case Termination::converged:
      return "converged";
    case Termination::stalled:
      return "stalled";
    case Termination::iteration_limit:
      return "iteration_limit";
  }
  return "unknown";
}

}  // namespace tofsmith

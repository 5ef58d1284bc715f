// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/depth_error_text.hpp"

#include <fmt/format.h>

namespace tofsmith {

std::string exposures_by_taps(const DepthErrorReport& error) {
  return fmt::format("{} x {}", error.exposures, error.taps);
}

}  // namespace tofsmith

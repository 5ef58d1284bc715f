// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/depth_error_text.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tofsmith {

std::string exposures_by_taps(const DepthErrorReport& error) {
  const int per_exposure = error.measurements / std::max(1, error.exposures);
  return fmt::format("{} x {}", error.exposures, per_exposure);
}

}  // namespace tofsmith

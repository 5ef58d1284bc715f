// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "tofsmith/core/units.hpp"

namespace tofsmith {

/// Formats as 100, 3.16k, 100k, 17M.
inline std::string level_text(double electrons_per_s) {
  if (electrons_per_s >= 1e6) return fmt::format("{:.3g}M", electrons_per_s / 1e6);
  if (electrons_per_s >= 1e3) return fmt::format("{:.3g}k", electrons_per_s / 1e3);
  return fmt::format("{:.3g}", electrons_per_s);
}

/// Formats in mm; "" if not finite.
inline std::string mm_text(double metres) {
  return std::isfinite(metres) ? fmt::format("{:.1f}", 1e3 * metres) : "";
}

}  // namespace tofsmith

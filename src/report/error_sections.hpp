// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tofsmith/core/units.hpp"
#include "tofsmith/report/page.hpp"
#include "tofsmith/simulate/depth_error.hpp"

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

struct DepthErrorRow {
  const DepthErrorReport* error = nullptr;
  std::string method;
  std::optional<Estimate> ratio = {};
};

/// @param best  index of the best code
/// @param with_curves  include error_by_signal()
Section depth_error_section(const Camera& camera, std::span<const DepthErrorRow> codes,
                            std::size_t best, bool with_curves);

/// Circular error versus signal at the middle ambient level, with the bounds of the first code.
Figure error_by_signal(const std::string& id, const Camera& camera,
                       std::span<const DepthErrorRow> codes);

}  // namespace tofsmith

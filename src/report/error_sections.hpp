// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tofsmith/report/page.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

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

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "tofsmith/report/page.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

/// A row of the comparison.
struct DepthErrorRow {
  const DepthErrorReport* error = nullptr;
  std::string method;
};

/// Figures and table that compare codes by depth error, best first.
/// @param best  index of the code to stress
Section depth_error_section(const Camera& camera, std::span<const DepthErrorRow> codes,
                            std::size_t best);

}  // namespace tofsmith

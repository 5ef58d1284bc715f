// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>

namespace tofsmith {

/// "[1, 2.5]".
template <typename Number>
std::string list_text(const std::vector<Number>& values) {
  return fmt::format("[{}]", fmt::join(values, ", "));
}

}  // namespace tofsmith

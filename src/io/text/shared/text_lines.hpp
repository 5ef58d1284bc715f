// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace tofsmith {

struct TextLine {
  std::size_t number;  ///< counted from 1
  std::string_view text;
};

/// Skips empty lines, comments, which begin with '#', and a byte order mark.
std::vector<TextLine> content_lines(std::string_view text);

/// Ignores surrounding blanks.
std::optional<double> finite_number_in(std::string_view text);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/text/shared/text_lines.hpp"

#include <algorithm>
#include <cmath>

#include "core/shared/text_numbers.hpp"
#include "tofsmith/io/csv.hpp"

namespace tofsmith {

std::vector<TextLine> content_lines(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // byte order mark
  const char line_end = text.find('\n') == std::string_view::npos ? '\r' : '\n';
  std::vector<TextLine> lines;
  std::size_t number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(line_end, begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    begin = end + 1;
    ++number;
    const std::string_view content = trimmed(line);
    if (!content.empty() && !content.starts_with('#')) lines.push_back({number, line});
  }
  return lines;
}

std::optional<double> finite_number_in(std::string_view text) {
  const std::optional<double> number = number_in(trimmed(text));
  return number && std::isfinite(*number) ? number : std::nullopt;
}

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\n\r") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace tofsmith

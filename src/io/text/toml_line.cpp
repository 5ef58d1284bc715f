// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cmath>

#include "io/text/shared/table_reader.hpp"

namespace tofsmith {

SettingValue toml_value_of_line(const std::string& line, std::string place) {
  double number = 0.0;
  const char* const end = line.data() + line.size();
  const auto [stopped, error] = std::from_chars(line.data(), end, number);
  if (error == std::errc() && stopped == end && std::isfinite(number))
    return {line, line, number, std::move(place)};
  if (line == "true" || line == "false") return {line, line, {}, std::move(place)};
  return toml_value_of(toml::value<std::string>(line), std::move(place));
}

}  // namespace tofsmith

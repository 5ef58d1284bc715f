// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace tofsmith {

/// Matches "SOUR@:VOLT " with a digit for @; gives it, and the rest of the message.
inline bool matches(std::string_view message, std::string_view pattern, int& number,
                    std::string& rest) {
  if (message.size() < pattern.size()) return false;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (pattern[i] == '@') {
      if (message[i] != '1' && message[i] != '2') return false;
      number = message[i] - '0';
    } else if (message[i] != pattern[i]) {
      return false;
    }
  }
  rest = message.substr(pattern.size());
  return true;
}

inline std::string unquoted(std::string text) {
  std::erase(text, '"');
  return text;
}

inline int word_at(const std::string& points, std::size_t i, bool high_first) {
  const auto a = static_cast<unsigned char>(points[2 * i]),
             b = static_cast<unsigned char>(points[2 * i + 1]);
  return high_first ? a << 8 | b : b << 8 | a;
}

inline int as_signed(int word) { return word >= 32768 ? word - 65536 : word; }

}  // namespace tofsmith

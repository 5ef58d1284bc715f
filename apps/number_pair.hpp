// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "session.hpp"

namespace tofsmith::apps {

/// Reads two numbers parted by a character, such as "3/8" or "1e3:1e5"; whether the text holds
/// them.
template <typename Number>
bool read_number_pair(const std::string& text, char separator, Number& first, Number& second) {
  const std::size_t at = text.find(separator);
  return at != std::string::npos && CLI::detail::lexical_cast(text.substr(0, at), first) &&
         CLI::detail::lexical_cast(text.substr(at + 1), second);
}

}  // namespace tofsmith::apps

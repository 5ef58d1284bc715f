// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "printed_text.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <iterator>

namespace tofsmith::apps {

namespace {

/// Returns the number of bytes of the first character of a text; 0 if it is not valid UTF-8 (RFC
/// 3629).
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(0) < 0x80) return 1;
  const std::size_t length = byte(0) >= 0xf0 ? 4 : byte(0) >= 0xe0 ? 3 : byte(0) >= 0xc2 ? 2 : 0;
  if (length == 0 || byte(0) > 0xf4 || text.size() < length) return 0;
  std::uint32_t code = byte(0) & (0xffu >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
    code = code << 6 | (byte(i) & 0x3fu);
  }
  constexpr std::uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xd800 && code < 0xe000;
  return code >= least[length] && code <= 0x10ffff && !is_surrogate ? length : 0;
}

bool is_control(std::string_view character) {
  const auto first = static_cast<unsigned char>(character[0]);
  if (character.size() == 1)
    return (first < ' ' && first != '\n' && first != '\t') || first == 0x7f;
  return first == 0xc2 && static_cast<unsigned char>(character[1]) < 0xa0;
}

}  // namespace

std::string printed(std::string_view message, std::size_t longest) {
  std::string text;
  for (std::size_t at = 0; at < message.size();) {
    if (text.size() > longest) return text + fmt::format(" ... ({} bytes)", message.size());
    const std::size_t length = utf8_length(message.substr(at));
    if (length == 0 || is_control(message.substr(at, length))) {
      fmt::format_to(std::back_inserter(text), "\\x{:02x}",
                     static_cast<unsigned char>(message[at]));
      ++at;
    } else {
      text += message.substr(at, length);
      at += length;
    }
  }
  return text;
}

}  // namespace tofsmith::apps

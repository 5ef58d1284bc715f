// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "waveforms/shared/ieee488_block.hpp"

#include <fmt/format.h>

#include "io/shared/byte_cursor.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

std::vector<std::byte> ieee488_block(std::span<const std::byte> data) {
  require(data.size() <= 999'999'999, "block bytes", data.size(), "must be <= 999999999");
  const std::string length = fmt::format("{}", data.size());
  const std::string header = fmt::format("#{}{}", length.size(), length);
  const auto begin = std::as_bytes(std::span(header));
  std::vector<std::byte> block(begin.begin(), begin.end());
  block.insert(block.end(), data.begin(), data.end());
  return block;
}

Ieee488Block parse_ieee488_block(std::span<const std::byte> bytes, std::string_view place) {
  ByteCursor cursor(bytes, place);
  if (cursor.take_text(1, "a block's #") != "#")
    cursor.fail_at(0, "found no '#'; expected a block of IEEE 488.2");
  const char digits = cursor.take_text(1, "a block's number of digits").front();
  if (digits < '1' || digits > '9')
    cursor.fail_at(
        1, fmt::format("found '{}'; expected the number of digits of the length, 1 to 9", digits));
  std::size_t length = 0;
  for (const char digit : cursor.take_text(static_cast<std::size_t>(digits - '0'), "the length")) {
    if (digit < '0' || digit > '9')
      cursor.fail_at(2, fmt::format("found '{}' in the length; expected digits", digit));
    length = 10 * length + static_cast<std::size_t>(digit - '0');
  }
  const auto data = cursor.take(length, "the block's data");
  return {data, cursor.position()};
}

}  // namespace tofsmith

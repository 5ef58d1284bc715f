// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/byte_cursor.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/shared/byte_order.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

std::span<const std::byte> ByteCursor::take(std::size_t count, std::string_view what) {
  const auto left = rest();
  if (left.size() < count)
    fail_at(bytes_.size(), fmt::format("the file ends here; expected {} more bytes of {}",
                                       count - left.size(), what));
  position_ += count;
  return left.first(count);
}

std::string_view ByteCursor::take_text(std::size_t count, std::string_view what) {
  const auto bytes = take(count, what);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string_view ByteCursor::take_until(char end, std::string_view what) {
  const auto left = rest();
  const std::string_view text(reinterpret_cast<const char*>(left.data()), left.size());
  const std::size_t length = text.find(end);
  if (length == std::string_view::npos)
    fail_at(bytes_.size(), fmt::format("the file ends here; expected the end of {}", what));
  position_ += length + 1;
  return text.substr(0, length);
}

std::uint16_t ByteCursor::take_u16_little(std::string_view what) {
  return load_little_endian<std::uint16_t>(take(2, what).data());
}

std::uint32_t ByteCursor::take_u32_little(std::string_view what) {
  return load_little_endian<std::uint32_t>(take(4, what).data());
}

void ByteCursor::fail_at(std::size_t position, std::string_view problem) const {
  throw IoError(fmt::format("{}: byte {}", file_, position), problem);
}

void swap_byte_order(std::span<std::byte> bytes, std::size_t item_size) {
  if (item_size < 2) return;
  for (auto item = bytes.begin(); item != bytes.end(); item += item_size)
    std::reverse(item, item + item_size);
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "io/image_limits.hpp"
#include "io/images/grey_image.hpp"
#include "io/images/netpbm_words.hpp"
#include "io/shared/byte_order.hpp"

namespace tofsmith {
namespace {

/// One byte per number, or two in big-endian order.
void take_binary(ByteCursor& cursor, NpyArray& image) {
  const auto found = cursor.rest();
  if (found.size() != image.bytes().size())
    cursor.fail(fmt::format("found {} bytes of data; expected {} for shape {} of {}", found.size(),
                            image.bytes().size(), describe_shape(image.shape()),
                            name_of(image.type())));
  std::copy(found.begin(), found.end(), image.bytes().begin());
  if (host_is_little_endian) swap_byte_order(image.bytes(), item_size(image.type()));
}

void take_text(ByteCursor& cursor, NpyArray& image, unsigned max_value) {
  for (std::size_t i = 0; i < image.size(); ++i) {
    const auto number = take_number<unsigned>(cursor, "the number of a pixel");
    if (number > max_value)
      cursor.fail(fmt::format("found {}; expected at most {}", number, max_value));
    const auto value = static_cast<std::uint16_t>(number);
    if (image.type() == NpyType::uint8)
      image.bytes()[i] = static_cast<std::byte>(value);
    else
      std::memcpy(image.bytes().data() + i * sizeof(value), &value, sizeof(value));
  }
}

}  // namespace

NpyArray parse_pgm(std::span<const std::byte> content, std::string_view file) {
  ByteCursor cursor(content, file);
  const std::string_view magic = take_word(cursor, "the PGM magic");
  if (magic != "P5" && magic != "P2")
    cursor.fail_at(0, "found no PGM magic; expected P5 (binary) or P2 (text)");
  const auto width = take_number<std::uint32_t>(cursor, "the width in pixels");
  const auto height = take_number<std::uint32_t>(cursor, "the height in pixels");
  check_image_size(file, height, width);
  const auto max_value = take_number<unsigned>(cursor, "the largest number, 1 to 65535");
  if (max_value < 1 || max_value > 65535)
    cursor.fail(fmt::format("found {} as the largest number; expected 1 to 65535", max_value));
  if (std::uint64_t{width} * height > cursor.rest().size())
    cursor.fail(fmt::format("found {} bytes of data; expected numbers of {} x {} pixels",
                            cursor.rest().size(), height, width));
  NpyArray image(max_value < 256 ? NpyType::uint8 : NpyType::uint16, {height, width});
  magic == "P5" ? take_binary(cursor, image) : take_text(cursor, image, max_value);
  return image;
}

}  // namespace tofsmith

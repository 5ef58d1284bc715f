// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/images/netpbm.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

#include "io/byte_cursor.hpp"
#include "io/image_limits.hpp"
#include "io/images/array_image.hpp"
#include "io/shared/byte_order.hpp"
#include "io/shared/read_file.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

bool is_space(std::byte byte) {
  const char c = std::to_integer<char>(byte);
  return c == ' ' || c == '\n' || c == '\r' || c == '\t';
}

/// Returns the next word and skips the single white space that ends it. Comments extend from # to
/// the end of the line.
std::string_view take_word(ByteCursor& cursor, std::string_view what) {
  constexpr std::size_t longest = 64;
  while (!cursor.at_end()) {
    if (cursor.rest()[0] == std::byte{'#'})
      cursor.take_until('\n', "the end of a comment");
    else if (is_space(cursor.rest()[0]))
      cursor.take(1, what);
    else
      break;
  }
  std::size_t length = 0;
  while (length < cursor.rest().size() && length <= longest && !is_space(cursor.rest()[length]))
    ++length;
  if (length > longest) cursor.fail(fmt::format("expected {}", what));
  const std::string_view word = cursor.take_text(length, what);
  if (!cursor.at_end()) cursor.take(1, what);
  return word;
}

template <typename Number>
Number take_parsed(ByteCursor& cursor, std::string_view what) {
  const std::string_view word = take_word(cursor, what);
  Number number{};
  const char* end = word.data() + word.size();
  const auto result = std::from_chars(word.data(), end, number);
  if (result.ec != std::errc() || result.ptr != end)
    cursor.fail(fmt::format("the file is malformed before here; expected {}", what));
  return number;
}

std::size_t row_bytes(const PfmImage& image) {
  return static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels) *
         sizeof(float);
}

void copy_flipped(const std::byte* from, std::byte* to, std::size_t rows, std::size_t row_bytes) {
  for (std::size_t row = 0; row < rows; ++row)
    std::memcpy(to + row * row_bytes, from + (rows - 1 - row) * row_bytes, row_bytes);
}

}  // namespace

PfmImage parse_pfm(std::span<const std::byte> content, std::string_view file) {
  ByteCursor cursor(content, file);
  PfmImage image;
  const std::string_view magic = cursor.take_text(2, "the PFM magic");
  if (magic != "PF" && magic != "Pf")
    cursor.fail_at(0, "found no PFM magic; expected 'Pf' (grey) or 'PF' (colour)");
  image.channels = magic == "PF" ? 3 : 1;
  if (!cursor.at_end() && !is_space(cursor.rest()[0]))
    cursor.fail("expected a line break after the PFM magic");
  const auto width = take_parsed<std::uint32_t>(cursor, "the width in pixels");
  const auto height = take_parsed<std::uint32_t>(cursor, "the height in pixels");
  check_image_size(file, height, width);
  image.width = static_cast<int>(width);
  image.height = static_cast<int>(height);
  const double scale = take_parsed<double>(cursor, "the scale, negative for little endian");
  if (!std::isfinite(scale) || scale == 0.0) cursor.fail("expected a finite scale that is not 0");
  image.scale = std::abs(scale);

  const std::size_t expected = row_bytes(image) * height;
  if (cursor.rest().size() != expected)
    cursor.fail(fmt::format("found {} bytes of data; expected {} for {} x {} pixels of {} floats",
                            cursor.rest().size(), expected, height, width, image.channels));
  image.values.resize(expected / sizeof(float));
  auto* values = reinterpret_cast<std::byte*>(image.values.data());
  copy_flipped(cursor.rest().data(), values, height, row_bytes(image));
  const bool little_endian = scale < 0.0;
  if (little_endian != host_is_little_endian) swap_byte_order({values, expected}, sizeof(float));
  return image;
}

PfmImage read_pfm(const std::filesystem::path& path) {
  return parse_pfm(read_binary_file(path), path.string());
}

std::vector<std::byte> serialize_pfm(const PfmImage& image) {
  require(image.height >= 1, "height", image.height, "must be >= 1");
  require(image.width >= 1, "width", image.width, "must be >= 1");
  require(image.channels == 1 || image.channels == 3, "channels", image.channels, "must be 1 or 3");
  require(std::isfinite(image.scale) && image.scale > 0.0, "scale", image.scale,
          "must be finite and > 0");
  const std::size_t bytes = row_bytes(image) * static_cast<std::size_t>(image.height);
  require(image.values.size() * sizeof(float) == bytes, "number of values", image.values.size(),
          fmt::format("must be height x width x channels = {}", bytes / sizeof(float)));

  const std::string header = fmt::format("{}\n{} {}\n{}\n", image.channels == 3 ? "PF" : "Pf",
                                         image.width, image.height, -image.scale);
  std::vector<std::byte> content(header.size() + bytes);
  std::memcpy(content.data(), header.data(), header.size());
  const auto data = std::span(content).subspan(header.size());
  copy_flipped(reinterpret_cast<const std::byte*>(image.values.data()), data.data(),
               static_cast<std::size_t>(image.height), row_bytes(image));
  if (!host_is_little_endian) swap_byte_order(data, sizeof(float));
  return content;
}

void write_pfm(const std::filesystem::path& path, const PfmImage& image, OutputPolicy policy) {
  write_file_atomically(path, serialize_pfm(image), policy);
}

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
    const auto number = take_parsed<unsigned>(cursor, "the number of a pixel");
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
  const auto width = take_parsed<std::uint32_t>(cursor, "the width in pixels");
  const auto height = take_parsed<std::uint32_t>(cursor, "the height in pixels");
  check_image_size(file, height, width);
  const auto max_value = take_parsed<unsigned>(cursor, "the largest number, 1 to 65535");
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

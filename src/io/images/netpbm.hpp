// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <charconv>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "io/byte_cursor.hpp"
#include "tofsmith/io/atomic_file.hpp"

namespace tofsmith {

inline bool is_space(std::byte byte) {
  const char c = std::to_integer<char>(byte);
  return c == ' ' || c == '\n' || c == '\r' || c == '\t';
}

/// Returns the next word and skips the single white space that ends it. Comments extend from # to
/// the end of the line.
inline std::string_view take_word(ByteCursor& cursor, std::string_view what) {
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
Number take_number(ByteCursor& cursor, std::string_view what) {
  const std::string_view word = take_word(cursor, what);
  Number number{};
  const char* end = word.data() + word.size();
  const auto result = std::from_chars(word.data(), end, number);
  if (result.ec != std::errc() || result.ptr != end)
    cursor.fail(fmt::format("the file is malformed before here; expected {}", what));
  return number;
}

/// (H, W, C), last axis fastest, top row first (files have the bottom row first).
struct PfmImage {
  int height = 0;
  int width = 0;
  int channels = 1;  ///< 1 grey, 3 RGB
  /// Absolute scale in the header; not applied, because programs disagree on its meaning.
  double scale = 1.0;
  std::vector<float> values;
};

/// @param file  name for error messages
/// @throws IoError if the header is malformed, the length of the data differs from it, or the image
///   exceeds the limits of image_limits.hpp
PfmImage parse_pfm(std::span<const std::byte> content, std::string_view file);
PfmImage read_pfm(const std::filesystem::path& path);

enum class PfmByteOrder { little_endian, big_endian };

/// @throws std::invalid_argument if a member is out of range
std::vector<std::byte> serialize_pfm(const PfmImage& image,
                                     PfmByteOrder order = PfmByteOrder::little_endian);
void write_pfm(const std::filesystem::path& path, const PfmImage& image, OutputPolicy policy);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "io/image_limits.hpp"
#include "io/images/array_image.hpp"
#include "io/shared/byte_order.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

using Bytes = std::span<const std::byte>;

// See the TIFF 6.0 specification.
enum class Tag : std::uint16_t {
  image_width = 256,
  image_length = 257,
  bits_per_sample = 258,
  compression = 259,
  photometric = 262,
  strip_offsets = 273,
  samples_per_pixel = 277,
  rows_per_strip = 278,
  strip_byte_counts = 279,
  predictor = 317,
  tile_width = 322,
  tile_length = 323,
  tile_offsets = 324,
  tile_byte_counts = 325,
  sample_format = 339,
};

unsigned byte_at(Bytes bytes, std::size_t at) { return std::to_integer<unsigned>(bytes[at]); }

/// PackBits, Section 9. @return at most `size` bytes
std::vector<std::byte> unpack_bits(Bytes packed, std::size_t size) {
  std::vector<std::byte> out;
  for (std::size_t at = 0; at < packed.size() && out.size() < size;) {
    const unsigned head = byte_at(packed, at++);
    if (head < 128) {
      const std::size_t count = std::min<std::size_t>(head + 1, packed.size() - at);
      out.insert(out.end(), packed.begin() + static_cast<std::ptrdiff_t>(at),
                 packed.begin() + static_cast<std::ptrdiff_t>(at + count));
      at += count;
    } else if (head > 128 && at < packed.size()) {
      out.insert(out.end(), 257 - head, packed[at++]);
    }
  }
  return out;
}

/// LZW, Section 13. @return at most `size` bytes plus the rest of the last string
std::vector<std::byte> unpack_lzw(Bytes packed, std::size_t size) {
  constexpr unsigned clear = 256, end = 257, first = 258, most = 4096;
  // A string is a range of the output.
  std::array<std::size_t, most> start{}, length{};
  std::vector<std::byte> out;
  std::size_t at = 0, last_start = 0, last_length = 0;
  unsigned next = first, width = 9, held = 0, bits = 0;
  while (out.size() < size) {
    for (; bits < width; bits += 8) {
      if (at == packed.size()) return out;
      held = held << 8 | byte_at(packed, at++);
    }
    bits -= width;
    const unsigned code = held >> bits & ((1U << width) - 1);
    if (code == end) return out;
    if (code == clear) {
      next = first;
      width = 9;
      last_length = 0;
      continue;
    }
    if (code > next || (code == next && last_length == 0)) return out;  // damaged
    if (last_length > 0 && next < most) {
      start[next] = last_start;
      length[next++] = last_length + 1;
    }
    last_start = out.size();
    last_length = code < clear ? 1 : length[code];
    if (code < clear) out.push_back(static_cast<std::byte>(code));
    for (std::size_t i = 0; code > end && i < last_length; ++i) out.push_back(out[start[code] + i]);
    // The code width increases one code early.
    while (width < 12 && next + 1 >= 1U << width) ++width;
  }
  return out;
}

std::vector<std::byte> unpack_deflate(Bytes packed, std::size_t size) {
  std::vector<std::byte> out(size);
  uLongf count = size;
  const int result = uncompress(reinterpret_cast<Bytef*>(out.data()), &count,
                                reinterpret_cast<const Bytef*>(packed.data()), packed.size());
  out.resize(result == Z_OK ? count : 0);
  return out;
}

std::optional<NpyType> type_of(unsigned format, unsigned bits) {
  struct Entry {
    unsigned format, bits;
    NpyType type;
  };
  constexpr Entry types[] = {
      {1, 8, NpyType::uint8},    {1, 16, NpyType::uint16},  {1, 32, NpyType::uint32},
      {2, 8, NpyType::int8},     {2, 16, NpyType::int16},   {2, 32, NpyType::int32},
      {3, 16, NpyType::float16}, {3, 32, NpyType::float32}, {3, 64, NpyType::float64}};
  for (const Entry& entry : types)
    if (entry.format == format && entry.bits == bits) return entry.type;
  return std::nullopt;
}

template <typename Number>
void add_up(std::span<std::byte> bytes, std::size_t row_numbers) {
  for (std::size_t i = 0; i * sizeof(Number) < bytes.size(); ++i) {
    std::byte* const at = bytes.data() + i * sizeof(Number);
    Number number, before;
    std::memcpy(&number, at, sizeof(Number));
    if (i % row_numbers == 0) continue;
    std::memcpy(&before, at - sizeof(Number), sizeof(Number));
    number = static_cast<Number>(number + before);
    std::memcpy(at, &number, sizeof(Number));
  }
}

class TiffImage {
 public:
  TiffImage(Bytes content, std::string_view file);
  NpyArray numbers() const;

 private:
  struct Blocks {
    bool tiled = false;
    std::size_t width = 0, height = 0;
  };

  [[noreturn]] void fail(const std::string& problem) const { throw IoError(file_, problem); }
  std::uint32_t number(std::size_t at, std::size_t bytes) const;
  void read_tag(std::size_t at);
  const std::vector<std::uint32_t>& list(Tag tag) const;
  std::uint32_t value(Tag tag, std::optional<std::uint32_t> absent = std::nullopt) const;
  NpyType type() const;
  Blocks blocks() const;
  std::vector<std::byte> unpacked(std::size_t block, std::size_t size, bool tiled) const;
  std::vector<std::byte> read_block(std::size_t block, std::size_t rows, const Blocks& all,
                                    std::size_t item) const;

  Bytes content_;
  std::string file_;
  bool big_endian_ = false;
  std::map<Tag, std::vector<std::uint32_t>> tags_;
};

TiffImage::TiffImage(Bytes content, std::string_view file) : content_(content), file_(file) {
  const std::uint32_t order = number(0, 2);
  if (order != 0x4949 && order != 0x4d4d) fail("found no TIFF magic; expected II or MM");
  big_endian_ = order == 0x4d4d;
  if (const auto version = number(2, 2); version != 42)
    fail(fmt::format("found TIFF version {}; expected 42 (43 is BigTIFF)", version));
  std::size_t at = number(4, 4);
  const std::uint32_t tags = number(at, 2);
  at += 2;
  for (std::uint32_t i = 0; i < tags; ++i, at += 12) read_tag(at);
  if (number(at, 4) != 0) fail("found several pages; expected one, a file for each image");
}

std::uint32_t TiffImage::number(std::size_t at, std::size_t bytes) const {
  if (at > content_.size() || content_.size() - at < bytes)
    fail(fmt::format("byte {}: the file ends before; expected a TIFF image", at));
  std::uint32_t result = 0;
  for (std::size_t i = 0; i < bytes; ++i)
    result = result << 8 | byte_at(content_, at + (big_endian_ ? i : bytes - 1 - i));
  return result;
}

void TiffImage::read_tag(std::size_t at) {
  const std::uint32_t type = number(at + 2, 2), count = number(at + 4, 4);
  const std::size_t bytes = type == 1 ? 1 : type == 3 ? 2 : type == 4 ? 4 : 0;
  if (bytes == 0) return;  // not an integer type
  const std::size_t values = std::uint64_t{count} * bytes <= 4 ? at + 8 : number(at + 8, 4);
  if (count > content_.size() / bytes)
    fail(fmt::format("byte {}: found a tag of {} values; expected fewer", at, count));
  auto& list = tags_[static_cast<Tag>(number(at, 2))];
  list.clear();
  for (std::size_t i = 0; i < count; ++i) list.push_back(number(values + i * bytes, bytes));
}

const std::vector<std::uint32_t>& TiffImage::list(Tag tag) const {
  const auto found = tags_.find(tag);
  if (found == tags_.end() || found->second.empty())
    fail(fmt::format("found no tag {}; expected a TIFF image", static_cast<int>(tag)));
  return found->second;
}

std::uint32_t TiffImage::value(Tag tag, std::optional<std::uint32_t> absent) const {
  return absent && !tags_.contains(tag) ? *absent : list(tag).front();
}

std::vector<std::byte> TiffImage::unpacked(std::size_t block, std::size_t size, bool tiled) const {
  const auto &offsets = list(tiled ? Tag::tile_offsets : Tag::strip_offsets),
             &counts = list(tiled ? Tag::tile_byte_counts : Tag::strip_byte_counts);
  if (block >= offsets.size() || block >= counts.size())
    fail(fmt::format("found {} strips or tiles; expected more", offsets.size()));
  if (offsets[block] > content_.size() || counts[block] > content_.size() - offsets[block])
    fail(fmt::format("the file ends before strip or tile {}", block));
  const Bytes packed = content_.subspan(offsets[block], counts[block]);
  std::vector<std::byte> bytes;
  switch (const std::uint32_t scheme = value(Tag::compression, 1)) {
    case 1:
      bytes.assign(packed.begin(), packed.end());
      break;
    case 5:
      bytes = unpack_lzw(packed, size);
      break;
    case 8:
    case 32946:
      bytes = unpack_deflate(packed, size);
      break;
    case 32773:
      bytes = unpack_bits(packed, size);
      break;
    default:
      fail(
          fmt::format("found compression {}; expected none, LZW, Deflate or PackBits (1, 5, 8, "
                      "32773)",
                      scheme));
  }
  if (bytes.size() < size)
    fail(fmt::format("strip or tile {}: found {} bytes; expected {}", block, bytes.size(), size));
  bytes.resize(size);
  return bytes;
}

NpyType TiffImage::type() const {
  if (const auto samples = value(Tag::samples_per_pixel, 1), kind = value(Tag::photometric, 1);
      samples != 1 || kind != 1)
    fail(
        fmt::format("found {} numbers per pixel and photometric interpretation {}; expected 1 "
                    "and 1, a grey image",
                    samples, kind));
  const std::uint32_t bits = value(Tag::bits_per_sample, 1), format = value(Tag::sample_format, 1);
  const std::optional<NpyType> type = type_of(format, bits);
  if (!type)
    fail(
        fmt::format("found numbers of {} bits, sample format {}; expected 8, 16 or 32 bits, or "
                    "floats",
                    bits, format));
  if (const auto kind = value(Tag::predictor, 1); kind != 1 && (kind != 2 || is_float(*type)))
    fail(fmt::format("found predictor {}; expected none, or 2 for whole numbers", kind));
  return *type;
}

TiffImage::Blocks TiffImage::blocks() const {
  Blocks all;
  all.tiled = tags_.contains(Tag::tile_offsets);
  all.width = value(all.tiled ? Tag::tile_width : Tag::image_width);
  all.height = all.tiled ? value(Tag::tile_length)
                         : std::min(value(Tag::rows_per_strip, ~0U), value(Tag::image_length));
  check_image_size(file_, all.height, all.width);
  return all;
}

std::vector<std::byte> TiffImage::read_block(std::size_t block, std::size_t rows, const Blocks& all,
                                             std::size_t item) const {
  std::vector<std::byte> bytes = unpacked(block, rows * all.width * item, all.tiled);
  if (big_endian_ == host_is_little_endian) swap_byte_order(bytes, item);
  if (value(Tag::predictor, 1) == 1) return bytes;
  if (item == 1) add_up<std::uint8_t>(bytes, all.width);
  if (item == 2) add_up<std::uint16_t>(bytes, all.width);
  if (item == 4) add_up<std::uint32_t>(bytes, all.width);
  return bytes;
}

NpyArray TiffImage::numbers() const {
  const std::size_t width = value(Tag::image_width), height = value(Tag::image_length);
  check_image_size(file_, height, width);
  constexpr std::size_t largest_ratio = 4096;  // numbers per packed byte; LZW has the largest ratio
  if (width * height / largest_ratio > content_.size())
    fail(fmt::format("found {} x {} pixels; expected fewer in a file of {} bytes", height, width,
                     content_.size()));
  NpyArray image(type(), {height, width});
  const Blocks all = blocks();
  const std::size_t item = item_size(image.type());
  std::size_t block = 0;
  for (std::size_t row = 0; row < height; row += all.height)
    for (std::size_t column = 0; column < width; column += all.width, ++block) {
      const std::size_t rows = std::min(all.height, height - row),
                        columns = std::min(all.width, width - column);
      const auto bytes = read_block(block, all.tiled ? all.height : rows, all, item);
      for (std::size_t r = 0; r < rows; ++r)
        std::memcpy(image.bytes().data() + ((row + r) * width + column) * item,
                    bytes.data() + r * all.width * item, columns * item);
    }
  return image;
}

}  // namespace

NpyArray parse_tiff(std::span<const std::byte> content, std::string_view file) {
  return TiffImage(content, file).numbers();
}

}  // namespace tofsmith

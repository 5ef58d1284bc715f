// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/image_file.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>

#include "io/byte_cursor.hpp"
#include "io/image_limits.hpp"
#include "io/shared/read_file.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

// libpng permits its error callback to throw; destructors here free its memory.
[[noreturn]] void throw_error(png_structp png, png_const_charp message) {
  throw IoError(*static_cast<const std::string*>(png_get_error_ptr(png)),
                fmt::format("damaged PNG: {}", message));
}
void ignore_warning(png_structp, png_const_charp) {}

void read_from_cursor(png_structp png, png_bytep data, png_size_t count) {
  const auto bytes = static_cast<ByteCursor*>(png_get_io_ptr(png))->take(count, "the image");
  std::copy(bytes.begin(), bytes.end(), reinterpret_cast<std::byte*>(data));
}

void append_to_vector(png_structp png, png_bytep data, png_size_t count) {
  auto& out = *static_cast<std::vector<std::byte>*>(png_get_io_ptr(png));
  const auto* bytes = reinterpret_cast<const std::byte*>(data);
  out.insert(out.end(), bytes, bytes + count);
}

template <bool reads>
class PngFile {
 public:
  explicit PngFile(std::string& file) : png_(made(&file)) {
    info_ = png_ ? png_create_info_struct(png_) : nullptr;
    if (!info_) throw std::bad_alloc();
  }
  ~PngFile() {
    if constexpr (reads)
      png_destroy_read_struct(&png_, &info_, nullptr);
    else
      png_destroy_write_struct(&png_, &info_);
  }
  PngFile(const PngFile&) = delete;
  PngFile& operator=(const PngFile&) = delete;
  png_structp png() { return png_; }
  png_infop info() { return info_; }

 private:
  static png_structp made(std::string* file) {
    const auto make = reads ? png_create_read_struct : png_create_write_struct;
    return make(PNG_LIBPNG_VER_STRING, file, throw_error, ignore_warning);
  }

  png_structp png_;
  png_infop info_;
};
using PngReader = PngFile<true>;
using PngWriter = PngFile<false>;

/// Deflate compresses by a factor of at most 1032.
void check_unpacked_size(std::size_t unpacked, std::size_t packed, std::string_view file) {
  if (unpacked / 1032 > packed)
    throw IoError(file, fmt::format("the image needs {} bytes; expected at most what a file of {} "
                                    "bytes can unpack to",
                                    unpacked, packed));
}

void check(const PngImage& image) {
  require(image.height >= 1, "height", image.height, "must be >= 1");
  require(image.width >= 1, "width", image.width, "must be >= 1");
  require(image.channels >= 1 && image.channels <= 4, "channels", image.channels,
          "must be in [1, 4]");
  require(image.bit_depth == 8 || image.bit_depth == 16, "bit_depth", image.bit_depth,
          "must be 8 or 16");
  const std::size_t expected = static_cast<std::size_t>(image.height) * image.width *
                               static_cast<std::size_t>(image.channels);
  require(image.values.size() == expected, "number of values", image.values.size(),
          fmt::format("must be height x width x channels = {}", expected));
  const auto largest = std::max_element(image.values.begin(), image.values.end());
  require(*largest <= image.max_value(), "value", *largest,
          fmt::format("must be <= {} at {} bits", image.max_value(), image.bit_depth));
}

constexpr const char* depth_kind_key = "Depth kind";

std::string depth_kind_of(png_structp png, png_infop info) {
  png_textp entries = nullptr;
  int count = 0;
  png_get_text(png, info, &entries, &count);
  for (int i = 0; i < count; ++i)
    if (std::string_view(entries[i].key) == depth_kind_key && entries[i].text)
      return entries[i].text;
  return {};
}

}  // namespace

PngImage parse_png(std::span<const std::byte> content, std::string_view file) {
  std::string name(file);
  ByteCursor cursor(content, file);
  PngReader reader(name);
  png_structp png = reader.png();
  png_set_read_fn(png, &cursor, read_from_cursor);
  png_set_user_limits(png, max_image_side, max_image_side);
  png_read_info(png, reader.info());

  PngImage image;
  image.height = static_cast<int>(png_get_image_height(png, reader.info()));
  image.width = static_cast<int>(png_get_image_width(png, reader.info()));
  check_image_size(file, static_cast<std::uint64_t>(image.height),
                   static_cast<std::uint64_t>(image.width));
  check_unpacked_size(png_get_rowbytes(png, reader.info()) * static_cast<std::size_t>(image.height),
                      content.size(), file);
  png_set_expand(png);
  png_set_interlace_handling(png);
  png_read_update_info(png, reader.info());
  image.channels = png_get_channels(png, reader.info());
  image.bit_depth = png_get_bit_depth(png, reader.info());

  const std::size_t row_bytes = png_get_rowbytes(png, reader.info());
  std::vector<png_byte> bytes(row_bytes * static_cast<std::size_t>(image.height));
  std::vector<png_bytep> rows(static_cast<std::size_t>(image.height));
  for (std::size_t row = 0; row < rows.size(); ++row) rows[row] = bytes.data() + row * row_bytes;
  png_read_image(png, rows.data());
  png_read_end(png, nullptr);

  image.depth_kind = depth_kind_of(png, reader.info());
  if (image.bit_depth == 8) {
    image.values.assign(bytes.begin(), bytes.end());
  } else {  // big endian
    image.values.resize(bytes.size() / 2);
    for (std::size_t i = 0; i < image.values.size(); ++i)
      image.values[i] = static_cast<std::uint16_t>(bytes[2 * i] << 8 | bytes[2 * i + 1]);
  }
  return image;
}

PngImage read_png(const std::filesystem::path& path) {
  return parse_png(read_binary_file(path), path.string());
}

std::vector<std::byte> serialize_png(const PngImage& image) {
  check(image);
  std::string name = "PNG image";
  std::vector<std::byte> content;
  PngWriter writer(name);
  png_structp png = writer.png();
  png_set_write_fn(png, &content, append_to_vector, nullptr);
  png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
  constexpr int kinds[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                           PNG_COLOR_TYPE_RGB_ALPHA};
  png_set_IHDR(png, writer.info(), static_cast<png_uint_32>(image.width),
               static_cast<png_uint_32>(image.height), image.bit_depth, kinds[image.channels - 1],
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  std::string text = image.depth_kind;
  if (!text.empty()) {
    std::string key = depth_kind_key;
    png_text entry{};
    entry.compression = PNG_TEXT_COMPRESSION_NONE;
    entry.key = key.data();
    entry.text = text.data();
    entry.text_length = text.size();
    png_set_text(png, writer.info(), &entry, 1);
  }
  png_write_info(png, writer.info());

  const std::size_t row_values =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
  std::vector<png_byte> row(row_values * (image.bit_depth == 16 ? 2 : 1));
  for (auto value = image.values.begin(); value != image.values.end();) {
    for (auto byte = row.begin(); byte != row.end(); ++value) {
      if (image.bit_depth == 16) *byte++ = static_cast<png_byte>(*value >> 8);
      *byte++ = static_cast<png_byte>(*value & 0xff);
    }
    png_write_row(png, row.data());
  }
  png_write_end(png, nullptr);
  return content;
}

void write_png(const std::filesystem::path& path, const PngImage& image, OutputPolicy policy) {
  AtomicFile file(path, policy);
  file.write(serialize_png(image));
  file.commit();
}

}  // namespace tofsmith

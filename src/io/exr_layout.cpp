// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/exr_layout.hpp"

#include <fmt/format.h>

#include <cstdint>

#include "io/byte_cursor.hpp"
#include "io/byte_order.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/image_limits.hpp"

// The layout is described in "OpenEXR File Layout", openexr.com.

namespace tofsmith {
namespace {

constexpr std::uint32_t magic = 20000630;
constexpr std::uint32_t version_mask = 0xff, tiled_flag = 0x200, long_names_flag = 0x400,
                        deep_flag = 0x800, several_parts_flag = 0x1000;

struct Layout {
  std::uint64_t height = 0, width = 0;
  std::uint64_t tile_height = 0, tile_width = 0;
  std::uint64_t channels = 0;
};

void check_version(ByteCursor& cursor) {
  const std::uint32_t version = cursor.take_u32_little("the version");
  if ((version & version_mask) != 2)
    cursor.fail_at(4, fmt::format("found OpenEXR version {}; expected 2", version & version_mask));
  if (version & deep_flag) cursor.fail_at(4, "found a deep image; expected a flat one");
  if (version & several_parts_flag) cursor.fail_at(4, "found several parts; expected one");
  if (version & ~(version_mask | tiled_flag | long_names_flag))
    cursor.fail_at(4, "found unknown flags; expected an OpenEXR 2 image");
}

/// A box is xmin, ymin, xmax, ymax, ends included.
void note_data_window(ByteCursor value, Layout& layout, std::string_view file) {
  std::int64_t corner[4];
  for (std::int64_t& c : corner)
    c = static_cast<std::int32_t>(value.take_u32_little("the data window"));
  const std::int64_t width = corner[2] - corner[0] + 1, height = corner[3] - corner[1] + 1;
  layout.width = width < 0 ? 0 : static_cast<std::uint64_t>(width);
  layout.height = height < 0 ? 0 : static_cast<std::uint64_t>(height);
  check_image_size(file, layout.height, layout.width);
}

void note_channels(ByteCursor value, Layout& layout) {
  constexpr std::uint32_t half_type = 1, float_type = 2;
  constexpr std::uint64_t max_channels = 64;
  layout.channels = 0;
  for (;;) {
    const std::string_view name = value.take_until('\0', "a channel name");
    if (name.empty()) break;
    if (++layout.channels > max_channels)
      value.fail(fmt::format("found more than {} channels; expected fewer", max_channels));
    const std::uint32_t type = value.take_u32_little("a channel");
    if (type != half_type && type != float_type)
      value.fail(fmt::format("channel '{}' holds integers; expected half or float", name));
    value.take(4, "a channel");  // a hint for compression, and padding
    const std::uint32_t x = value.take_u32_little("a channel");
    const std::uint32_t y = value.take_u32_little("a channel");
    if (x != 1 || y != 1)
      value.fail(
          fmt::format("channel '{}' has every {}th column and {}th row; expected all", name, x, y));
  }
}

void note_tiles(ByteCursor value, Layout& layout) {
  layout.tile_width = value.take_u32_little("the tile size");
  layout.tile_height = value.take_u32_little("the tile size");
  if (layout.tile_width < 1 || layout.tile_height < 1 || layout.tile_width > max_image_side ||
      layout.tile_height > max_image_side ||
      layout.tile_width * layout.tile_height > max_image_pixels)
    value.fail(fmt::format("found tiles of {} x {} pixels; expected sides of 1 .. {}",
                           layout.tile_height, layout.tile_width, max_image_side));
}

/// Every tile has an 8-byte entry in the file's offset table.
void check_tile_count(const Layout& layout, std::size_t file_bytes, const ByteCursor& cursor) {
  if (layout.tile_width == 0) return;
  const std::uint64_t across = (layout.width - 1) / layout.tile_width + 1;
  const std::uint64_t down = (layout.height - 1) / layout.tile_height + 1;
  if (across * down * 8 > file_bytes)
    cursor.fail(
        fmt::format("found {} x {} tiles; expected no more than the file can hold", down, across));
}

/// A flat image can be packed almost without end, so a bound on the ratio alone would refuse small
/// ones; the ratio is what a constant image reaches in large DWA blocks.
void check_unpacked_size(const Layout& layout, std::size_t file_bytes, const ByteCursor& cursor) {
  constexpr std::uint64_t harmless_bytes = std::uint64_t{1} << 26, largest_ratio = 65536;
  const std::uint64_t unpacked = layout.channels * layout.height * layout.width * sizeof(float);
  if (unpacked > harmless_bytes && unpacked / largest_ratio > file_bytes)
    cursor.fail(
        fmt::format("found {} channels of {} x {} pixels; expected at most what a file of "
                    "{} bytes can unpack to",
                    layout.channels, layout.height, layout.width, file_bytes));
}

}  // namespace

void check_exr_layout(std::span<const std::byte> content, std::string_view file) {
  ByteCursor cursor(content, file);
  if (cursor.take_u32_little("the OpenEXR magic") != magic)
    cursor.fail_at(0, "found no OpenEXR magic; expected an OpenEXR image");
  check_version(cursor);

  Layout layout;
  for (;;) {
    const std::string_view name = cursor.take_until('\0', "an attribute name");
    if (name.empty()) break;
    const std::string_view type = cursor.take_until('\0', "an attribute type");
    const std::uint32_t size = cursor.take_u32_little("an attribute's size");
    const std::size_t start = cursor.position();
    cursor.take(size, "an attribute");
    ByteCursor value(content.first(start + size), file);
    value.take(start, "an attribute");
    if (name == "dataWindow" && type == "box2i") note_data_window(value, layout, file);
    if (name == "channels" && type == "chlist") note_channels(value, layout);
    if (name == "tiles" && type == "tiledesc") note_tiles(value, layout);
  }
  if (layout.width == 0) cursor.fail("the header ends here; expected a data window in it");
  if (layout.channels == 0) cursor.fail("the header ends here; expected channels in it");
  check_tile_count(layout, content.size(), cursor);
  check_unpacked_size(layout, content.size(), cursor);
}

}  // namespace tofsmith

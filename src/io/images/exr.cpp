// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/images/exr.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

#include "io/byte_cursor.hpp"
#include "io/image_limits.hpp"
#include "io/shared/read_file.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

// Layout: "OpenEXR File Layout", openexr.com.

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

/// Returns the size of the channel list [bytes].
std::uint64_t note_channels(ByteCursor value, Layout& layout) {
  const std::size_t begin = value.position();
  constexpr std::uint32_t half_type = 1, float_type = 2;
  constexpr std::uint64_t max_channels = 32;
  layout.channels = 0;
  for (;;) {
    const std::string_view name = value.take_until('\0', "a channel name");
    if (name.empty()) return value.position() - begin;
    if (++layout.channels > max_channels)
      value.fail(fmt::format("found more than {} channels; expected fewer", max_channels));
    const std::uint32_t type = value.take_u32_little("a channel");
    if (type != half_type && type != float_type)
      value.fail(fmt::format("channel '{}' holds integers; expected half or float", name));
    value.take(4, "a channel");  // compression hint and padding
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
    value.fail(fmt::format("found tiles of {} x {} pixels; expected sides of 1 to {}",
                           layout.tile_height, layout.tile_width, max_image_side));
}

/// Each tile has an 8-byte entry in the offset table.
void check_tile_count(const Layout& layout, std::size_t file_bytes, const ByteCursor& cursor) {
  if (layout.tile_width == 0) return;
  const std::uint64_t across = (layout.width - 1) / layout.tile_width + 1;
  const std::uint64_t down = (layout.height - 1) / layout.tile_height + 1;
  if (across * down * 8 > file_bytes)
    cursor.fail(
        fmt::format("found {} x {} tiles; expected at most the number that the file can contain",
                    down, across));
}

/// Small constant images reach any compression ratio, so it is limited for large images only, to
/// the ratio of a constant image in large DWA blocks.
void check_unpacked_size(const Layout& layout, std::size_t file_bytes, const ByteCursor& cursor) {
  constexpr std::uint64_t harmless_bytes = std::uint64_t{1} << 26, max_ratio = 65536,
                          max_bytes = std::uint64_t{1} << 30;
  const std::uint64_t unpacked = layout.channels * layout.height * layout.width * sizeof(float);
  if (unpacked > max_bytes)
    cursor.fail(
        fmt::format("found {} channels of {} x {} pixels; expected at most {} numbers in all",
                    layout.channels, layout.height, layout.width, max_bytes / sizeof(float)));
  if (unpacked > harmless_bytes && unpacked / max_ratio > file_bytes)
    cursor.fail(
        fmt::format("found {} channels of {} x {} pixels; expected at most what a file of "
                    "{} bytes can unpack to",
                    layout.channels, layout.height, layout.width, file_bytes));
}

/// The library ignores the size of an attribute; a wrong size would make it interpret arbitrary
/// bytes as sizes.
void check_attribute_size(ByteCursor value, std::string_view type, std::uint64_t size) {
  struct Known {
    std::string_view type;
    std::uint64_t bytes;
  };
  static constexpr Known known[] = {{"box2i", 16},      {"box2f", 16},   {"chromaticities", 32},
                                    {"compression", 1}, {"double", 8},   {"envmap", 1},
                                    {"float", 4},       {"int", 4},      {"keycode", 28},
                                    {"lineOrder", 1},   {"m33f", 36},    {"m33d", 72},
                                    {"m44f", 64},       {"m44d", 128},   {"rational", 8},
                                    {"v2i", 8},         {"v2f", 8},      {"v2d", 16},
                                    {"v3i", 12},        {"v3f", 12},     {"v3d", 24},
                                    {"tiledesc", 9},    {"timecode", 8}, {"deepImageState", 1}};
  std::uint64_t expected = size;
  for (const Known& each : known)
    if (each.type == type) expected = each.bytes;
  if (type == "preview") {
    const std::uint64_t width = value.take_u32_little("the size of the preview");
    expected = 8 + 4 * width * value.take_u32_little("the size of the preview");
  }
  if (type == "chlist") {
    Layout ignored;
    expected = note_channels(value, ignored);
  }
  if (size != expected)
    value.fail(fmt::format("found {} bytes of type '{}'; expected {}", size, type, expected));
}

/// The OpenEXR library allocates memory for any sizes in a damaged header.
/// @throws IoError at a byte offset if parse_exr() does not support the file
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
    check_attribute_size(value, type, size);
    if (name == "dataWindow" && type == "box2i") note_data_window(value, layout, file);
    if (name == "channels" && type == "chlist") note_channels(value, layout);
    if (name == "tiles" && type == "tiledesc") note_tiles(value, layout);
  }
  if (layout.width == 0) cursor.fail("the header ends here; expected a data window in it");
  if (layout.channels == 0) cursor.fail("the header ends here; expected channels in it");
  check_tile_count(layout, content.size(), cursor);
  check_unpacked_size(layout, content.size(), cursor);
}

class MemoryInput : public Imf::IStream {
 public:
  MemoryInput(std::span<const std::byte> content, const char* file)
      : Imf::IStream(file), content_(content) {}

  bool read(char into[], int count) override {
    const auto wanted = static_cast<std::uint64_t>(std::max(count, 0));
    if (position_ > content_.size() || content_.size() - position_ < wanted)
      throw IoError(fmt::format("{}: byte {}", fileName(), content_.size()),
                    "the file ends here; expected more of the image");
    std::memcpy(into, content_.data() + position_, wanted);
    position_ += wanted;
    return position_ < content_.size();
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override { position_ = position; }

 private:
  std::span<const std::byte> content_;
  std::uint64_t position_ = 0;
};

class MemoryOutput : public Imf::OStream {
 public:
  MemoryOutput() : Imf::OStream("EXR image") {}

  void write(const char from[], int count) override {
    const auto bytes = static_cast<std::uint64_t>(std::max(count, 0));
    content.resize(std::max<std::uint64_t>(content.size(), position_ + bytes));
    std::memcpy(content.data() + position_, from, bytes);
    position_ += bytes;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }

  std::vector<std::byte> content;

 private:
  std::uint64_t position_ = 0;
};

ExrPlanes read_planes(Imf::InputFile& input) {
  const Imath::Box2i window = input.header().dataWindow();
  ExrPlanes planes;
  Imf::FrameBuffer frame;
  const Imf::ChannelList& channels = input.header().channels();
  for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
    Image<float>& plane = planes[channel.name()] =
        Image<float>(window.max.y - window.min.y + 1, window.max.x - window.min.x + 1);
    frame.insert(channel.name(), Imf::Slice::Make(Imf::FLOAT, plane.pixels.data(), window));
  }
  input.setFrameBuffer(frame);
  input.readPixels(window.min.y, window.max.y);
  return planes;
}

void check(const ExrPlanes& planes) {
  require(!planes.empty(), "planes", "{}", "must have at least one");
  const Image<float>& first = planes.begin()->second;
  for (const auto& [name, plane] : planes) {
    require(!name.empty(), "channel name", "''", "must not be empty");
    require(plane.height >= 1 && plane.width >= 1, name,
            fmt::format("{} x {}", plane.height, plane.width), "must have pixels");
    require(
        plane.height == first.height && plane.width == first.width, name,
        fmt::format("{} x {}", plane.height, plane.width),
        fmt::format("must be as large as the other planes, {} x {}", first.height, first.width));
  }
}

template <typename Read>
auto read_from(std::span<const std::byte> content, std::string_view file, const Read& read) {
  check_exr_layout(content, file);
  const std::string name(file);
  try {
    MemoryInput stream(content, name.c_str());
    Imf::InputFile input(stream);
    return read(input);
  } catch (const IoError&) {
    throw;
  } catch (const std::exception& error) {
    throw IoError(file, fmt::format("damaged OpenEXR image: {}", error.what()));
  }
}

}  // namespace

ExrPlanes parse_exr(std::span<const std::byte> content, std::string_view file) {
  return read_from(content, file, read_planes);
}

std::string read_exr_text(const std::filesystem::path& path, const std::string& name) {
  return read_from(read_binary_file(path), path.string(), [&](Imf::InputFile& input) {
    const auto* found = input.header().findTypedAttribute<Imf::StringAttribute>(name);
    return found ? found->value() : std::string();
  });
}

ExrPlanes read_exr(const std::filesystem::path& path) {
  return parse_exr(read_binary_file(path), path.string());
}

std::vector<std::byte> serialize_exr(const ExrPlanes& planes, const ExrText& text) {
  check(planes);
  const Image<float>& first = planes.begin()->second;
  Imf::Header header(first.width, first.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  if (!text.name.empty()) header.insert(text.name, Imf::StringAttribute(text.text));
  Imf::FrameBuffer frame;
  for (const auto& [name, plane] : planes) {
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    frame.insert(name, Imf::Slice::Make(Imf::FLOAT, plane.pixels.data(), header.dataWindow()));
  }
  MemoryOutput stream;
  try {
    Imf::OutputFile output(stream, header);
    output.setFrameBuffer(frame);
    output.writePixels(first.height);
  } catch (const std::exception& error) {
    throw IoError("EXR image", error.what());
  }
  return std::move(stream.content);
}

void write_exr(const std::filesystem::path& path, const ExrPlanes& planes, OutputPolicy policy,
               const ExrText& text) {
  AtomicFile file(path, policy);
  file.write(serialize_exr(planes, text));
  file.commit();
}

}  // namespace tofsmith

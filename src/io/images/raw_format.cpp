// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/raw_format.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "io/shared/read_file.hpp"
#include "io/text/field_toml.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/raw_frames.hpp"

namespace tofsmith {

namespace {

bool is_bit_stream(RawPacking packing) {
  return packing == RawPacking::lsb_first || packing == RawPacking::msb_first;
}

/// A MIPI group consists of whole bytes.
int mipi_group(int bits) { return bits == 12 ? 2 : 4; }

void validate_numbers(const RawFormat& f) {
  if (f.numbers == RawNumbers::floats) {
    require(f.bits == 16 || f.bits == 32 || f.bits == 64, "bits", f.bits,
            "must be 16, 32 or 64 for floats");
    require(f.packing == RawPacking::plain, "packing", "packed", "must be plain for floats");
    require(!f.is_signed, "signed", true, "must be omitted for floats, which are always signed");
    require(f.container_bits == 0 || f.container_bits == f.bits, "container_bits", f.container_bits,
            "must be the bits of a float");
    require(f.align == RawAlignment::low, "align", "high", "must be low for floats");
    require(f.unused_bits == UnusedBits::checked, "unused_bits", "ignored",
            "must be omitted for floats");
    return;
  }
  require(f.bits >= 1 && f.bits <= 32, "bits", f.bits, "must be in [1, 32] for integers");
  if (f.packing == RawPacking::plain) {
    const int c = f.stored_bits();
    require((c == 8 || c == 16 || c == 32) && c >= f.bits, "container_bits", c,
            fmt::format("must be 8, 16 or 32 and hold bits = {}", f.bits));
    return;
  }
  require(f.container_bits == 0, "container_bits", f.container_bits,
          "must be omitted unless packing is plain");
  require(f.align == RawAlignment::low, "align", "high", "must be low unless packing is plain");
  require(f.unused_bits == UnusedBits::checked, "unused_bits", "ignored",
          "must be omitted unless packing is plain");
  require(f.byte_order == RawByteOrder::little, "byte_order", "big",
          "must be omitted unless packing is plain");
  if (f.packing == RawPacking::mipi) {
    require(f.bits == 10 || f.bits == 12 || f.bits == 14, "bits", f.bits,
            "must be 10, 12 or 14 for mipi (lsb_first packs any number)");
    require(f.numbers_per_row() % static_cast<std::size_t>(mipi_group(f.bits)) == 0, "width",
            f.width,
            fmt::format("must give rows of complete groups of {} numbers (it gives {})",
                        mipi_group(f.bits), f.numbers_per_row()));
  }
}

void validate_signs(const RawFormat& f) {
  require(f.is_signed || f.sign_encoding == SignEncoding::twos_complement, "sign_encoding",
          "sign_magnitude", "must be omitted unless signed = true");
  require(f.is_signed || !f.sign_bit, "sign_bit", f.sign_bit.value_or(0),
          "must be omitted unless signed = true");
  require(f.sign_bit.value_or(0) < f.bits, "sign_bit", f.sign_bit.value_or(0),
          fmt::format("must be below bits = {}", f.bits));
  require(f.negate_from_row < f.height, "negate_from_row", f.negate_from_row,
          fmt::format("must be below height = {}", f.height));
  require(f.negate_from_column < f.width, "negate_from_column", f.negate_from_column,
          fmt::format("must be below width = {}", f.width));
}

void validate_order(const RawFormat& f) {
  require(f.order.size() <= static_cast<std::size_t>(f.measurements), "order", f.order.size(),
          fmt::format("must list at most the {} measurements", f.measurements));
  const int kept = f.kept_measurements();
  require(kept > 0, "order", "-1 only", "must include a measurement");
  for (int i = 0; i < kept && !f.order.empty(); ++i)
    require(std::ranges::count(f.order, i) == 1, "order",
            fmt::format("[{}]", fmt::join(f.order, ", ")),
            fmt::format("must list each of 0 to {} once, and -1 for numbers to skip", kept - 1));
  require(!f.subtracts_taps() || kept % 2 == 0, f.order.empty() ? "measurements" : "order", kept,
          "must be even to subtract taps");
}

void validate_rows(const RawFormat& f) {
  if (!f.rows_start_bytes) {
    require(is_bit_stream(f.packing), "rows_start_bytes", false,
            "must be omitted unless packing is lsb_first or msb_first");
    for (const auto& [field, value] :
         {std::pair{"row_bytes", f.row_bytes}, std::pair{"row_header_bytes", f.row_header_bytes}})
      require(value == 0, field, value, "must be omitted with rows_start_bytes = false");
  }
  const std::uint64_t needed = static_cast<std::uint64_t>(f.row_header_bytes) + f.tight_row_bytes();
  require(f.row_bytes == 0 || static_cast<std::uint64_t>(f.row_bytes) >= needed, "row_bytes",
          f.row_bytes,
          fmt::format("must be at least {} bytes, the size of a row's header and numbers", needed));
  for (const auto& [field, value] : {std::pair{"image_header_bytes", f.image_header_bytes},
                                     std::pair{"image_trailer_bytes", f.image_trailer_bytes}})
    require(value == 0 || f.layout == RawOrder::planar, field, value,
            "must be omitted unless layout is planar");
}

}  // namespace

int RawFormat::stored_bits() const {
  if (numbers == RawNumbers::floats || packing != RawPacking::plain) return bits;
  if (container_bits > 0) return container_bits;
  return bits <= 8 ? 8 : bits <= 16 ? 16 : 32;
}

std::size_t RawFormat::numbers_per_row() const {
  return static_cast<std::size_t>(width) *
         static_cast<std::size_t>(layout == RawOrder::interleaved ? measurements : 1);
}

std::size_t RawFormat::rows_per_image() const {
  return static_cast<std::size_t>(height) *
         static_cast<std::size_t>(layout == RawOrder::by_rows ? measurements : 1);
}

std::size_t RawFormat::images() const {
  return layout == RawOrder::planar ? static_cast<std::size_t>(measurements) : 1;
}

std::uint64_t RawFormat::tight_row_bytes() const {
  return (std::uint64_t{numbers_per_row()} * static_cast<std::uint64_t>(stored_bits()) + 7) / 8;
}

std::uint64_t RawFormat::row_pitch_bytes() const {
  return row_bytes > 0 ? static_cast<std::uint64_t>(row_bytes)
                       : static_cast<std::uint64_t>(row_header_bytes) + tight_row_bytes();
}

std::uint64_t RawFormat::image_bytes() const {
  if (rows_start_bytes) return row_pitch_bytes() * rows_per_image();
  const std::uint64_t bits_of_image = std::uint64_t{numbers_per_row()} * rows_per_image() *
                                      static_cast<std::uint64_t>(stored_bits());
  return (bits_of_image + 7) / 8;
}

std::uint64_t RawFormat::frame_bytes() const {
  const auto around_frame = static_cast<std::uint64_t>(frame_header_bytes + frame_trailer_bytes),
             around_image = static_cast<std::uint64_t>(image_header_bytes + image_trailer_bytes);
  return around_frame + images() * (around_image + image_bytes());
}

int RawFormat::measurement_of(int number) const {
  const auto j = static_cast<std::size_t>(number);
  if (order.empty()) return number;
  return j < order.size() ? order[j] : -1;
}

int RawFormat::kept_measurements() const {
  if (order.empty()) return measurements;
  return static_cast<int>(std::ranges::count_if(order, [](int number) { return number >= 0; }));
}

void RawFormat::validate() const {
  check_ranges(*this);
  require(rotate_deg % 90 == 0 && rotate_deg >= 0 && rotate_deg < 360, "rotate_deg", rotate_deg,
          "must be 0, 90, 180 or 270");
  validate_numbers(*this);
  validate_signs(*this);
  validate_order(*this);
  validate_rows(*this);
  require(!subtracts_taps() || black_level == 0.0, "black_level", black_level,
          "must be omitted with taps = \"subtract\", which cancels it");
}

namespace {

/// For a wrong key ending in "_bytes", lists all such keys, because the most similar one is often
/// wrong.
void refuse_unknown_gaps(const Document& document, RawFormat format) {
  KeyNames known;
  describe(known, format);
  std::erase_if(known.names, [](const std::string& name) { return !name.ends_with("_bytes"); });
  for (const auto& [key, value] : document.root().items())
    if (key.ends_with("_bytes") && std::ranges::find(known.names, key) == known.names.end())
      throw IoError(document.place_of_key(value), fmt::format("unknown key {}; expected one of {}",
                                                              key, fmt::join(known.names, ", ")));
}

}  // namespace

RawFormat parse_raw_format(std::string_view text, std::string_view source_name) {
  const Document document = parse_toml(text, source_name);
  TableReader table(document);
  FieldReader reader(table);
  RawFormat format;
  describe(reader, format);
  refuse_unknown_gaps(document, format);
  table.finish();
  try {
    format.validate();
  } catch (const InvalidArgument& error) {
    throw IoError(document.place_of_field(error.field()), error.what());
  }
  return format;
}

RawFormat read_raw_format(const std::filesystem::path& path) {
  return parse_raw_format(read_text_file(path, max_settings_file_bytes), path.string());
}

namespace {

const std::map<std::string, std::string>& known_formats() {
  static const std::map<std::string, std::string> formats = {
      {"arducam-tof",
       "# Arducam ToF camera through V4L2 as pixel format Y12: four buffers per frame, one per "
       "phase.\n#   v4l2-ctl --set-fmt-video=width=240,height=180,pixelformat=Y12 --stream-mmap "
       "--stream-to=-\n# Layout from a public driver for the Raspberry Pi (arducam_tof.cpp): "
       "signed 11 bits, rows from\n# bottom to top, depth = c / (4 pi f) atan2(third - first, "
       "fourth - second).\nwidth = 240\nheight = 180\nmeasurements = 4\nbits = 11\ncontainer_bits "
       "= 16\nunused_bits = \"ignored\"\nsigned = true\norder = [3, 2, 1, 0]\nflip_rows = true\n"}};
  return formats;
}

std::string reason_of(const std::string& camera) {
  if (camera == "kinect-v2")
    return "its columns are interleaved and its numbers require a lookup table (unpack them with "
           "libfreenect2, and save the nine images as .npy)";
  return "the format of its raw frames is not published";
}

}  // namespace

std::vector<std::string> built_in_raw_format_names() {
  std::vector<std::string> names;
  for (const auto& [name, text] : known_formats()) names.push_back(name);
  return names;
}

std::string built_in_raw_format_toml(const std::string& camera) {
  static_cast<void>(built_in_camera(camera));  // rejects unknown names
  const auto found = known_formats().find(camera);
  if (found != known_formats().end()) return found->second;
  reject("camera", camera,
         fmt::format("has no description of its raw frames: {}; expected {}", reason_of(camera),
                     fmt::join(built_in_raw_format_names(), ", ")));
}

}  // namespace tofsmith

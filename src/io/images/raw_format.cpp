// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/raw_frames.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

constexpr int max_pixels = 1 << 16;  // of a side, as of every image
constexpr int max_raw_measurements = 256;
constexpr std::uint64_t max_gap_bytes = std::uint64_t{1} << 30;

int container_of(const RawFormat& format) {
  if (format.container_bits > 0) return format.container_bits;
  return format.bits <= 8 ? 8 : format.bits <= 16 ? 16 : 32;
}

bool is_bit_stream(RawPacking packing) {
  return packing == RawPacking::lsb_first || packing == RawPacking::msb_first;
}

/// Numbers of a MIPI group, which takes whole bytes.
int mipi_group(int bits) { return bits == 12 ? 2 : 4; }

int bits_per_number(const RawFormat& format) {
  if (format.numbers == RawNumbers::floats || format.packing != RawPacking::plain)
    return format.bits;
  return container_of(format);
}

void validate_numbers(const RawFormat& f) {
  if (f.numbers == RawNumbers::floats) {
    require(f.bits == 32 || f.bits == 64, "bits", f.bits, "must be 32 or 64 for floats");
    require(f.packing == RawPacking::plain, "packing", "packed", "must be plain for floats");
    require(!f.is_signed, "signed", true, "must be left out for floats, which always are");
    require(f.container_bits == 0 || f.container_bits == f.bits, "container_bits", f.container_bits,
            "must be the bits of a float");
    require(f.align == RawAlignment::low, "align", "high", "must be low for floats");
    return;
  }
  require(f.bits >= 1 && f.bits <= 32, "bits", f.bits, "must be in [1, 32] for integers");
  if (f.packing == RawPacking::plain) {
    const int c = container_of(f);
    require((c == 8 || c == 16 || c == 32) && c >= f.bits, "container_bits", c,
            fmt::format("must be 8, 16 or 32 and hold bits = {}", f.bits));
    return;
  }
  require(f.container_bits == 0, "container_bits", f.container_bits,
          "must be left out unless plain");
  require(f.align == RawAlignment::low, "align", "high", "must be low unless plain");
  require(!f.big_endian, "byte_order", "big", "must be left out unless plain");
  if (f.packing == RawPacking::mipi) {
    require(f.bits == 10 || f.bits == 12 || f.bits == 14, "bits", f.bits,
            "must be 10, 12 or 14 for mipi (lsb_first packs any number)");
    require(f.numbers_per_row() % static_cast<std::size_t>(mipi_group(f.bits)) == 0, "width",
            f.width,
            fmt::format("must give rows of whole groups of {} numbers (it gives {})",
                        mipi_group(f.bits), f.numbers_per_row()));
  }
}

void validate_order(const RawFormat& f) {
  if (f.order.empty()) return;
  require(f.order.size() == static_cast<std::size_t>(f.measurements), "order", f.order.size(),
          fmt::format("must list all {} measurements", f.measurements));
  std::vector<int> sorted = f.order;
  std::ranges::sort(sorted);
  for (int i = 0; i < f.measurements; ++i)
    require(sorted[static_cast<std::size_t>(i)] == i, "order", sorted[static_cast<std::size_t>(i)],
            fmt::format("must name each of 0 .. {} once", f.measurements - 1));
}

}  // namespace

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
  return (std::uint64_t{numbers_per_row()} * static_cast<std::uint64_t>(bits_per_number(*this)) +
          7) /
         8;
}

std::uint64_t RawFormat::image_bytes() const {
  if (rows_start_bytes) return (row_bytes > 0 ? row_bytes : tight_row_bytes()) * rows_per_image();
  const std::uint64_t bits_of_image = std::uint64_t{numbers_per_row()} * rows_per_image() *
                                      static_cast<std::uint64_t>(bits_per_number(*this));
  return (bits_of_image + 7) / 8;
}

std::uint64_t RawFormat::frame_bytes() const {
  return frame_header_bytes + images() * (image_header_bytes + image_bytes());
}

void RawFormat::validate() const {
  require(width >= 1 && width <= max_pixels, "width", width,
          fmt::format("must be in [1, {}]", max_pixels));
  require(height >= 1 && height <= max_pixels, "height", height,
          fmt::format("must be in [1, {}]", max_pixels));
  require(measurements >= 1 && measurements <= max_raw_measurements, "measurements", measurements,
          fmt::format("must be in [1, {}]", max_raw_measurements));
  require(frames >= 0, "frames", frames, "must be >= 0 (0: as many as the file holds)");
  for (const auto& [field, value] :
       {std::pair{"header_bytes", header_bytes},
        std::pair{"frame_header_bytes", frame_header_bytes},
        std::pair{"image_header_bytes", image_header_bytes}, std::pair{"row_bytes", row_bytes}})
    require(value <= max_gap_bytes, field, value, fmt::format("must be <= {}", max_gap_bytes));
  validate_numbers(*this);
  validate_order(*this);
  if (!rows_start_bytes) {
    require(is_bit_stream(packing), "rows_start_bytes", false,
            "must be left out unless packing is lsb_first or msb_first");
    require(row_bytes == 0, "row_bytes", row_bytes,
            "must be left out with rows_start_bytes = false");
  }
  require(
      row_bytes == 0 || row_bytes >= tight_row_bytes(), "row_bytes", row_bytes,
      fmt::format("must be at least the {} bytes that a row's numbers take", tight_row_bytes()));
  require(image_header_bytes == 0 || layout == RawOrder::planar, "image_header_bytes",
          image_header_bytes, "must be left out unless layout is planar");
  require(!subtract_taps || measurements % 2 == 0, "measurements", measurements,
          "must be even to subtract taps");
  require(!subtract_taps || black_level == 0.0, "black_level", black_level,
          "must be left out with taps = \"subtract\", where it cancels");
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/images/raw_sizes.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <utility>

#include "io/image_limits.hpp"
#include "tofsmith/core/error.hpp"

#include "core/shared/enum_words.hpp"

namespace tofsmith {
namespace {

struct Axes {
  std::size_t frames, height, width, measurements;
};

Axes axes_of(const NpyShape& shape, RawLayout layout) {
  const bool several = shape.size() == 4;
  const std::size_t* axis = shape.data() + (several ? 1 : 0);
  const std::size_t frames = several ? shape[0] : 1;
  if (layout == RawLayout::planar) return {frames, axis[1], axis[2], axis[0]};
  return {frames, axis[0], axis[1], axis[2]};
}

std::string_view shapes_of(RawLayout layout) {
  return layout == RawLayout::planar ? "(K, H, W) or (F, K, H, W)" : "(H, W, K) or (F, H, W, K)";
}

void check_measurements(const NpyShape& shape, const RawReadOptions& options,
                        const std::string& file) {
  const std::size_t found = axes_of(shape, options.layout).measurements;
  if (!options.measurements || found == static_cast<std::size_t>(*options.measurements)) return;
  const RawLayout other =
      options.layout == RawLayout::planar ? RawLayout::interleaved : RawLayout::planar;
  const bool other_fits =
      axes_of(shape, other).measurements == static_cast<std::size_t>(*options.measurements);
  throw IoError(
      file, fmt::format("found {} measurements per pixel, shape {}; expected {}, as the code has{}",
                        found, describe_shape(shape), *options.measurements,
                        other_fits ? fmt::format(" (the shape fits as {}: --layout {})",
                                                 shapes_of(other), name_of(other))
                                   : ""));
}

struct NumberRange {
  double lowest = 0.0, highest = 0.0;
};

NumberRange whole_numbers(int bits, bool is_unsigned) {
  const double count = std::exp2(bits);
  if (is_unsigned) return {0.0, count - 1.0};
  return {-0.5 * count, 0.5 * count - 1.0};
}

std::optional<NumberRange> range_of(NpyType type) {
  if (is_float(type)) return std::nullopt;
  return whole_numbers(8 * static_cast<int>(item_size(type)), is_unsigned(type));
}

std::optional<NumberRange> range_of(const RawFormat& format) {
  if (format.numbers == RawNumbers::floats) return std::nullopt;
  if (!format.is_signed) return whole_numbers(format.bits, true);
  NumberRange range = whole_numbers(format.sign_bit_index() + 1, false);
  if (format.sign_encoding == SignEncoding::sign_magnitude) range.lowest = -range.highest;
  return range;
}

[[noreturn]] void refuse_marker(std::string_view key, double marker, std::string_view numbers,
                                const std::string& rule, const std::string& file) {
  throw IoError(file, fmt::format("found {}; raw.{} = {} of the camera must be {}, or it cannot "
                                  "occur",
                                  numbers, key, marker, rule));
}

/// @param range  of integers; none: floats
/// @param digits  bits of a float's mantissa
void check_markers(const RawMarkers& markers, const std::optional<NumberRange>& range, int digits,
                   std::string_view numbers, const std::string& file) {
  for (const auto& [key, list] :
       {std::pair{"saturated", &markers.saturated}, std::pair{"invalid", &markers.invalid}})
    for (const double marker : *list) {
      if (range &&
          (!(marker >= range->lowest && marker <= range->highest) || marker != std::floor(marker)))
        refuse_marker(
            key, marker, numbers,
            fmt::format("a whole number from {:.0f} to {:.0f}", range->lowest, range->highest),
            file);
      if (!range && digits < 53 && std::isfinite(marker) &&
          static_cast<double>(static_cast<float>(marker)) != marker)
        refuse_marker(key, marker, numbers, "one of them", file);
    }
}

constexpr EnumWords<RawLayout, 2> layout_words("RawLayout", "layout", words_of(RawLayout{}));

}  // namespace

RawFrames checked_raw_sizes(NpyType type, const NpyShape& shape, const RawReadOptions& options,
                            const std::string& file) {
  if (type == NpyType::boolean)
    throw IoError(file, fmt::format("found items of type {}; expected numbers (in NumPy: "
                                    "raw.astype(numpy.float32))",
                                    name_of(type)));
  if (shape.size() != 3 && shape.size() != 4)
    throw IoError(
        file,
        fmt::format("found an array of shape {}; expected {}{}", describe_shape(shape),
                    shapes_of(options.layout),
                    shape.size() == 2 ? ", or all files if each contains one measurement" : ""));
  const Axes axes = axes_of(shape, options.layout);
  constexpr std::size_t max_axis = std::numeric_limits<int>::max();
  if (axes.frames < 1 || axes.frames > max_axis || axes.measurements < 1 ||
      axes.measurements > max_axis)
    throw IoError(file, fmt::format("found an array of shape {}; expected at least one frame and "
                                    "one measurement, and at most {}",
                                    describe_shape(shape), max_axis));
  check_measurements(shape, options, file);
  check_image_size(file, axes.height, axes.width);
  RawFrames sizes;
  sizes.frames = static_cast<int>(axes.frames);
  sizes.height = static_cast<int>(axes.height);
  sizes.width = static_cast<int>(axes.width);
  sizes.measurements = static_cast<int>(axes.measurements);
  return sizes;
}

void check_measurements(const RawFormat& format, int expected, const std::string& file) {
  const int found = format.output_measurements();
  if (found == expected) return;
  throw IoError(
      file,
      fmt::format("the description gives {} measurements per pixel; expected {}, as the code has{}",
                  found, expected,
                  found > expected && !format.subtract_taps
                      ? " (order = [0, 1, ..., -1] skips images that are not measurements)"
                      : ""));
}

bool is_unsigned(NpyType type) {
  return type == NpyType::uint8 || type == NpyType::uint16 || type == NpyType::uint32 ||
         type == NpyType::uint64;
}

void check_markers(const RawMarkers& markers, NpyType type, const std::string& file) {
  check_markers(markers, range_of(type), is_float(type) && type != NpyType::float64 ? 24 : 53,
                fmt::format("numbers of type {}", name_of(type)), file);
}

void check_markers(const RawMarkers& markers, const RawFormat& format, const std::string& file) {
  check_markers(markers, range_of(format), format.bits <= 32 ? 24 : 53,
                fmt::format("{} numbers of {} bits",
                            format.numbers == RawNumbers::floats ? "float"
                            : format.is_signed                   ? "signed"
                                                                 : "unsigned",
                            format.bits),
                file);
}

std::string_view name_of(RawLayout layout) { return layout_words.of(layout); }

RawLayout parse_raw_layout(std::string_view name) { return layout_words.parse(name); }

}  // namespace tofsmith

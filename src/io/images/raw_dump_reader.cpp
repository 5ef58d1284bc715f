// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/images/raw_dump_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "io/image_limits.hpp"
#include "io/input_file.hpp"
#include "tofsmith/core/error.hpp"

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
  return {.frames = static_cast<int>(axes.frames),
          .height = static_cast<int>(axes.height),
          .width = static_cast<int>(axes.width),
          .measurements = static_cast<int>(axes.measurements)};
}

void check_measurements(const RawFormat& format, int expected, const std::string& file) {
  const int found = format.output_measurements();
  if (found == expected) return;
  throw IoError(
      file,
      fmt::format("the description gives {} measurements per pixel; expected {}, as the code has{}",
                  found, expected,
                  found > expected && !format.subtracts_taps()
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

namespace {

std::uint64_t bytes_around_frames(const RawFormat& format) {
  return static_cast<std::uint64_t>(format.header_bytes + format.trailer_bytes);
}

std::uint64_t bytes_of_frames(std::uint64_t found, const RawFormat& format) {
  return found - std::min(found, bytes_around_frames(format));
}

std::string length_problem(std::uint64_t found, const RawFormat& format) {
  const std::uint64_t around = bytes_around_frames(format), frame = format.frame_bytes(),
                      data = bytes_of_frames(found, format), complete = data / frame;
  const std::string sizes =
      fmt::format("{} x {} pixels, {} measurements of {} bits, {} bytes per frame", format.height,
                  format.width, format.measurements, format.bits, frame);
  const std::string before =
      around > 0 ? fmt::format("{} of {} and ", around,
                               format.trailer_bytes > 0 ? "header and trailer" : "header")
                 : "";
  const std::string next_step =
      complete > 0 ? fmt::format(
                         "; from standard input, `decode - -o -` decodes the {} complete "
                         "frame{} and reports the rest",
                         complete, complete == 1 ? "" : "s")
                   : "";
  if (format.frames > 0)
    return fmt::format("found {} bytes; expected {}: {}{} frames of {}{}", found,
                       around + static_cast<std::uint64_t>(format.frames) * frame, before,
                       format.frames, sizes, next_step);
  return fmt::format(
      "found {} bytes; expected {}a whole number of frames (1 or more) of {}; {} "
      "bytes are left over after {} frames{}",
      found, before, sizes, data % frame, complete, next_step);
}

int frames_in(std::uint64_t found, const RawFormat& format, const std::string& file) {
  const std::uint64_t frame = format.frame_bytes(), data = bytes_of_frames(found, format),
                      frames = data / frame;
  const bool whole = found >= bytes_around_frames(format) && frames >= 1 && data % frame == 0;
  if (!whole || (format.frames > 0 && frames != static_cast<std::uint64_t>(format.frames)) ||
      frames > std::numeric_limits<int>::max())
    throw IoError(file, length_problem(found, format));
  return static_cast<int>(frames);
}

/// A quarter turn exchanges rows and columns; then each may be reversed.
struct Orientation {
  bool transposed, reversed_rows, reversed_columns;  ///< of the scene

  explicit Orientation(const RawFormat& f)
      : transposed(f.is_transposed()),
        reversed_rows((transposed ? f.flip_columns : f.flip_rows) != (f.rotate_deg >= 180)),
        reversed_columns((transposed ? f.flip_rows : f.flip_columns) !=
                         (f.rotate_deg == 90 || f.rotate_deg == 180)) {}
};

struct FilePlace {
  int row, column;

  FilePlace(const RawFormat& f, const Orientation& o, int scene_row, int scene_column)
      : row(o.reversed_rows ? f.output_height() - 1 - scene_row : scene_row),
        column(o.reversed_columns ? f.output_width() - 1 - scene_column : scene_column) {
    if (o.transposed) std::swap(row, column);
  }
};

bool is_among(NegatedLines lines, int line) {
  return lines != NegatedLines::none && (line % 2 == 1) == (lines == NegatedLines::odd);
}

bool negates_numbers(const RawFormat& f) {
  return f.negate_rows != NegatedLines::none || f.negate_columns != NegatedLines::none ||
         f.negate_from_row > 0 || f.negate_from_column > 0;
}

bool is_negated(const RawFormat& f, const FilePlace& place) {
  return is_among(f.negate_rows, place.row) ^ is_among(f.negate_columns, place.column) ^
         (f.negate_from_row > 0 && place.row >= f.negate_from_row) ^
         (f.negate_from_column > 0 && place.column >= f.negate_from_column);
}

/// Describes each sign, byte order and alignment with which all numbers of a row fit into their
/// bits.
std::string fitting_changes(const RawFormat& format, std::span<const std::byte> row) {
  std::string changes;
  RawFormat with_sign = format;
  with_sign.is_signed = true;
  if (!find_oversized_number(with_sign, row)) changes = "signed = true";
  const bool is_big = format.byte_order == RawByteOrder::big;
  for (const RawByteOrder order :
       {format.byte_order, is_big ? RawByteOrder::little : RawByteOrder::big})
    for (const RawAlignment align : all_values<RawAlignment>) {
      RawFormat other = format;
      other.byte_order = order;
      other.align = align;
      if (find_oversized_number(other, row)) continue;
      changes += fmt::format("{}byte_order = \"{}\" with align = \"{}\"",
                             changes.empty() ? "" : " or ", name_of(order), name_of(align));
    }
  return changes.empty() ? "check bits, byte_order and align" : changes + " would fit this row";
}

std::string oversized_problem(const RawFormat& format, const OversizedNumber& number,
                              std::span<const std::byte> row) {
  return fmt::format(
      "found {0:#x} ({0}), read as {1}-endian; expected {2} bits in the {3} bits of the container, "
      "and no others: {4} (unused_bits = \"ignored\" ignores the other bits)",
      number.container, name_of(format.byte_order), format.bits, name_of(format.align),
      fitting_changes(format, row));
}

class Measure {
 public:
  Measure(const RawFormat& f, const RawMarking& marking)
      : marking_(marking),
        is_unsigned_(f.numbers == RawNumbers::integers && !f.is_signed),
        black_level_(f.black_level == 0.0 && is_unsigned_ ? marking.unsigned_black_level
                                                          : f.black_level) {
    // A sign and a magnitude have no number -2^n.
    if (f.sign_encoding == SignEncoding::sign_magnitude && marking.signed_max)
      lowest_ = -*marking.signed_max;
  }

  double operator()(double number, bool negated) const {
    if (const auto replaced = marking_.replacement(number, is_unsigned_)) return *replaced;
    if (number == lowest_) return marking_.saturated_below;
    return negated ? black_level_ - number : number - black_level_;
  }

 private:
  const RawMarking& marking_;
  bool is_unsigned_;
  double black_level_;
  double lowest_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace

RawDumpReader::RawDumpReader(const std::filesystem::path& path, RawFormat format,
                             RawMarking marking)
    : source_(path.string()), format_(std::move(format)), marking_(std::move(marking)) {
  format_.validate();
  const auto file = std::make_shared<InputFile>(path);
  if (!file->size())
    throw IoError(path.string(),
                  "found a pipe or device; expected a file, read in slices (decode reads frames "
                  "from a pipe as RAW -)");
  frames_ = frames_in(*file->size(), format_, path.string());
  read_at_ = [file](std::uint64_t offset, std::span<std::byte> into) {
    file->read_at(offset, into);
  };
}

RawDumpReader::RawDumpReader(std::span<const std::byte> bytes, RawFormat format, RawMarking marking)
    : source_("bytes"),
      read_at_([bytes](std::uint64_t offset, std::span<std::byte> into) {
        std::ranges::copy(bytes.subspan(offset, into.size()), into.begin());
      }),
      format_(std::move(format)),
      marking_(std::move(marking)) {
  format_.validate();
  frames_ = frames_in(bytes.size(), format_, "bytes");
}

std::size_t RawDumpReader::block_row_bytes() const {
  return format_.is_transposed()
             ? sizeof(double) * static_cast<std::size_t>(format_.output_width()) *
                   static_cast<std::size_t>(format_.kept_measurements())
             : 0;
}

void RawDumpReader::read_file_row(int frame, std::size_t image, std::size_t row,
                                  std::vector<std::byte>& bytes,
                                  std::vector<double>& numbers) const {
  const RawFormat& f = format_;
  const auto bytes_of = [](int count) { return static_cast<std::uint64_t>(count); };
  const std::uint64_t image_at =
      bytes_of(f.header_bytes) + bytes_of(frame) * f.frame_bytes() +
      bytes_of(f.frame_header_bytes) +
      image * (bytes_of(f.image_header_bytes + f.image_trailer_bytes) + f.image_bytes()) +
      bytes_of(f.image_header_bytes);
  const std::size_t count = f.numbers_per_row();
  numbers.resize(count);
  std::uint64_t at = image_at + row * f.row_pitch_bytes() + bytes_of(f.row_header_bytes);
  std::uint64_t size = f.tight_row_bytes();
  int first_bit = 0;
  if (!f.rows_start_bytes) {
    const std::uint64_t bits = std::uint64_t{count} * static_cast<std::uint64_t>(f.bits);
    at = image_at + row * bits / 8;
    first_bit = static_cast<int>(row * bits % 8);
    size = (static_cast<std::uint64_t>(first_bit) + bits + 7) / 8;
  }
  bytes.resize(size);
  read_at_(at, bytes);
  if (const auto oversized = find_oversized_number(f, bytes))
    throw IoError(fmt::format("{}: frame {}, {}row {}, number {}", source_, frame,
                              f.layout == RawOrder::planar ? fmt::format("image {}, ", image) : "",
                              row, oversized->index),
                  oversized_problem(f, *oversized, bytes));
  unpack_numbers(f, bytes, first_bit, numbers);
}

/// Reads rows of the scene as (rows, W, K). A quarter turn requires all rows of the file.
void RawDumpReader::read_block(int frame, int first_row, int rows, Block& block) const {
  const RawFormat& f = format_;
  const Orientation o(f);
  const int width = f.output_width(), kept = f.kept_measurements();
  block.pixels.resize(static_cast<std::size_t>(rows) * static_cast<std::size_t>(width) *
                      static_cast<std::size_t>(kept));
  const bool side_by_side = f.layout == RawOrder::interleaved;
  const int lines = o.transposed ? width : rows, length = o.transposed ? rows : width;
  for (int line = 0; line < lines; ++line) {
    const FilePlace first =
        o.transposed ? FilePlace(f, o, first_row, line) : FilePlace(f, o, first_row + line, 0);
    const std::ptrdiff_t step = (o.transposed ? o.reversed_rows : o.reversed_columns) ? -1 : 1;
    double* const start =
        block.pixels.data() + std::ptrdiff_t{line} * (o.transposed ? 1 : width) * kept;
    const std::ptrdiff_t stride = std::ptrdiff_t{o.transposed ? width : 1} * kept;
    for (int j = 0; j < f.measurements; ++j) {
      const int measurement = f.measurement_of(j);
      if (side_by_side ? j == 0 : measurement >= 0) {
        const bool planar = f.layout == RawOrder::planar;
        const int row = f.layout == RawOrder::by_rows ? first.row * f.measurements + j : first.row;
        read_file_row(frame, static_cast<std::size_t>(planar ? j : 0),
                      static_cast<std::size_t>(row), block.bytes, block.numbers);
      }
      if (measurement < 0) continue;
      const std::ptrdiff_t spacing = side_by_side ? f.measurements : 1;
      const double* const from =
          block.numbers.data() + first.column * spacing + (side_by_side ? j : 0);
      double* const to = start + measurement;
      for (int i = 0; i < length; ++i) to[i * stride] = from[i * step * spacing];
    }
  }
}

template <typename Number>
void RawDumpReader::read_rows(int frame, int first_row, int rows, Number* numbers) const {
  const RawFormat& f = format_;
  const Orientation orientation(f);
  const Measure measure(f, marking_);
  const bool negates = negates_numbers(f);
  const int width = f.output_width(), block_rows = f.is_transposed() ? rows : 1;
  const int outputs = f.output_measurements();
  Block block;
  for (int r = 0; r < rows; r += block_rows) {
    read_block(frame, first_row + r, block_rows, block);
    if (!negates && !f.subtracts_taps()) {
      for (const double number : block.pixels)
        *numbers++ = static_cast<Number>(measure(number, false));
      continue;
    }
    const double* number = block.pixels.data();
    for (int row = first_row + r; row < first_row + r + block_rows; ++row)
      for (int column = 0; column < width; ++column) {
        const bool negated = negates && is_negated(f, FilePlace(f, orientation, row, column));
        for (int k = 0; k < outputs; ++k, number += f.subtracts_taps() ? 2 : 1)
          *numbers++ = static_cast<Number>(!f.subtracts_taps() ? measure(*number, negated)
                                           : negated ? marking_.difference(number[1], number[0])
                                                     : marking_.difference(number[0], number[1]));
      }
  }
}

template void RawDumpReader::read_rows(int, int, int, float*) const;
template void RawDumpReader::read_rows(int, int, int, double*) const;

}  // namespace tofsmith

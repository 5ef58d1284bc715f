// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/images/raw_dump_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "io/input_file.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

/// What is wrong with the length of a file, if something is.
std::string length_problem(std::uint64_t found, const RawFormat& format) {
  const std::uint64_t frame = format.frame_bytes(), header = format.header_bytes;
  const std::string sizes =
      fmt::format("{} x {} pixels, {} measurements of {} bits, {} bytes per frame", format.height,
                  format.width, format.measurements, format.bits, frame);
  if (format.frames > 0)
    return fmt::format("found {} bytes; expected {}: {}{} frames of {}", found,
                       header + static_cast<std::uint64_t>(format.frames) * frame,
                       header > 0 ? fmt::format("{} of header and ", header) : "", format.frames,
                       sizes);
  const std::uint64_t data = found < header ? 0 : found - header;
  return fmt::format(
      "found {} bytes; expected {}a whole number of frames (1 or more) of {}; {} "
      "bytes are left over after {} frames",
      found, header > 0 ? fmt::format("{} of header and ", header) : "", sizes, data % frame,
      data / frame);
}

int frames_in(std::uint64_t found, const RawFormat& format, const std::string& file) {
  const std::uint64_t frame = format.frame_bytes();
  const std::uint64_t data = found < format.header_bytes ? 0 : found - format.header_bytes;
  const std::uint64_t frames = data / frame;
  const bool whole = found >= format.header_bytes && frames >= 1 && data % frame == 0;
  if (!whole || (format.frames > 0 && frames != static_cast<std::uint64_t>(format.frames)) ||
      frames > std::numeric_limits<int>::max())
    throw IoError(file, length_problem(found, format));
  return static_cast<int>(frames);
}

}  // namespace

RawDumpReader::RawDumpReader(const std::filesystem::path& path, RawFormat format,
                             RawMarking marking)
    : format_(std::move(format)), marking_(std::move(marking)) {
  format_.validate();
  const auto file = std::make_shared<InputFile>(path);
  if (!file->size())
    throw IoError(path.string(),
                  "found a pipe or device; expected a file, read in slices (decode takes frames "
                  "from a pipe as RAW -)");
  frames_ = frames_in(*file->size(), format_, path.string());
  read_at_ = [file](std::uint64_t offset, std::span<std::byte> into) {
    file->read_at(offset, into);
  };
}

RawDumpReader::RawDumpReader(std::span<const std::byte> bytes, RawFormat format, RawMarking marking)
    : read_at_([bytes](std::uint64_t offset, std::span<std::byte> into) {
        std::ranges::copy(bytes.subspan(offset, into.size()), into.begin());
      }),
      format_(std::move(format)),
      marking_(std::move(marking)) {
  format_.validate();
  frames_ = frames_in(bytes.size(), format_, "bytes");
}

/// Row `row` of an image of the file.
void RawDumpReader::read_file_row(int frame, std::size_t image, std::size_t row,
                                  std::vector<std::byte>& bytes,
                                  std::vector<double>& numbers) const {
  const RawFormat& f = format_;
  const std::uint64_t image_at =
      f.header_bytes + static_cast<std::uint64_t>(frame) * f.frame_bytes() + f.frame_header_bytes +
      image * (f.image_header_bytes + f.image_bytes()) + f.image_header_bytes;
  const std::size_t count = f.numbers_per_row();
  numbers.resize(count);
  std::uint64_t at = image_at + row * (f.row_bytes > 0 ? f.row_bytes : f.tight_row_bytes());
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
  unpack_numbers(f, bytes, first_bit, numbers);
}

template <typename Number>
void RawDumpReader::read_rows(int frame, int first_row, int rows, Number* numbers) const {
  const RawFormat& f = format_;
  const auto width = static_cast<std::size_t>(f.width),
             measurements = static_cast<std::size_t>(f.measurements),
             outputs = static_cast<std::size_t>(f.output_measurements());
  const bool is_unsigned = f.numbers == RawNumbers::integers && !f.is_signed;
  const double black_level =
      f.black_level == 0.0 && is_unsigned ? marking_.unsigned_black_level : f.black_level;
  std::vector<std::byte> bytes;
  std::vector<double> row_numbers, pixels(width * measurements);
  for (int r = 0; r < rows; ++r) {
    const int scene_row = first_row + r;
    const auto file_row =
        static_cast<std::size_t>(f.flip_rows ? f.height - 1 - scene_row : scene_row);
    // Measurement k of the code at column c stands at pixels[c * measurements + k].
    const auto measurement = [&](std::size_t j) {
      return f.order.empty() ? j : static_cast<std::size_t>(f.order[j]);
    };
    const auto put = [&](std::size_t j, const double* from, std::size_t stride) {
      double* const to = pixels.data() + measurement(j);
      for (std::size_t i = 0; i < width; ++i)
        to[(f.flip_columns ? width - 1 - i : i) * measurements] = from[i * stride];
    };
    if (f.layout == RawOrder::interleaved) {
      read_file_row(frame, 0, file_row, bytes, row_numbers);
      for (std::size_t j = 0; j < measurements; ++j) put(j, row_numbers.data() + j, measurements);
    } else {
      const bool planar = f.layout == RawOrder::planar;
      for (std::size_t j = 0; j < measurements; ++j) {
        read_file_row(frame, planar ? j : 0, planar ? file_row : file_row * measurements + j, bytes,
                      row_numbers);
        put(j, row_numbers.data(), 1);
      }
    }
    Number* const out = numbers + static_cast<std::size_t>(r) * width * outputs;
    if (f.subtract_taps)
      for (std::size_t i = 0; i < width * outputs; ++i)
        out[i] = static_cast<Number>(marking_.difference(pixels[2 * i], pixels[2 * i + 1]));
    else
      for (std::size_t i = 0; i < pixels.size(); ++i)
        out[i] = static_cast<Number>(
            marking_.replacement(pixels[i], is_unsigned).value_or(pixels[i] - black_level));
  }
}

template void RawDumpReader::read_rows(int, int, int, float*) const;
template void RawDumpReader::read_rows(int, int, int, double*) const;

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/raw_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <span>
#include <string>

#include "io/image_limits.hpp"
#include "io/images/array_image.hpp"
#include "io/images/raw_dump_reader.hpp"
#include "io/images/raw_sizes.hpp"
#include "io/shared/file_kind.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

/// Unpacking, or turning axes round, takes a second copy for a while.
void check_memory(std::uint64_t bytes, const RawReadOptions& options, const std::string& file,
                  std::string_view what) {
  if (bytes <= options.max_in_memory / 2) return;
  throw IoError(file, fmt::format("{} cannot be read in parts and would take {:.3g} MB of memory; "
                                  "expected at most {:.3g} MB (save it as .npy in C order; "
                                  "--memory-mb allows more)",
                                  what, 2e-6 * static_cast<double>(bytes),
                                  1e-6 * static_cast<double>(options.max_in_memory)));
}

NpyArray read_npz_array(const std::filesystem::path& path, const RawReadOptions& options) {
  const NpzReader archive(path);
  const std::string name = name_called_or_only(archive, "raw", path.string());
  check_memory(archive.unpacked_bytes(name), options, path.string(), "an .npz");
  return archive.read(name);
}

std::uint64_t bytes_of(const NpyReader& reader) {
  return std::accumulate(reader.shape().begin(), reader.shape().end(),
                         std::uint64_t{item_size(reader.type())}, std::multiplies<>());
}

}  // namespace

RawFramesReader::RawFramesReader(const std::filesystem::path& path, const RawReadOptions& options)
    : layout_(options.layout) {
  options.format ? open_dump(path, options) : open_array(path, options);
}

RawFramesReader::~RawFramesReader() = default;
RawFramesReader::RawFramesReader(RawFramesReader&&) noexcept = default;

void RawFramesReader::open_array(const std::filesystem::path& path, const RawReadOptions& options) {
  if (known_extension(path, {".npy", ".npz"}) == ".npz") {
    whole_ = read_npz_array(path, options);
  } else {
    file_.emplace(path);
    if (file_->fortran_order()) {
      check_memory(bytes_of(*file_), options, path.string(), "an .npy in Fortran order");
      whole_ = file_->read_all();
      file_.reset();
    }
  }
  type_ = file_ ? file_->type() : whole_.type();
  sizes_ =
      checked_raw_sizes(type_, file_ ? file_->shape() : whole_.shape(), options, path.string());
  holds_integers_ = type_ != NpyType::float32 && type_ != NpyType::float64;
  if (type_ != NpyType::int16) return;
  type_ = NpyType::float32;
  if (!file_) whole_ = NpyArray::of<float>(whole_.shape(), whole_.to_floats());
}

void RawFramesReader::open_dump(const std::filesystem::path& path, const RawReadOptions& options) {
  dump_ = std::make_unique<RawDumpReader>(path, *options.format);
  const RawFormat& format = dump_->format();
  type_ = format.needs_doubles() ? NpyType::float64 : NpyType::float32;
  holds_integers_ = format.numbers == RawNumbers::integers;
  layout_ = RawLayout::interleaved;
  sizes_.frames = dump_->frames();
  sizes_.height = format.height;
  sizes_.width = format.width;
  sizes_.measurements = format.output_measurements();
  check_image_size(path.string(), static_cast<std::uint64_t>(format.height),
                   static_cast<std::uint64_t>(format.width));
  if (options.measurements && *options.measurements != sizes_.measurements)
    throw IoError(path.string(),
                  fmt::format("the description gives {} measurements per pixel; expected {} as the "
                              "code takes",
                              sizes_.measurements, *options.measurements));
}

std::size_t RawFramesReader::row_bytes() const {
  return static_cast<std::size_t>(width()) * static_cast<std::size_t>(measurements()) *
         item_size(type_);
}

RawView RawFramesReader::read_rows(int frame, int first_row, int rows,
                                   std::vector<std::byte>& buffer) const {
  require(frame >= 0 && frame < frames(), "frame", frame,
          fmt::format("must be 0 .. {}", frames() - 1));
  require(first_row >= 0 && first_row <= height(), "first_row", first_row,
          fmt::format("must be 0 .. {}", height()));
  require(rows >= 0 && rows <= height() - first_row, "rows", rows,
          fmt::format("must be 0 .. {} from row {} on", height() - first_row, first_row));
  if (dump_) {
    buffer.resize(static_cast<std::size_t>(rows) * row_bytes());
    if (type_ == NpyType::float64)
      dump_->read_rows(frame, first_row, rows, reinterpret_cast<double*>(buffer.data()));
    else
      dump_->read_rows(frame, first_row, rows, reinterpret_cast<float*>(buffer.data()));
    return view_of(buffer.data(), rows, rows);
  }
  if (!file_) return rows_in_memory(frame, first_row, rows);
  if (file_->type() == NpyType::int16) {
    std::vector<std::byte> stored;
    read_stored_rows(frame, first_row, rows, stored);
    const std::size_t count = stored.size() / sizeof(std::int16_t);
    buffer.resize(count * sizeof(float));
    std::copy_n(reinterpret_cast<const std::int16_t*>(stored.data()), count,
                reinterpret_cast<float*>(buffer.data()));
  } else {
    read_stored_rows(frame, first_row, rows, buffer);
  }
  return view_of(buffer.data(), rows, rows);
}

/// The rows as the file's items.
void RawFramesReader::read_stored_rows(int frame, int first_row, int rows,
                                       std::vector<std::byte>& buffer) const {
  const bool planar = layout_ == RawLayout::planar;
  const auto planes = static_cast<std::size_t>(planar ? measurements() : 1);
  const std::size_t item = item_size(file_->type()),
                    row_items = row_bytes() / item_size(type_) / planes;
  const std::size_t plane_bytes = static_cast<std::size_t>(rows) * row_items * item;
  buffer.resize(planes * plane_bytes);
  for (std::size_t plane = 0; plane < planes; ++plane) {
    const std::size_t row =
        (static_cast<std::size_t>(frame) * planes + plane) * static_cast<std::size_t>(height()) +
        static_cast<std::size_t>(first_row);
    file_->read_items(row * row_items, std::span(buffer).subspan(plane * plane_bytes, plane_bytes));
  }
}

RawView RawFramesReader::rows_in_memory(int frame, int first_row, int rows) const {
  const std::size_t frame_bytes = row_bytes() * static_cast<std::size_t>(height());
  const std::size_t step =
      row_bytes() / static_cast<std::size_t>(layout_ == RawLayout::planar ? measurements() : 1);
  const std::byte* first = whole_.bytes().data() + static_cast<std::size_t>(frame) * frame_bytes +
                           static_cast<std::size_t>(first_row) * step;
  return view_of(first, rows, height());
}

/// @param rows_of_a_plane  from one measurement's image to the next, if the layout is planar
RawView RawFramesReader::view_of(const std::byte* data, int rows, int rows_of_a_plane) const {
  const auto view = [&](const auto* numbers) {
    if (layout_ == RawLayout::interleaved)
      return RawView::interleaved(numbers, rows, width(), measurements());
    RawView planes = RawView::planar(numbers, rows, width(), measurements());
    planes.measurement_stride = std::ptrdiff_t{rows_of_a_plane} * width();
    return planes;
  };
  switch (type_) {
    case NpyType::uint8:
      return view(reinterpret_cast<const std::uint8_t*>(data));
    case NpyType::uint16:
      return view(reinterpret_cast<const std::uint16_t*>(data));
    case NpyType::float64:
      return view(reinterpret_cast<const double*>(data));
    default:  // checked_raw_sizes() lets no other type through
      return view(reinterpret_cast<const float*>(data));
  }
}

RawFrames RawFramesReader::read_frame(int index) const {
  std::vector<std::byte> buffer;
  const RawView view = read_rows(index, 0, height(), buffer);
  RawFrames frame = sizes_;
  frame.frames = 1;
  frame.values.resize(frame.pixels_per_frame() * static_cast<std::size_t>(frame.measurements));
  copy_pixels(view, 0, view.pixels(), frame.values.data());
  return frame;
}

}  // namespace tofsmith

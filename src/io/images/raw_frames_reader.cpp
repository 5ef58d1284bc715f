// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/raw_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <numeric>
#include <span>
#include <string>

#include "decode/shared/marked_raw.hpp"
#include "io/arrays/shared/array_matrix.hpp"
#include "io/image_limits.hpp"
#include "io/images/array_image.hpp"
#include "io/images/raw_dump_reader.hpp"
#include "io/shared/read_file.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

/// Unpacking or transposing temporarily needs a second copy.
void check_memory(std::uint64_t bytes, const RawReadOptions& options, const std::string& file,
                  std::string_view what) {
  if (bytes <= options.max_in_memory / 2) return;
  throw IoError(
      file,
      fmt::format("{} cannot be read in parts and would require {:.3g} MB of memory; expected at "
                  "most {:.3g} MB (save it as .npy in C order; --memory-mb allows more)",
                  what, 2e-6 * static_cast<double>(bytes),
                  1e-6 * static_cast<double>(options.max_in_memory)));
}

NpyArray read_npz_array(const std::filesystem::path& path, const RawReadOptions& options) {
  const NpzReader archive(path);
  const std::string name = options.dataset.empty()
                               ? name_called_or_only(archive, "raw", path.string())
                               : options.dataset;
  check_memory(archive.unpacked_bytes(name), options, path.string(), "an .npz");
  return archive.read(name, options.max_in_memory);
}

void refuse_dataset(const std::filesystem::path& path, const RawReadOptions& options) {
  if (options.dataset.empty()) return;
  throw IoError(path.string(), fmt::format("found a file with one unnamed array; expected .npz or "
                                           ".h5, because the data set '{}' was requested",
                                           options.dataset));
}

std::uint64_t bytes_of(const NpyReader& reader) {
  return std::accumulate(reader.shape().begin(), reader.shape().end(),
                         std::uint64_t{item_size(reader.type())}, std::multiplies<>());
}

/// Types of RawView are unchanged; others become the smallest type that can represent them (64-bit
/// integers up to 2^53).
NpyType decoded_type(NpyType stored) {
  switch (stored) {
    case NpyType::uint8:
    case NpyType::uint16:
    case NpyType::float32:
    case NpyType::float64:
      return stored;
    case NpyType::int8:
    case NpyType::int16:
    case NpyType::float16:
      return NpyType::float32;
    default:
      return NpyType::float64;
  }
}

NpyArray in_type(NpyArray array, NpyType type) {
  if (array.type() == type) return array;
  if (type == NpyType::float32) return NpyArray::of<float>(array.shape(), array.to_floats());
  return NpyArray::of<double>(array.shape(), array.to_doubles());
}

/// Adds missing axes to (H, W) and (F, H, W).
NpyShape with_measurements(const NpyShape& shape, const std::string& file) {
  if (shape.size() == 2) return {1, shape[0], shape[1]};
  if (shape.size() == 3) return {shape[0], 1, shape[1], shape[2]};
  throw IoError(file, fmt::format("found an array of shape {}; expected (H, W) or (F, H, W), "
                                  "because each of several files contains one measurement",
                                  describe_shape(shape)));
}

std::string describe_sizes(const RawFramesReader& reader) {
  return fmt::format("{} frame{} of {} x {}", reader.frames(), reader.frames() == 1 ? "" : "s",
                     reader.height(), reader.width());
}

}  // namespace

RawFramesReader::RawFramesReader(const std::filesystem::path& path, const RawReadOptions& options)
    : RawFramesReader(std::vector{path}, options) {}

RawFramesReader::RawFramesReader(const std::filesystem::path& path, const RawReadOptions& options,
                                 OneMeasurement)
    : layout_(options.layout) {
  options.format ? open_dump(path, options) : open_array(path, options, true);
}

RawFramesReader::RawFramesReader(const std::vector<std::filesystem::path>& files,
                                 const RawReadOptions& options)
    : layout_(options.layout) {
  require(!files.empty(), "raw", "no file", "must be one file, or one per measurement");
  if (files.size() > 1)
    open_parts(files, options);
  else if (options.format)
    open_dump(files.front(), options);
  else
    open_array(files.front(), options, false);
}

void RawFramesReader::open_array(const std::filesystem::path& path, const RawReadOptions& options,
                                 bool is_one_measurement) {
  const std::string extension = lower_extension(path);
  const bool is_image = is_grey_image(path);
  if (!is_image && extension != ".npy" && extension != ".npz" && extension != ".h5" &&
      extension != ".hdf5")
    throw IoError(path.string(),
                  fmt::format("found {}; expected .npy, .npz or .h5, images (.png .tiff .pgm, one "
                              "per measurement), or for a sensor's dump its "
                              "description (--raw-format, docs/raw_formats.md)",
                              extension.empty() ? "no extension"
                                                : fmt::format("the extension '{}'", extension)));
  if (is_image) {
    refuse_dataset(path, options);
    whole_ = read_grey_image(path);
    check_memory(whole_.bytes().size(), options, path.string(), "an image");
  } else if (extension == ".npz") {
    whole_ = read_npz_array(path, options);
  } else if (extension != ".npy") {
    file_ = make_hidden<StoredArray>(open_hdf5(path, options.dataset, options.max_in_memory / 2));
  } else {
    refuse_dataset(path, options);
    NpyReader reader(path);
    if (reader.fortran_order()) {
      check_memory(bytes_of(reader), options, path.string(), "an .npy in Fortran order");
      whole_ = reader.read_all();
    } else {
      file_ = make_hidden<StoredArray>(stored_array(std::move(reader)));
    }
  }
  const NpyType stored = file_ ? file_->type : whole_.type();
  const NpyShape& shape = file_ ? file_->shape : whole_.shape();
  sizes_ = checked_raw_sizes(stored,
                             is_one_measurement ? with_measurements(shape, path.string()) : shape,
                             options, path.string());
  holds_integers_ = !is_float(stored);
  holds_unsigned_ = is_unsigned(stored);
  marking_ = options.marking;
  check_markers(marking_.markers, stored, path.string());
  type_ = decoded_type(stored);
  if (!file_) whole_ = in_type(std::move(whole_), type_);
}

void RawFramesReader::open_parts(const std::vector<std::filesystem::path>& files,
                                 const RawReadOptions& options) {
  const std::string first = files.front().string();
  if (options.measurements && files.size() != static_cast<std::size_t>(*options.measurements))
    throw IoError(first, fmt::format("found {} files, one per measurement; expected {}, the number "
                                     "of measurements of the code",
                                     files.size(), *options.measurements));
  RawReadOptions one = options;
  one.measurements = 1;
  one.layout = RawLayout::planar;
  one.max_in_memory = options.max_in_memory / files.size();
  for (auto file = files.begin(); file != files.end(); ++file)
    if (std::find(files.begin(), file, *file) != file)
      throw IoError(file->string(), "is listed twice; expected one file per measurement");
  for (const std::filesystem::path& file : files) {
    parts_.push_back(RawFramesReader(file, one, OneMeasurement{}));
    const RawFramesReader &part = parts_.back(), &model = parts_.front();
    if (describe_sizes(part) != describe_sizes(model))
      throw IoError(file.string(), fmt::format("found {}; expected {} as in {}",
                                               describe_sizes(part), describe_sizes(model), first));
    if (part.type_ != model.type_ || part.holds_integers_ != model.holds_integers_ ||
        part.holds_unsigned_ != model.holds_unsigned_)
      throw IoError(
          file.string(),
          fmt::format("found numbers that are read as {}{}; expected {}{} as in {}",
                      name_of(part.type_), part.holds_integers_ ? " (whole)" : "",
                      name_of(model.type_), model.holds_integers_ ? " (whole)" : "", first));
  }
  type_ = parts_.front().type_;
  holds_integers_ = parts_.front().holds_integers_;
  holds_unsigned_ = parts_.front().holds_unsigned_;
  marking_ = options.marking;
  layout_ = RawLayout::planar;
  sizes_ = parts_.front().sizes_;
  sizes_.measurements = static_cast<int>(files.size());
}

void RawFramesReader::open_dump(const std::filesystem::path& path, const RawReadOptions& options) {
  refuse_dataset(path, options);
  dump_ = make_hidden<RawDumpReader>(path, *options.format, options.marking);
  const RawFormat& format = dump_->format();
  check_markers(options.marking.markers, format, path.string());
  type_ = format.needs_doubles() ? NpyType::float64 : NpyType::float32;
  holds_integers_ = format.numbers == RawNumbers::integers;
  layout_ = RawLayout::interleaved;
  sizes_.frames = dump_->frames();
  sizes_.height = format.output_height();
  sizes_.width = format.output_width();
  sizes_.measurements = format.output_measurements();
  check_image_size(path.string(), static_cast<std::uint64_t>(format.height),
                   static_cast<std::uint64_t>(format.width));
  if (options.measurements) check_measurements(format, *options.measurements, path.string());
}

std::size_t RawFramesReader::row_bytes() const {
  return static_cast<std::size_t>(width()) * static_cast<std::size_t>(measurements()) *
         item_size(type_);
}

std::size_t RawFramesReader::bytes_in_memory() const {
  std::size_t bytes = whole_.bytes().size() + (file_ ? file_->bytes_in_memory : 0);
  for (const RawFramesReader& part : parts_) bytes += part.bytes_in_memory();
  return bytes;
}

std::size_t RawFramesReader::marked_row_bytes() const {
  if (dump_) return dump_->block_row_bytes();
  if (!marking_.replaces_numbers()) return 0;
  return static_cast<std::size_t>(width()) * static_cast<std::size_t>(measurements()) *
         (type_ == NpyType::float64 ? sizeof(double) : sizeof(float));
}

RawView RawFramesReader::read_rows(int frame, int first_row, int rows,
                                   std::vector<std::byte>& buffer) const {
  RawView view = rows_as_stored(frame, first_row, rows, buffer);
  if (view.is_marked || !marking_.replaces_numbers()) return view;
  std::vector<std::byte> marked;
  view = mark_raw(view, marking_, marked);
  buffer.swap(marked);
  return view;
}

RawView RawFramesReader::rows_as_stored(int frame, int first_row, int rows,
                                        std::vector<std::byte>& buffer) const {
  require(frame >= 0 && frame < frames(), "frame", frame,
          fmt::format("must be in [0, {}]", frames() - 1));
  require(first_row >= 0 && first_row <= height(), "first_row", first_row,
          fmt::format("must be in [0, {}]", height()));
  require(rows >= 0 && rows <= height() - first_row, "rows", rows,
          fmt::format("must be in [0, {}] from row {} on", height() - first_row, first_row));
  if (!parts_.empty()) return rows_of_parts(frame, first_row, rows, buffer);
  if (dump_) {
    buffer.resize(static_cast<std::size_t>(rows) * row_bytes());
    if (type_ == NpyType::float64)
      dump_->read_rows(frame, first_row, rows, reinterpret_cast<double*>(buffer.data()));
    else
      dump_->read_rows(frame, first_row, rows, reinterpret_cast<float*>(buffer.data()));
    RawView view = view_of(buffer.data(), rows, rows);
    view.is_marked = true;
    return view;
  }
  if (!file_) return rows_in_memory(frame, first_row, rows);
  read_stored_rows(frame, first_row, rows, buffer);
  if (file_->type != type_) {
    NpyArray stored(file_->type, {buffer.size() / item_size(file_->type)});
    std::ranges::copy(buffer, stored.bytes().begin());
    const NpyArray numbers = in_type(std::move(stored), type_);
    buffer.assign(numbers.bytes().begin(), numbers.bytes().end());
  }
  return view_of(buffer.data(), rows, rows);
}

void RawFramesReader::read_stored_rows(int frame, int first_row, int rows,
                                       std::vector<std::byte>& buffer) const {
  const bool planar = layout_ == RawLayout::planar;
  const auto planes = static_cast<std::size_t>(planar ? measurements() : 1);
  const std::size_t item = item_size(file_->type),
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

RawView RawFramesReader::rows_of_parts(int frame, int first_row, int rows,
                                       std::vector<std::byte>& buffer) const {
  const std::size_t bytes = static_cast<std::size_t>(rows) * row_bytes() / parts_.size();
  buffer.resize(bytes * parts_.size());
  std::vector<std::byte> read;
  bool is_marked = false;
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const RawView part = parts_[k].rows_as_stored(frame, first_row, rows, read);
    std::visit([&](const auto* first) { std::memcpy(buffer.data() + k * bytes, first, bytes); },
               part.data);
    is_marked = part.is_marked;
  }
  RawView view = view_of(buffer.data(), rows, rows);
  view.is_marked = is_marked;
  return view;
}

/// @param rows_of_a_plane  rows between the images of two measurements
RawView RawFramesReader::view_of(const std::byte* data, int rows, int rows_of_a_plane) const {
  const auto view = [&](const auto* numbers) {
    const bool planar = layout_ == RawLayout::planar;
    RawView raw = planar ? RawView::planar(numbers, rows, width(), measurements())
                         : RawView::interleaved(numbers, rows, width(), measurements());
    if (planar) raw.measurement_stride = std::ptrdiff_t{rows_of_a_plane} * width();
    raw.was_unsigned = holds_unsigned_;
    return raw;
  };
  switch (type_) {
    case NpyType::uint8:
      return view(reinterpret_cast<const std::uint8_t*>(data));
    case NpyType::uint16:
      return view(reinterpret_cast<const std::uint16_t*>(data));
    case NpyType::float64:
      return view(reinterpret_cast<const double*>(data));
    default:  // checked_raw_sizes() rejects other types
      return view(reinterpret_cast<const float*>(data));
  }
}

RawFrames read_raw_frames(const std::vector<std::filesystem::path>& files,
                          const RawReadOptions& options) {
  const RawFramesReader reader(files, options);
  RawFrames all{reader.frames(), reader.height(), reader.width(), reader.measurements(), {}};
  all.values.resize(all.pixels_per_frame() * static_cast<std::size_t>(all.measurements) *
                    static_cast<std::size_t>(all.frames));
  std::vector<std::byte> buffer;
  for (int f = 0; f < all.frames; ++f) {
    const RawView view = reader.read_rows(f, 0, all.height, buffer);
    copy_pixels(view, 0, view.pixels(), all.frame(f));
  }
  return all;
}

RawFrames read_raw_frames(const std::filesystem::path& path, std::optional<int> measurements) {
  return read_raw_frames(std::vector{path}, {.measurements = measurements});
}

void write_raw_frames(const std::filesystem::path& path, const RawFrames& raw,
                      OutputPolicy policy) {
  const std::string extension = known_extension(path, {".npy", ".npz"});
  require(raw.frames >= 1, "frames", raw.frames, "must be >= 1");
  require(raw.height >= 1, "height", raw.height, "must be >= 1");
  require(raw.width >= 1, "width", raw.width, "must be >= 1");
  require(raw.measurements >= 1, "measurements", raw.measurements, "must be >= 1");
  NpyShape shape = {static_cast<std::size_t>(raw.height), static_cast<std::size_t>(raw.width),
                    static_cast<std::size_t>(raw.measurements)};
  if (raw.frames > 1) shape.insert(shape.begin(), static_cast<std::size_t>(raw.frames));
  const auto array = NpyArray::of<float>(shape, raw.values);
  if (extension == ".npy")
    write_npy(path, array, policy);
  else
    write_npz(path, {{"raw", array}}, policy);
}

}  // namespace tofsmith

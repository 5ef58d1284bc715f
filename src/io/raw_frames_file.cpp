// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/raw_frames_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "io/array_image.hpp"
#include "io/file_kind.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/image_limits.hpp"
#include "tofsmith/io/npz.hpp"

namespace tofsmith {
namespace {

/// Sizes without values, after everything about the array has been checked.
RawFrames checked_sizes(NpyType type, const NpyShape& shape, std::optional<int> measurements,
                        const std::string& file) {
  if (type != NpyType::uint8 && type != NpyType::uint16 && type != NpyType::float32 &&
      type != NpyType::float64)
    throw IoError(file, fmt::format("found items of type {}; expected float32, float64, uint16 or "
                                    "uint8",
                                    name_of(type)));
  if (shape.size() != 3 && shape.size() != 4)
    throw IoError(file, fmt::format("found an array of shape {}; expected (H, W, K) or "
                                    "(F, H, W, K)",
                                    describe_shape(shape)));
  const bool several = shape.size() == 4;
  const std::size_t frames = several ? shape[0] : 1, height = shape[several ? 1 : 0],
                    width = shape[several ? 2 : 1], found = shape.back();
  constexpr std::size_t most = std::numeric_limits<int>::max();
  if (frames < 1 || frames > most || found < 1 || found > most)
    throw IoError(file, fmt::format("found an array of shape {}; expected at least one frame and "
                                    "one measurement, and at most {}",
                                    describe_shape(shape), most));
  check_image_size(file, height, width);
  if (measurements && found != static_cast<std::size_t>(*measurements))
    throw IoError(file, fmt::format("found {} measurements per pixel, shape {}; expected {} as "
                                    "the code takes",
                                    found, describe_shape(shape), *measurements));
  RawFrames sizes;
  sizes.frames = static_cast<int>(frames);
  sizes.height = static_cast<int>(height);
  sizes.width = static_cast<int>(width);
  sizes.measurements = static_cast<int>(found);
  return sizes;
}

/// Converts slice by slice, so that the file's own items never stand in memory as a whole.
std::vector<float> read_floats(const NpyReader& reader) {
  if (reader.fortran_order()) return reader.read_all().to_floats();  // slices are slow there
  const std::size_t rows = reader.shape()[0];
  std::size_t row_items = 1;
  for (std::size_t axis = 1; axis < reader.shape().size(); ++axis)
    row_items *= reader.shape()[axis];
  constexpr std::size_t slice_items = std::size_t{1} << 22;
  const std::size_t slice = std::max<std::size_t>(1, slice_items / row_items);

  std::vector<float> values;
  values.reserve(rows * row_items);
  for (std::size_t row = 0; row < rows; row += slice) {
    const auto part = reader.read_rows(row, std::min(slice, rows - row)).to_floats();
    values.insert(values.end(), part.begin(), part.end());
  }
  return values;
}

std::string raw_extension(const std::filesystem::path& path) {
  return known_extension(path, {".npy", ".npz"});
}

}  // namespace

RawFrames read_raw_frames(const std::filesystem::path& path, std::optional<int> measurements) {
  const std::string file = path.string();
  if (raw_extension(path) == ".npy") {
    const NpyReader reader(path);
    RawFrames raw = checked_sizes(reader.type(), reader.shape(), measurements, file);
    raw.values = read_floats(reader);
    return raw;
  }
  const NpyArray array = array_called_or_only(NpzReader(path), "raw", file);
  RawFrames raw = checked_sizes(array.type(), array.shape(), measurements, file);
  raw.values = array.to_floats();
  return raw;
}

void write_raw_frames(const std::filesystem::path& path, const RawFrames& raw,
                      OutputPolicy policy) {
  const std::string extension = raw_extension(path);
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

RawFramesReader::RawFramesReader(const std::filesystem::path& path, std::optional<int> measurements)
    : reader_(path) {
  known_extension(path, {".npy"});
  sizes_ = checked_sizes(reader_.type(), reader_.shape(), measurements, path.string());
}

RawFrames RawFramesReader::read_frame(int index) const {
  require(index >= 0 && index < frames(), "index", index,
          fmt::format("must be 0 .. {}", frames() - 1));
  RawFrames frame = sizes_;
  frame.frames = 1;
  const bool one_frame = reader_.shape().size() == 3;
  frame.values = one_frame ? reader_.read_all().to_floats()
                           : reader_.read_rows(static_cast<std::size_t>(index), 1).to_floats();
  return frame;
}

}  // namespace tofsmith

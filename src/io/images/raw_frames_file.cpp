// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/raw_frames.hpp"

#include <algorithm>
#include <string>

#include "io/images/array_image.hpp"
#include "io/images/raw_sizes.hpp"
#include "io/shared/file_kind.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

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
  const RawReadOptions options{.measurements = measurements};
  if (raw_extension(path) == ".npy") {
    const NpyReader reader(path);
    RawFrames raw = checked_raw_sizes(reader.type(), reader.shape(), options, file);
    raw.values = read_floats(reader);
    return raw;
  }
  const NpyArray array = array_called_or_only(NpzReader(path), "raw", file);
  RawFrames raw = checked_raw_sizes(array.type(), array.shape(), options, file);
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

}  // namespace tofsmith

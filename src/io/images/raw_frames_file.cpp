// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/raw_frames.hpp"

#include <string>

#include "io/shared/file_kind.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

std::string raw_extension(const std::filesystem::path& path) {
  return known_extension(path, {".npy", ".npz"});
}

}  // namespace

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

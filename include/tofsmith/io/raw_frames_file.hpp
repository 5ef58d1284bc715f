// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "tofsmith/core/array.hpp"
#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/io/npy_stream.hpp"

namespace tofsmith {

/// Raw measurements of shape (H, W, K), or (F, H, W, K) for several frames, from .npy or .npz (the
/// array "raw", or the only one): uint8, uint16, float32 or float64. Values are kept as they are,
/// NaN and infinity too.
/// @param measurements  K that the code asks for, if one is known
/// @throws IoError if the extension, the shape or the type is another, or K differs
RawFrames read_raw_frames(const std::filesystem::path& path,
                          std::optional<int> measurements = std::nullopt);

/// Writes float32 to .npy or .npz: (H, W, K) if there is one frame, (F, H, W, K) otherwise.
/// @throws std::invalid_argument if there are no values, or not as many as the sizes say
/// @throws IoError if the extension is another, or as AtomicFile does
void write_raw_frames(const std::filesystem::path& path, const RawFrames& raw, OutputPolicy policy);

/// Reads the frames of an .npy recording one after another, in the memory of one.
class RawFramesReader {
 public:
  /// @throws IoError as read_raw_frames()
  explicit RawFramesReader(const std::filesystem::path& path,
                           std::optional<int> measurements = std::nullopt);

  int frames() const { return sizes_.frames; }
  int height() const { return sizes_.height; }
  int width() const { return sizes_.width; }
  int measurements() const { return sizes_.measurements; }

  /// Frame `index` alone.
  /// @throws std::invalid_argument if there is no such frame
  /// @throws IoError if the file cannot be read
  RawFrames read_frame(int index) const;

 private:
  NpyReader reader_;
  RawFrames sizes_;  // without values
};

}  // namespace tofsmith

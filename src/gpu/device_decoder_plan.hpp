// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "gpu/device_decoder.hpp"
#include "gpu/device_tile.hpp"

namespace tofsmith {

/// Smallest part of a frame [pixels], and smallest part if splitting only overlaps copies with
/// kernels.
inline constexpr std::int64_t min_tile_pixels = 1024, min_overlapped_pixels = 65536;

struct FramePart {
  std::int64_t first = 0, count = 0;
};

struct FrameDone {
  std::int64_t pixels = 0, by_decoder = 0;
};

struct DeviceDecoder::Plan {
  Plan(const Device& device_, const Decoder& decoder_, const DeviceOptions& options_);

  /// Decodes the remaining pixels of a frame in parts; uploads overlap the kernels of the previous
  /// part.
  /// @param done  valid even if this throws
  void decode_from(FrameDone& done, const FrameSource& frame, const DecodedView& planes,
                   const Progress& progress);
  /// Decodes a frame, in smaller parts if the device lacks memory; returns the number of pixels
  /// that the CPU decoded.
  std::int64_t decode_all(const FrameSource& frame, const DecodedView& planes,
                          const Progress& progress);
  /// Decodes the pixels in the tile; returns the number that the CPU decoded.
  /// @param planes  start at the tile's first pixel
  std::int64_t decode_what_is_there(const DecodedView& planes);
  static void start(DeviceTile& in, const FrameSource& frame, const FramePart& part,
                    const DecodedView& planes);
  /// Downloads the planes of a part; returns the number of pixels that the CPU decoded.
  std::int64_t finish(DeviceTile& in, const FrameSource& frame, const FramePart& part,
                      const DecodedView& planes) const;
  /// Decodes open pixels on the CPU.
  /// @param numbers  of the open pixels, as a frame of one row
  void decode_open_pixels(const RawView& numbers, const std::vector<std::int32_t>& open,
                          const DecodedView& planes) const;

  Device device;
  const Decoder& decoder;
  DeviceOptions options;
  std::mutex mutex;  // for the members below
  DeviceTile tile;
  std::unique_ptr<DeviceTile> other_tile;  // set once a frame is split
  std::int64_t tile_pixels;                // per part

 private:
  std::int64_t pixels_of_part(std::int64_t pixels) const;
  void decode_open_pixels_of(DeviceTile& in, const FrameSource& frame, const FramePart& part,
                             const std::vector<std::int32_t>& open,
                             const DecodedView& planes) const;
};

}  // namespace tofsmith

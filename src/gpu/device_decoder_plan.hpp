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

/// Parts of a frame are no smaller [pixels]; and where all of it fits, so that copies of one run
/// beside kernels of another.
inline constexpr std::int64_t min_tile_pixels = 1024, min_overlapped_pixels = 65536;

/// Pixels first .. first + count - 1 of a frame.
struct FramePart {
  std::int64_t first = 0, count = 0;
};

/// How far a frame is decoded, and how many of those pixels the decoder decoded.
struct FrameDone {
  std::int64_t pixels = 0, by_decoder = 0;
};

/// What a DeviceDecoder has.
struct DeviceDecoder::Plan {
  Plan(const Device& device_, const Decoder& decoder_, const DeviceOptions& options_);

  /// Decodes pixels of a frame from those that are done on, in parts: while one is decoded in its
  /// tile, the next is brought to another.
  /// @param done  how far it came, also when it throws
  void decode_from(FrameDone& done, const FrameSource& frame, const DecodedView& planes,
                   const Progress& progress);
  /// Decodes a frame, in smaller parts where the device lacks memory.
  /// @return how many pixels the decoder decoded
  std::int64_t decode_all(const FrameSource& frame, const DecodedView& planes,
                          const Progress& progress);
  /// Decodes pixels that are in the tile. @param planes  from the first of them on
  /// @return how many the decoder decoded
  std::int64_t decode_what_is_there(const DecodedView& planes);
  /// Begins to decode a part in a tile: brings it there and starts its kernels.
  static void start(DeviceTile& in, const FrameSource& frame, const FramePart& part,
                    const DecodedView& planes);
  /// Waits for it and brings its planes back. @return how many pixels the decoder decoded
  std::int64_t finish(DeviceTile& in, const FrameSource& frame, const FramePart& part,
                      const DecodedView& planes) const;
  /// Has the decoder decode pixels that are open to where they belong.
  /// @param numbers  a frame of one row of them
  void decode_open_pixels(const RawView& numbers, const std::vector<std::int32_t>& open,
                          const DecodedView& planes) const;

  Device device;
  const Decoder& decoder;
  DeviceOptions options;
  std::mutex mutex;  // of what follows
  DeviceTile tile;
  std::unique_ptr<DeviceTile> other_tile;  // once a frame goes in parts
  std::int64_t tile_pixels;                // of each, at most

 private:
  std::int64_t pixels_of_part(std::int64_t pixels) const;
  void decode_open_pixels_of(DeviceTile& in, const FrameSource& frame, const FramePart& part,
                             const std::vector<std::int32_t>& open,
                             const DecodedView& planes) const;
};

}  // namespace tofsmith

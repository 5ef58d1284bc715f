// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <mutex>
#include <vector>

#include "gpu/device_tile.hpp"

namespace tofsmith {

/// Parts of a frame are no smaller [pixels].
inline constexpr std::int64_t min_tile_pixels = 1024;

/// What a DeviceDecoder has.
struct DeviceDecoder::Plan {
  Plan(const Device& device_, const Decoder& decoder_, const DeviceOptions& options_);

  /// Brings pixels of a frame to the tile and has them decoded.
  /// @param planes  from the first pixel on
  /// @return how many pixels the decoder decoded
  std::int64_t decode_tile(const RawView& raw, std::int64_t first, std::int64_t count,
                           const DecodedView& planes);
  /// The same of pixels that are in the tile.
  std::int64_t decode_what_is_there(const DecodedView& planes);
  /// Has the decoder decode pixels that are open to where they belong.
  /// @param numbers  a frame of one row of them
  void decode_open_pixels(const RawView& numbers, const std::vector<std::int32_t>& open,
                          const DecodedView& planes) const;

  Device device;
  const Decoder& decoder;
  DeviceOptions options;
  std::mutex mutex;  // of what follows
  DeviceTile tile;
  std::int64_t tile_pixels;
};

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "gpu/device_raw.hpp"
#include "gpu/device_tables.hpp"
#include "tofsmith/core/hidden.hpp"
#include "tofsmith/gpu.hpp"

namespace tofsmith {

/// Raw numbers of open pixels, K each, with the number averaged.
class OpenNumbers {
 public:
  OpenNumbers(std::vector<float> numbers, int measurements, const NoiseRatios& noise);
  /// As a frame of one row.
  RawView view() const;

 private:
  int measurements_;
  NoiseRatios noise_;
  std::vector<float> numbers_, averaged_;
};

/// Pixels on a device: uploaded or written there, decoded, and downloaded.
class DeviceTile {
 public:
  /// @param decoder  must outlive this object
  DeviceTile(const Device& device, const Decoder& decoder, bool use_doubles);

  /// Upper limit, with all planes.
  std::int64_t bytes_per_pixel() const;

  void bring(const FrameSource& frame, std::int64_t first, std::int64_t count) {
    frame.bring(queue_, raw_, first, count);
  }
  /// Reserves memory for pixels that a kernel writes.
  const DeviceRaw& reserve_planes(std::int64_t pixels, const NoiseRatios& noise = {});
  /// @param wanted  planes that are null are not computed
  void decode(const DecodedView& wanted);
  /// @param to  starts at the tile's first pixel
  void fetch(const DecodedView& to) const;
  /// Keeps the decoder's tables.
  void release();
  /// Pixels that the CPU must decode; may contain duplicates.
  std::vector<std::int32_t> open_pixels() const;
  std::vector<float> open_numbers(const std::vector<std::int32_t>& open);
  /// Writes depths and deviations decoded by the CPU.
  void put_depth(const std::vector<std::int32_t>& open, const std::vector<float>& depth_m,
                 const std::vector<float>& deviation_m);

  const DeviceQueue& queue() const { return queue_; }
  const DeviceRaw& raw() const { return raw_; }
  const DeviceMemory* plane(DecodedPlane plane) const {
    return &planes_[static_cast<std::size_t>(plane)];
  }

 private:
  DeviceMemory* room(DeviceMemory& memory, std::int64_t bytes) const {
    return reserve(queue_, memory, bytes);
  }
  const DeviceMemory* room_for(DecodedPlane plane, const DecodedView& wanted);
  void start_list_of_open();
  void find_bins(const MatchParameters& parameters, const DeviceMemory& bins) const;

  const OutputKernel& outputs_;
  int bin_count_;
  DecodeTables tables_;
  DeviceQueue queue_;
  DeviceKernel match_, write_, gather_, scatter_;
  DeviceMemory words_;  // of the tables
  DeviceRaw raw_;
  DeviceMemory bins_, best_bins_, opened_, open_, some_numbers_;
  std::array<DeviceMemory, plane_descriptions.size()> planes_;  // written_planes
};

/// A Decoder on a device. Pixels that single precision does not prove are decoded on the CPU, so
/// bins and statuses equal the CPU's; for float planes see frame_backend(). Thread-safe; calls are
/// serialized.
class DeviceDecoder {
 public:
  /// Compiles the kernels and uploads the tables.
  /// @param decoder  must outlive this object
  /// @throws std::invalid_argument for invalid options; IoError if the device fails
  DeviceDecoder(const Device& device, const Decoder& decoder, const DeviceOptions& options = {});
  DeviceDecoder(const Device& device, Decoder&& decoder,
                const DeviceOptions& options = {}) = delete;

  const Device& device() const;

  /// Decodes one frame, as Decoder::decode.
  /// @return number of pixels that the CPU decoded
  /// @throws std::invalid_argument if the shape does not fit; IoError if the device fails;
  ///     Interrupted if `progress` cancels. The last two may leave planes partly written.
  std::int64_t decode(const RawView& raw, const DecodedView& decoded,
                      const Progress& progress = {}) const;

  struct Plan;

 private:
  friend class DeviceFilter;
  friend class DeviceFrames;
  std::int64_t decode_source(const FrameSource& frame, const Device& its_device,
                             const DecodedView& decoded, const Progress& progress) const;
  Hidden<Plan> plan_;
};

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

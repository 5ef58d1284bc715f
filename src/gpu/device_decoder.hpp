// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "tofsmith/gpu.hpp"

namespace tofsmith {

struct FrameSource;

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
  ~DeviceDecoder();
  DeviceDecoder(DeviceDecoder&&) noexcept;
  DeviceDecoder& operator=(DeviceDecoder&&) noexcept;

  const Device& device() const;

  /// Decodes one frame, as Decoder::decode.
  /// @return number of pixels that the CPU decoded
  /// @throws std::invalid_argument if the shape does not fit; IoError if the device fails;
  ///     Interrupted if `progress` cancels. The last two may leave planes partly written.
  std::int64_t decode(const RawView& raw, const DecodedView& decoded,
                      const Progress& progress = {}) const;
  /// As above for a frame of `raw` (F, H, W, K).
  DepthImage decode(const RawFrames& raw, int frame = 0, const Progress& progress = {}) const;

  struct Plan;

 private:
  friend class DeviceFilter;
  friend class DeviceFrames;
  std::int64_t decode_source(const FrameSource& frame, const Device& its_device,
                             const DecodedView& decoded, const Progress& progress) const;
  std::unique_ptr<Plan> plan_;
};

}  // namespace tofsmith

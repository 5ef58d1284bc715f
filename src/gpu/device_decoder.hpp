// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "tofsmith/gpu.hpp"

namespace tofsmith {

struct FrameSource;

/// A Decoder whose work a device does. Bins and statuses are those of the Decoder, everywhere: what
/// single precision does not prove on the device, the Decoder decides here. Planes of floats are
/// the same bits where the device rounds quotients and roots correctly and has doubles, else they
/// differ in the last ones.
///
/// Safe to use from many threads, which wait for one another.
class DeviceDecoder {
 public:
  /// Compiles kernels for the table and brings its tables to the device.
  /// @param decoder  must outlive this one
  /// @throws std::invalid_argument for options; IoError if the device fails, with what its compiler
  ///         says of kernels
  DeviceDecoder(const Device& device, const Decoder& decoder, const DeviceOptions& options = {});
  DeviceDecoder(const Device& device, Decoder&& decoder,
                const DeviceOptions& options = {}) = delete;
  ~DeviceDecoder();
  DeviceDecoder(DeviceDecoder&&) noexcept;
  DeviceDecoder& operator=(DeviceDecoder&&) noexcept;

  const Device& device() const;

  /// Decodes one frame into the caller's planes, as Decoder::decode.
  /// @return how many pixels were left to the Decoder
  /// @throws std::invalid_argument if the shape does not fit; IoError if the device fails, with
  /// part
  ///         of the planes written; Interrupted if progress says so
  std::int64_t decode(const RawView& raw, const DecodedView& decoded,
                      const Progress& progress = {}) const;
  /// The same for frame `frame` of several (F, H, W, K), into a new image.
  DepthImage decode(const RawFrames& raw, int frame = 0, const Progress& progress = {}) const;

  struct Plan;  ///< of the implementation

 private:
  friend class DeviceFilter;
  friend class DeviceFrames;
  std::int64_t decode_source(const FrameSource& frame, const Device& its_device,
                             const DecodedView& decoded, const Progress& progress) const;
  std::unique_ptr<Plan> plan_;
};

}  // namespace tofsmith

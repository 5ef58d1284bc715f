// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// @file
/// All of tofsmith::gpu: averaging, filtering and decoding on OpenCL devices. Includes
/// tofsmith/core.hpp.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/core.hpp"

namespace tofsmith {

enum class DeviceKind { gpu, cpu, other };

std::string_view name_of(DeviceKind kind);

struct DeviceInfo {
  std::string name;
  std::string platform;
  std::string version;  ///< of OpenCL and of the driver
  DeviceKind kind = DeviceKind::other;
  std::uint64_t memory_bytes = 0;
  bool has_doubles = false;
  bool divides_as_processor = false;  ///< rounds quotients and square roots correctly
};

/// OpenCL device, which may be the CPU itself. Drivers are loaded on first use. Copies refer to the
/// same device.
class Device {
 public:
  /// Devices of all platforms in driver order; empty without driver.
  /// @throws IoError if this build has no OpenCL, or a driver fails
  static std::vector<Device> all();
  /// Why all() may be empty, and how to fix it.
  static std::string_view none_found();
  /// @param name  "gpu": the first GPU; a number: index in all(); else a part of the name of a
  ///              device or platform, case-insensitive
  /// @throws IoError if this build has no OpenCL, or no device matches (the message lists the
  ///          devices)
  static Device named(std::string_view name);
  /// Returns the first GPU; none also if this build has no OpenCL.
  static std::optional<Device> first_gpu();

  const DeviceInfo& info() const;

  struct State;
  explicit Device(std::shared_ptr<State> state) : state_(std::move(state)) {}
  State& state() const { return *state_; }

 private:
  std::shared_ptr<State> state_;
};

struct DeviceOptions {
  /// For pixels in flight and their planes, > 0. Larger frames are processed in parts. A filter
  /// needs at least the rows that one result depends on.
  double memory_mb = 512.0;
  /// If supported. Ambient light from raw numbers with black levels and gains then has the same
  /// bits as on the CPU.
  bool use_doubles = true;

  /// @throws InvalidArgument
  void validate() const;
};
auto fields_of(ConstOrNot<DeviceOptions> auto& o) {
  return std::tuple(
      Field("memory_mb", o.memory_mb, above(0), Help{"memory for frames in flight on the device"}),
      Field("use_doubles", o.use_doubles, Help{"compute in double precision where possible"}));
}

/// Smallest frame with a spatial filter that `auto` processes on a GPU. Without a filter, copying
/// takes longer than decoding on the CPU.
inline constexpr std::int64_t auto_min_pixels_to_filter = 75'000;

/// Returns the backend for a named device. Results equal the CPU's, bit for bit if the device
/// rounds quotients and roots correctly and supports doubles.
///
/// If the device lacks doubles, or with look-ahead, the CPU averages frames and filters them in
/// time.
/// @param device  "cpu"; "auto": the first GPU for large frames with a spatial filter and zncc,
///                else the CPU; else a name for Device::named()
/// @throws InvalidArgument for invalid options, or if a device is named and the method is not zncc
/// @throws IoError if there is no such device, or it fails
std::unique_ptr<FrameBackend> frame_backend(std::string_view device,
                                            std::unique_ptr<const DepthDecoder> decoder,
                                            const DeviceOptions& options = {});

}  // namespace tofsmith

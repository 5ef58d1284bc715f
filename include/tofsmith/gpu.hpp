// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// @file
/// All of tofsmith::gpu: averaging, filtering and decoding on OpenCL devices. Includes
/// tofsmith/core.hpp.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/core.hpp"

namespace tofsmith {

enum class DeviceKind { gpu, cpu, other };

/// Returns "gpu", "cpu" or "other".
std::string_view name_of(DeviceKind kind);

/// Properties of a device, from OpenCL.
struct DeviceInfo {
  std::string name;      ///< from the driver
  std::string platform;  ///< name of the OpenCL platform
  std::string version;   ///< versions of OpenCL and of the driver
  DeviceKind kind = DeviceKind::other;
  std::uint64_t memory_bytes = 0;
  bool has_doubles = false;           ///< supports double precision
  bool divides_as_processor = false;  ///< rounds quotients and square roots correctly
};

/// An OpenCL device, which may be the CPU itself. Drivers are loaded on first use. Copies refer to
/// the same device.
class Device {
 public:
  /// Returns the devices of all platforms in driver order; empty if no driver is installed.
  /// @throws IoError if this build has no OpenCL, or a driver fails
  static std::vector<Device> all();
  /// Explains why all() may be empty, and how to fix it.
  static std::string_view none_found();
  /// Returns the device with a given name.
  /// @param name  "gpu": the first GPU; a number: index in all(); else a part of the name of a
  ///              device or platform, case-insensitive
  /// @throws IoError if this build has no OpenCL, or no device matches (the message lists the
  ///         devices)
  static Device named(std::string_view name);
  /// Returns the first GPU, if there is one and this build has OpenCL.
  static std::optional<Device> first_gpu();

  const DeviceInfo& info() const;

  struct State;  ///< of the OpenCL implementation
  explicit Device(std::shared_ptr<State> state) : state_(std::move(state)) {}
  State& state() const { return *state_; }

 private:
  std::shared_ptr<State> state_;
};

/// Options for computing on a device.
struct DeviceOptions {
  /// Memory for pixels in flight and their planes [MB], > 0. Larger frames are processed in parts,
  /// which shrink if the device has less memory. A filter needs at least the rows that one result
  /// depends on.
  double memory_mb = 512.0;
  /// Computes in double precision if the device supports it. Ambient light from raw numbers with
  /// black levels and gains then has the same bits as on the CPU.
  bool use_doubles = true;

  /// @throws std::invalid_argument
  void validate() const;
};
auto fields_of(ConstOrNot<DeviceOptions> auto& o) {
  return std::tuple(
      Field("memory_mb", o.memory_mb, above(0), Help{"memory for frames in flight on the device"}),
      Field("use_doubles", o.use_doubles, Help{"compute in double precision where possible"}));
}

/// Smallest frame with a spatial filter [pixels] that `auto` processes on a GPU. Without a filter,
/// copying a frame takes longer than decoding it on the CPU.
inline constexpr std::int64_t auto_min_pixels_to_filter = 75'000;

/// Returns the backend for a named device. Results equal the CPU's, bit for bit if the device
/// rounds quotients and roots correctly and supports doubles.
///
/// A device averages frames only if it supports doubles, and filters them in time only without
/// look-ahead. Otherwise the CPU does both, and the device runs the spatial filter and decodes.
/// @param device  "cpu"; "auto": the first GPU for large frames with a spatial filter if the method
///                is zncc, else the CPU (no driver is loaded before a frame needs the GPU); else a
///                name for Device::named()
/// @throws std::invalid_argument for invalid options, or if a device is named and the method is not
///         zncc
/// @throws IoError if there is no such device, or it fails (with its compiler's messages)
std::unique_ptr<FrameBackend> frame_backend(std::string_view device,
                                            std::unique_ptr<const DepthDecoder> decoder,
                                            const DeviceOptions& options = {});

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// @file
/// All of tofsmith::gpu: averaging, filtering and decoding on OpenCL devices.
/// Includes tofsmith/core.hpp.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/core.hpp"

namespace tofsmith {

/// What a device is.
enum class DeviceKind { gpu, cpu, other };

/// "gpu", "cpu", "other".
std::string_view name_of(DeviceKind kind);

/// What OpenCL says of a device.
struct DeviceInfo {
  std::string name;      ///< as its driver gives it
  std::string platform;  ///< whose driver that is
  std::string version;   ///< of OpenCL, and of the driver
  DeviceKind kind = DeviceKind::other;
  std::uint64_t memory_bytes = 0;
  bool has_doubles = false;           ///< arithmetic in double precision
  bool divides_as_processor = false;  ///< quotients and roots rounded correctly
};

/// A processor that OpenCL knows, which may be this computer's own. Its drivers are loaded when
/// devices are asked for, not before. Copies are the same device.
class Device {
 public:
  /// Of all platforms, in the order of their drivers; none where no driver is installed.
  /// @throws IoError if this build has no OpenCL, or a driver fails
  static std::vector<Device> all();
  /// Why all() may be empty, and what to do.
  static std::string_view none_found();
  /// @param name  "gpu": the first one of that kind; a number: of all(), from 0 on; else a part of
  ///              the name of a device or its platform, in any case of letters
  /// @throws IoError if this build has no OpenCL, or there is no such device, with those that are
  static Device named(std::string_view name);
  /// The first GPU; none where there is none, or this build has no OpenCL.
  static std::optional<Device> first_gpu();

  const DeviceInfo& info() const;

  struct State;  ///< of the backend
  explicit Device(std::shared_ptr<State> state) : state_(std::move(state)) {}
  State& state() const { return *state_; }

 private:
  std::shared_ptr<State> state_;
};

/// How a device is used.
struct DeviceOptions {
  /// For the pixels under way and their planes [MB], > 0; larger frames go in parts. Where the
  /// device has less, parts become smaller. Filters take as many rows as a result depends on, at
  /// least.
  double memory_mb = 512.0;
  /// Computes with doubles where the device has them: ambient light, from raw numbers with black
  /// levels and gains, is then the same to the last bit.
  bool use_doubles = true;

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};
auto fields_of(ConstOrNot<DeviceOptions> auto& o) {
  return std::tuple(
      Field("memory_mb", o.memory_mb, above(0), Help{"memory for frames in flight on the device"}),
      Field("use_doubles", o.use_doubles, Help{"compute in double precision where possible"}));
}

/// Smallest frames with a spatial filter [pixels] that `auto` leaves to a GPU. Frames without one
/// are decoded faster by the CPU than they are copied.
inline constexpr std::int64_t auto_min_pixels_to_filter = 75'000;

/// Returns the backend for a device that a user names: "cpu"; "auto", the first GPU for frames with
/// a spatial filter, but the CPU for small frames, for methods other than zncc, and where there is
/// no GPU; else Device::named(). "auto" loads no driver before a frame needs the GPU. Averaged,
/// filtered and decoded numbers are those of the CPU: the same bits where the device rounds
/// quotients and roots correctly and has doubles.
///
/// Devices average frames if they have doubles, and filter them in time unless the filter looks
/// ahead; else the CPU does, and the device filters in space and decodes.
/// @throws std::invalid_argument for options, or if a device is named and the method is not zncc;
///         IoError if there is no such device, or it fails, with its compiler's messages
std::unique_ptr<FrameBackend> frame_backend(std::string_view device,
                                            std::unique_ptr<const DepthDecoder> decoder,
                                            const DeviceOptions& options = {});

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "gpu/device_frames.hpp"
#include "gpu/device_time_filter.hpp"
#include "gpu/frame_source.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

/// What DeviceFrames have.
struct DeviceFrames::Plan {
  Plan(const Device& device_, const DecodingTable& table_, const TimeFilter* time_filter,
       const DeviceOptions& options_);

  /// A frame comes, of the size of those before; the one that is there is no more.
  void begin_frame(const RawView& raw, bool is_first);
  /// Does steps on the device. What fails half-way is forgotten.
  template <typename Steps>
  auto on_device(const Steps& steps);
  void forget();
  /// The frame that is there now.
  FrameSource source();
  /// It brought back.
  RawView numbers_here();

  Device device;
  const DecodingTable& table;
  DeviceOptions options;
  std::optional<DeviceMeans> means;  // once there are any
  std::optional<DeviceTimeFilter> filter;
  RawView size;          // of the frames, no more
  int frames_added = 0;  // to the next mean
  bool has_frame = false;
  std::vector<float> numbers, averaged;  // that were brought back
  std::vector<double> exact_numbers;
};

template <typename Steps>
auto DeviceFrames::Plan::on_device(const Steps& steps) {
  try {
    return steps();
  } catch (const InvalidArgument&) {
    throw;  // nothing was begun
  } catch (const Interrupted&) {
    throw;  // what was added up is as it was
  } catch (...) {
    forget();
    throw;
  }
}

}  // namespace tofsmith

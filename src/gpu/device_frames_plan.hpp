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

struct DeviceFrames::Plan {
  Plan(const Device& device_, const DecodingTable& table_, const TimeFilter* time_filter,
       const DeviceOptions& options_);

  /// Checks a new frame and drops the current one.
  void begin_frame(const RawView& raw, bool is_first);
  /// Drops all accumulated frames if steps fail half-way.
  template <typename Steps>
  auto on_device(const Steps& steps);
  void forget();
  FrameSource source();
  RawView numbers_here();

  Device device;
  const DecodingTable& table;
  DeviceOptions options;
  std::optional<DeviceMeans> means;  // created with the first mean
  std::optional<DeviceTimeFilter> filter;
  RawView size;          // only the shape
  int frames_added = 0;  // to the next mean
  bool has_frame = false;
  std::vector<float> numbers, averaged;  // downloaded
  std::vector<double> exact_numbers;
};

template <typename Steps>
auto DeviceFrames::Plan::on_device(const Steps& steps) {
  try {
    return steps();
  } catch (const InvalidArgument&) {
    throw;  // nothing was started
  } catch (const Interrupted&) {
    throw;  // accumulated frames are unchanged
  } catch (...) {
    forget();
    throw;
  }
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "decode/filter/shared/filter_parts.hpp"
#include "gpu/device_raw.hpp"
#include "gpu/kernel_parameters.h"

namespace tofsmith {

/// Source of the kernels.
extern const std::string_view time_kernels;

/// A TimeFilter without look_ahead on a device.
class DeviceTimeFilter {
 public:
  DeviceTimeFilter(const Device& device, const TimeFilter::State& state);

  /// Adds the next frame, of the same size as the others.
  void add(const RawView& raw);
  /// As above for a frame on the device, which must not change until the work is done.
  void add(const DeviceRaw& raw, int height, int width);
  /// Starts a new sequence.
  void forget() { is_empty_ = true; }
  bool is_empty() const { return is_empty_; }

  /// Returns the filtered frame, complete once the queue's work is done.
  const DeviceRaw& result() const { return means_; }
  const DeviceQueue& queue() const { return queue_; }

 private:
  void begin_frame(int height, int width);
  void resize(int height, int width);
  void weigh(const DeviceRaw& raw);
  void add_frame(const DeviceRaw& raw);
  template <typename... Arguments>
  void run(const DeviceKernel& kernel, int rows, int columns, const Arguments&... arguments) const {
    queue_.run(kernel, {static_cast<std::size_t>(columns), static_cast<std::size_t>(rows)}, group,
               parameters_, arguments...);
  }

  static constexpr DeviceQueue::Extent group = {32, 8};

  const TimeFilter::State& state_;
  DeviceQueue queue_;
  DeviceKernel compare_frames_, weigh_side_, add_to_cells_, find_cell_changes_, weigh_by_cells_,
      find_shares_, weigh_by_shares_, add_frame_;
  TimeParameters parameters_{};
  bool is_empty_ = true;
  DeviceRaw frame_, means_;
  DeviceMemory words_, weights_, planes_, cells_, cell_changes_;
};

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "decode/filter/shared/filter_parts.hpp"
#include "gpu/device_raw.hpp"
#include "gpu/time_parameters.h"

namespace tofsmith {

/// decode_parameters.h, numbers.cl, time_parameters.h and time.cl, one behind the other.
extern const std::string_view time_kernels;

/// Frames added up in time on a device, as a TimeFilter without look_ahead adds them. The sums stay
/// on the device, in memory that grows with the largest frame.
class DeviceTimeFilter {
 public:
  /// @param state  of the filter; must outlive this
  DeviceTimeFilter(const Device& device, const TimeFilter::State& state);

  /// Uploads and adds the next frame, of the size of the others.
  void add(const RawView& raw);
  /// The same of means that are on the device, and are not changed until this was finished.
  void add(const DeviceRaw& raw, int height, int width);
  /// The next frame is the first.
  void forget() { is_empty_ = true; }
  bool is_empty() const { return is_empty_; }

  /// The frame that was added last, filtered; complete once the queue is.
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

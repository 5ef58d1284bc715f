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

/// Frames added up in time on a device, as a TimeFilter adds them; what was added up and the frames
/// that wait stay there. Its memory there grows with the largest frame, and with how many wait.
class DeviceTimeFilter {
 public:
  /// @param state  of the filter; must outlive this
  DeviceTimeFilter(const Device& device, const TimeFilter::State& state);

  /// Brings the next frame, of the size of the others.
  /// @return whether one comes out: as TimeFilter::add()
  bool add(const RawView& raw);
  /// The same of means that are on the device, and are not changed until this was finished.
  bool add(const DeviceRaw& raw, int height, int width);
  /// As TimeFilter::add_end(). @return whether one comes out
  bool add_end();
  /// The next frame is the first.
  void forget();
  bool is_empty() const { return past_.is_empty && waiting_ == 0; }

  /// The frame that came out; its work is done once the queue's is.
  const DeviceRaw& result() const { return looks_ahead() ? future_.means : past_.means; }
  const DeviceQueue& queue() const { return queue_; }

 private:
  /// Frames of one side of another, as AddedFrames.
  struct Side {
    bool is_empty = true;
    DeviceRaw means;
    DeviceMemory weights;
  };

  bool looks_ahead() const { return state_.options.look_ahead > 0; }
  void begin_frame(int height, int width);
  void resize(int height, int width);
  void resize(Side& side);
  DeviceRaw& waiting(int index);
  /// Where the next frame goes.
  DeviceRaw& next_slot();
  /// One more waits there. @return whether another one comes out
  bool frame_waits();
  void finish_oldest();
  void weigh(const DeviceRaw& raw, Side& side);
  void add(const DeviceRaw& raw, Side& side);
  template <typename... Arguments>
  void run(const DeviceKernel& kernel, int rows, int columns, const Arguments&... arguments) const {
    queue_.run(kernel, {static_cast<std::size_t>(columns), static_cast<std::size_t>(rows)}, group,
               parameters_, arguments...);
  }

  static constexpr DeviceQueue::Extent group = {32, 8};

  const TimeFilter::State& state_;
  DeviceQueue queue_;
  DeviceKernel compare_frames_, weigh_side_, add_to_cells_, find_cell_changes_, weigh_by_cells_,
      find_shares_, weigh_by_shares_, add_frame_, join_sides_;
  TimeParameters parameters_{};
  Side past_, future_;  // the future only where it looks ahead
  std::vector<DeviceRaw> slots_ = std::vector<DeviceRaw>(1);  // a ring of frames that wait
  std::size_t first_ = 0;                                     // the oldest of them
  int waiting_ = 0;  // how many do; none where it does not look ahead
  DeviceMemory words_, planes_, cells_, cell_changes_;
};

}  // namespace tofsmith

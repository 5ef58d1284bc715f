// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "gpu/device_tile.hpp"
#include "gpu/filter_tables.hpp"

namespace tofsmith {

/// Rows of a frame on a device, and the steps of a Filter over them, as Filter::Plan has them. Its
/// memory there grows with the largest.
class DeviceFrame {
 public:
  /// Called after each step, of as many as a Filter has.
  using StepDone = std::function<void()>;

  /// @param plan  must outlive this
  DeviceFrame(const Device& device, const Filter::Plan& plan, bool use_doubles);

  /// Rows above and below one that its numbers depend on, at most.
  static int reach(const FilterOptions& options);
  /// Of so many rows, at most, with those of a decoder that follows.
  std::int64_t bytes(int rows, int width) const;

  /// Filters rows of a frame as if there were no others. Step by step, it does not wait for the
  /// device, except for depths that need double precision.
  /// @param left_out  (H, W) of the whole frame, or null
  void filter(const FrameSource& frame, int first_row, int rows, const std::uint8_t* left_out,
              const StepDone& step_done);
  /// Writes filtered numbers of some of the rows, counted from the first of them.
  void write(int first_row, int rows, const DeviceRaw& to) const;
  void release();

  const DeviceQueue& queue() const { return tile_.queue(); }

 private:
  void resize(int rows, int width);
  template <typename... Arguments>
  void run(const DeviceKernel& kernel, const Arguments&... arguments) const {
    queue().run(
        kernel,
        {static_cast<std::size_t>(parameters_.width), static_cast<std::size_t>(parameters_.height)},
        {tile_columns, tile_rows}, arguments...);
  }
  int light(int set) const { return light_plane(set, plan_.measurements); }
  ResultParameters result(int set, int measured) const;
  void read(int set, FilterPlanes::Scalar usable, bool with_variance) const;
  void add_similar(int from, int to, int window) const;
  void leave_dark(int set, int other) const;
  void find_depth(int from);
  void decide_open_pixels();
  void add_along_slopes(int light_set, int rest, int to, int window) const;
  void add_slope_noise(int round) const;

  const Filter::Plan& plan_;
  FilterTables tables_;
  DeviceTile tile_;  // that depths are found in
  DeviceKernel read_light_, find_hidden_noise_, find_energy_, weigh_similar_, add_similar_,
      write_raw_, take_depth_, find_slopes_, split_, add_along_slopes_, compare_sums_, keep_near_,
      keep_bright_, find_own_light_, leave_dark_, add_slope_noise_, write_filtered_;
  FilterParameters parameters_;
  DeviceMemory words_, planes_, weights_, left_out_;
  bool has_left_out_ = false;
  bool has_margins_ = false;  // of the size of the parameters, all 0
  DeviceRaw raw_;
  int result_ = 0;  // the set of light that is filtered; the other has it as measured
};

}  // namespace tofsmith

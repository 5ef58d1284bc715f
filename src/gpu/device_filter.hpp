// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "gpu/device_decoder.hpp"
#include "gpu/device_tables.hpp"
#include "tofsmith/core/hidden.hpp"

namespace tofsmith {

/// Rows of a frame on a device, and the steps of Filter::Plan for them.
class DeviceFrame {
 public:
  using StepDone = std::function<void()>;

  /// @param plan  must outlive this object
  DeviceFrame(const Device& device, const Filter::Plan& plan, bool use_doubles);

  /// Upper limit on the rows above and below that results depend on.
  static int reach(const FilterOptions& options);
  /// Upper limit on the device memory, including the following decoder.
  std::int64_t bytes(int rows, int width) const;

  /// Filters rows as if they were the whole frame. Waits for the device only where depths need
  /// double precision.
  /// @param left_out  mask of excluded pixels (H, W) of the whole frame, or null
  void filter(const FrameSource& frame, int first_row, int rows, const std::uint8_t* left_out,
              const StepDone& step_done);
  /// Writes some rows, counted from the first filtered row.
  void write(int first_row, int rows, const DeviceRaw& to);
  /// FilteredFrame::deviation_factor() of the rows of write(); null without slope rounds.
  const DeviceMemory* deviation_factors() const {
    return plan_.options.slope_rounds > 0 ? &factors_ : nullptr;
  }
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
  DeviceTile tile_;  // decodes depths for slopes
  DeviceKernel read_light_, find_hidden_noise_, find_energy_, weigh_similar_, add_similar_,
      write_raw_, take_depth_, find_slopes_, split_, add_along_slopes_, compare_sums_, keep_near_,
      keep_bright_, find_own_light_, leave_dark_, find_own_amplitude_, add_slope_noise_,
      write_filtered_;
  FilterParameters parameters_;
  DeviceMemory words_, planes_, weights_, left_out_, factors_;
  bool has_left_out_ = false;
  bool has_margins_ = false;
  DeviceRaw raw_;
  int result_ = 0;  // filtered light set; the other one is measured
};

/// A Filter on a device, optionally followed by a decoder on the same device. For the equality of
/// results see frame_backend(); where rounding differs, values near a threshold may change by more
/// than the last bits. Thread-safe; calls are serialized.
class DeviceFilter {
 public:
  /// Compiles the kernels and uploads the tables.
  /// @param filter  must outlive this object
  /// @throws std::invalid_argument for invalid options; IoError if the device fails
  DeviceFilter(const Device& device, const Filter& filter, const DeviceOptions& options = {});
  DeviceFilter(const Device& device, Filter&& filter, const DeviceOptions& options = {}) = delete;

  const Device& device() const;

  /// Filters a frame, as Filter::apply.
  /// @throws std::invalid_argument if the measurements or sizes differ; IoError if the device
  ///         fails; Interrupted if `progress` cancels
  void apply(const RawView& raw, FilteredFrame& filtered, const Progress& progress = {},
             const Image<std::uint8_t>& left_out = {}) const;

  /// Filters and decodes a frame.
  /// @param decoder   on the same device
  /// @param filtered  receives the filtered frame unless null
  /// @return number of pixels that the CPU decoded
  /// @throws as apply() and DeviceDecoder::decode; planes may be partly written
  std::int64_t decode(const RawView& raw, const DeviceDecoder& decoder, const DecodedView& decoded,
                      FilteredFrame* filtered = nullptr, const Progress& progress = {},
                      const Image<std::uint8_t>& left_out = {}) const;

 private:
  friend class DeviceFrames;
  std::int64_t decode_source(const FrameSource& frame, const Device& its_device,
                             const DeviceDecoder& decoder, const DecodedView& decoded,
                             FilteredFrame* filtered, const Progress& progress,
                             const Image<std::uint8_t>& left_out) const;
  struct Plan;
  Hidden<Plan> plan_;
};

}  // namespace tofsmith

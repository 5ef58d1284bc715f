// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "tofsmith/core/fields.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

struct TimeFilterOptions {
  int max_frames = 64;
  double max_difference_sigma = 5.0;
  bool before_filter = false;
  int look_ahead = 0;

  /// @throws InvalidArgument
  void validate() const;
};
auto fields_of(ConstOrNot<TimeFilterOptions> auto& o) {
  return std::tuple(
      Field("max_frames", o.max_frames, at_least(1),
            Help{"maximum number of frames to average; 1: frames are not averaged"}),
      Field("max_difference_sigma", o.max_difference_sigma, above(0),
            Help{"difference from the mean above which averaging restarts; above 60 % of it, the "
                 "weight of the mean decreases"}),
      Field(
          "before_filter", o.before_filter,
          Help{
              "also detect changes in blocks of 24 x 24 pixels, because a spatial filter follows"}),
      Field(
          "look_ahead", o.look_ahead, closed(0, 1000),
          Help{"number of later frames to average as well; delays the output by as many frames"}));
}

/// Averages the raw measurements of each pixel over frames, as long as the scene does not change,
/// before decoding. A frame waits for later frames only if look_ahead > 0.
///
/// The filter stores the mean of each pixel. Chi^2 tests of a new measurement on the pixel, on the
/// 5 x 5 pixels around it, and on their mean difference detect changes. The part of a change that
/// noise cannot explain is added to the variance of the mean, which reduces its weight, to 0 at
/// max_difference_sigma. With `look_ahead`, later frames are averaged in the same way, from the
/// last one backwards.
///
/// Invalid and saturated pixels are not averaged, and averaging restarts after them: a mean of only
/// those frames in which a pixel is not clipped would be too low. A change of the light source's
/// power counts as a change. If ambient light cancels in differences, its noise is unknown, and
/// fewer frames are averaged.
/// @see docs/filtering.md
class TimeFilter {
 public:
  /// @throws InvalidArgument for invalid arguments
  explicit TimeFilter(const DecodingTable& table, const TimeFilterOptions& options = {});
  ~TimeFilter();
  TimeFilter(TimeFilter&&) noexcept;
  TimeFilter& operator=(TimeFilter&&) noexcept;

  const DecodingTable& table() const;
  const TimeFilterOptions& options() const;
  int measurements() const { return table().measurements(); }
  /// Memory [bytes]: K + 2 floats per pixel and the threads' working memory; with look_ahead, 2 (K
  /// + 2) + (look_ahead + 1) (K + 1) floats per pixel.
  static std::size_t memory_bytes(const TimeFilterOptions& options, int height, int width,
                                  int measurements, int threads);

  /// Adds the next frame, on all threads. Allocates nothing after the first look_ahead + 1 frames.
  /// @param raw  electrons or counts of the same size as before; may be means (RawView::averaged)
  /// @return average for the frame added look_ahead calls earlier, valid until the next call; none
  ///         if there is no such frame yet
  /// @throws InvalidArgument if the size or the number of measurements differs
  /// @note the same bits for any number of threads and any layout
  std::optional<RawView> add(const RawView& raw);
  /// Returns the next waiting frame after the end of a recording, none after the last one. A frame
  /// added later starts a new sequence.
  std::optional<RawView> add_end();
  /// Starts a new sequence: the next frame may have any size.
  void forget();

  struct State;

 private:
  friend const State& state_of(const TimeFilter& filter);
  std::unique_ptr<State> state_;
};

}  // namespace tofsmith

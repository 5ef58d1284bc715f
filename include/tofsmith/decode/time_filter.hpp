// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "tofsmith/core/fields.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

/// Options of a TimeFilter.
struct TimeFilterOptions {
  int max_frames = 64;
  double max_difference_sigma = 5.0;
  /// Set this if a spatial filter follows: it leaves little noise, so smaller changes matter.
  bool before_filter = false;
  int look_ahead = 0;

  /// @throws std::invalid_argument naming field, value and rule
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
/// The filter stores one frame: the mean s of the averaged measurements of a pixel, which has the
/// variance of n measurements. If nothing changed, a new measurement y differs from s by noise of
/// variance v (1 + 1 / n) in each of its K values. v is the variance of one measurement, estimated
/// from the weighted mean of s and y. It includes shot noise of the collected light, read noise,
/// and noise of light that cancels when buckets are subtracted. Three tests must find no change:
/// chi^2 of the pixel, chi^2 of the 5 x 5 pixels around it, and chi^2 of the mean difference of
/// those pixels. The third test detects common changes long before a single pixel does. If a test
/// finds a change, the part of it that noise cannot explain is added to the variance of s, which
/// reduces the weight of s. The weight is 0 from max_difference_sigma on: the pixel then has the
/// value of the new frame alone.
///
/// With `look_ahead`, the frames after a frame are averaged in the same way, from the last one
/// backwards. The frame is compared with the past mean s_past and the future mean s_future
/// separately; with the weights w that remain, the result is
///   (w_past s_past + y + w_future s_future) / (w_past + 1 + w_future).
/// If look_ahead covers a whole recording, filtering the reversed recording gives the reversed
/// result.
///
/// Invalid and saturated pixels are not averaged, and averaging restarts after them: a mean of only
/// those frames in which a pixel is not clipped would be too low. A change of the light source's
/// power counts as a change. If ambient light cancels when buckets are subtracted, its noise is
/// unknown: under strong ambient light, fewer frames are averaged.
class TimeFilter {
 public:
  /// @throws std::invalid_argument if the table or the options are invalid
  explicit TimeFilter(const DecodingTable& table, const TimeFilterOptions& options = {});
  ~TimeFilter();
  TimeFilter(TimeFilter&&) noexcept;
  TimeFilter& operator=(TimeFilter&&) noexcept;

  const DecodingTable& table() const;
  const TimeFilterOptions& options() const;
  int measurements() const { return table().measurements(); }
  /// Memory for frames of this size [bytes]: K + 2 floats per pixel and the threads' working
  /// memory; with look_ahead, 2 (K + 2) + (look_ahead + 1) (K + 1) floats per pixel.
  static std::size_t memory_bytes(const TimeFilterOptions& options, int height, int width,
                                  int measurements, int threads);

  /// Adds the next frame, on all threads. Allocates nothing from the second frame on; with
  /// look_ahead, after the first look_ahead frames.
  /// @param raw  electrons or counts, of the same size as earlier frames; may be means of several
  ///             frames, as specified by RawView::averaged
  /// @return average for the frame added look_ahead calls earlier, as raw values for any decoder
  ///         and Filter, with the number of averaged measurements; none if there is no such frame
  ///         yet. Valid until the next call.
  /// @throws std::invalid_argument if the size or the number of measurements differs
  /// @note the same bits for any number of threads and any layout of the raw values
  std::optional<RawView> add(const RawView& raw);
  /// Returns the next waiting frame after the end of a recording, none after the last one. The
  /// frame added afterwards starts a new sequence.
  std::optional<RawView> add_end();
  /// Starts a new sequence: the next frame is the first one and may have any size.
  void forget();

  struct State;  ///< implementation

 private:
  friend const State& state_of(const TimeFilter& filter);
  std::unique_ptr<State> state_;
};

}  // namespace tofsmith

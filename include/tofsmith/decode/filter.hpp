// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "tofsmith/core/fields.hpp"
#include "tofsmith/core/hidden.hpp"
#include "tofsmith/core/image.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/decode/decoding_table.hpp"
#include "tofsmith/decode/depth_image.hpp"

namespace tofsmith {

enum class FilterStrength {
  light,   ///< 5 x 5 pixels; several times as fast as normal
  normal,  ///< 25 x 25 pixels, then one pass along slopes
  strong,  ///< 25 x 25 pixels, then two passes along slopes
};
constexpr auto words_of(FilterStrength /*any*/) { return word_list("light", "normal", "strong"); }

struct FilterOptions {
  int windows = 2;
  int slope_rounds = 1;
  double max_difference_sigma = 3.5;
  double trusted_pixels = 12.0;
  double same_depth_sigma = 4.0;
  double own_light_sigma = 8.0;

  static FilterOptions of(FilterStrength strength);
  /// @throws InvalidArgument
  void validate() const;
};
auto fields_of(ConstOrNot<FilterOptions> auto& o) {
  return std::tuple(
      Field("windows", o.windows, closed(1, 3),
            Help{"number of nested windows of 5 x 5 pixels: 5, 25 or 125 pixels wide in total"}),
      Field("slope_rounds", o.slope_rounds, closed(0, 4),
            Help{"additional passes over all windows, along the surface slopes estimated in the "
                 "previous pass"}),
      Field("max_difference_sigma", o.max_difference_sigma, above(0),
            Help{"difference above which a neighbour has no weight"}),
      Field("trusted_pixels", o.trusted_pixels, at_least(1),
            Help{"maximum number of averaged pixels that the similarity test of the next window "
                 "assumes"}),
      Field("same_depth_sigma", o.same_depth_sigma, above(0),
            Help{"depth difference, apart from slopes, within which pixels belong to one surface"}),
      Field("own_light_sigma", o.own_light_sigma, at_least(0),
            Help{"increase by filtering above which a dark pixel in a dark neighbourhood keeps its "
                 "raw value"}));
}

struct FilterPlanes;

/// Filtered frame, and the memory for further frames of the same size.
class FilteredFrame {
 public:
  FilteredFrame();

  int height() const;
  int width() const;
  /// Raw values for any decoder, with RawView::averaged. Valid until the frame is destroyed or
  /// filtered into again.
  RawView view() const;
  RawFrames values() const;
  /// (H, W): effective number of averaged measurements; 1 for unfiltered pixels. Without slope
  /// rounds, the variance includes a bound on the squared bias.
  const Image<float>& averaged() const;
  /// (H, W): factor of `deviation_m` that includes the bias near depth edges; empty without slope
  /// rounds.
  const Image<float>& deviation_factor() const;

 private:
  friend class Filter;
  friend FilterPlanes& planes_of(FilteredFrame& frame);
  Hidden<FilterPlanes> planes_;
};

/// Averages the raw measurements of neighbouring pixels at the same depth, before decoding.
///
/// After projecting out ambient light, the measurement vectors of pixels at one depth are parallel
/// for any albedo, so they can be averaged without bias. Weights follow from a chi^2 test of
/// parallelism over 5 x 5 pixels. It has rank - 1 degrees of freedom and, with three measurements,
/// little power. Each further window combines every fifth pixel of the previous result; these share
/// no measurement, so the variance of the average is exact. A pass along slopes first moves the
/// light of each neighbour along the coding curve by its difference in depth on a fitted plane.
///
/// Ambient light and other returns are averaged as well. Invalid and saturated pixels keep their
/// values and have no weight. PixelMaps are applied after filtering, so neighbours whose offsets
/// differ by more than the noise are not averaged.
///
/// Immutable and thread-safe, if each thread has its own FilteredFrame.
/// @see docs/filtering.md
class Filter {
 public:
  /// @throws InvalidArgument for invalid arguments
  explicit Filter(DecodingTable table, const FilterOptions& options = {});

  const DecodingTable& table() const;
  const FilterOptions& options() const;
  int measurements() const { return table().measurements(); }
  /// Returns the memory of a FilteredFrame and of all threads [bytes].
  static std::size_t memory_bytes(const FilterOptions& options, int height, int width,
                                  int measurements, int threads);

  /// Filters one frame on all threads. Allocates nothing if `filtered` holds a frame of the same
  /// size.
  /// @param raw  electrons or counts; may be averages (RawView::averaged)
  /// @param left_out  (H, W) or empty: nonzero pixels keep their raw values and have no weight,
  ///   e.g. mixed pixels
  /// @throws InvalidArgument if measurements or sizes differ
  /// @note the same bits for any number of threads and any memory layout
  void apply(const RawView& raw, FilteredFrame& filtered, const Progress& progress = {},
             const Image<std::uint8_t>& left_out = {}) const;
  /// Filters frame `frame` of a stack.
  FilteredFrame apply(const RawFrames& raw, int frame = 0, const Progress& progress = {}) const;

  struct Plan;

 private:
  friend const Plan& plan_of(const Filter& filter);
  Hidden<const Plan> plan_;
};

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
  Hidden<State> state_;
};

}  // namespace tofsmith

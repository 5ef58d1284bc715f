// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

#include "tofsmith/core/fields.hpp"
#include "tofsmith/core/image.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/decode/decoding_table.hpp"
#include "tofsmith/decode/depth_image.hpp"

namespace tofsmith {

/// Strength of a Filter.
enum class FilterStrength {
  light,   ///< one window of 5 x 5 pixels; several times as fast as normal
  normal,  ///< 25 x 25 pixels, followed by one pass along slopes
  strong,  ///< 25 x 25 pixels, followed by two passes along slopes
};
inline constexpr std::array all_filter_strengths = {FilterStrength::light, FilterStrength::normal,
                                                    FilterStrength::strong};
constexpr std::array<std::string_view, 3> words_of(FilterStrength /*any*/) {
  return {"light", "normal", "strong"};
}
/// "light", "normal", "strong".
std::string_view name_of(FilterStrength strength);
/// @throws std::invalid_argument for an unknown name
FilterStrength parse_filter_strength(std::string_view name);

struct FilterOptions {
  int windows = 2;
  int slope_rounds = 1;
  double max_difference_sigma = 3.5;
  /// Larger values detect smaller depth steps; smaller values smooth slopes more.
  double trusted_pixels = 12.0;
  double same_depth_sigma = 4.0;
  /// Prevents light from leaking across edges.
  double own_light_sigma = 8.0;

  static FilterOptions of(FilterStrength strength);
  /// @throws std::invalid_argument naming field, value and rule
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

/// Filtered frame and the memory for filtering further frames of the same size.
class FilteredFrame {
 public:
  FilteredFrame();
  ~FilteredFrame();
  FilteredFrame(FilteredFrame&&) noexcept;
  FilteredFrame& operator=(FilteredFrame&&) noexcept;

  int height() const;
  int width() const;
  /// Raw values for any decoder, with the number of averaged measurements. Valid until the frame is
  /// destroyed or filtered into again.
  RawView view() const;
  /// Returns a copy of the raw values, (1, H, W, K).
  RawFrames values() const;
  /// (H, W): effective number of measurements averaged into each pixel (variance reduction); 1 for
  /// unfiltered pixels.
  const Image<float>& averaged() const;

 private:
  friend class Filter;
  friend FilterPlanes& planes_of(FilteredFrame& frame);
  std::unique_ptr<FilterPlanes> planes_;
};

/// Averages the raw measurements of neighbouring pixels at the same depth, before decoding.
///
/// After projecting out ambient light, the measurement vectors of pixels at one depth are parallel
/// for any albedo: u = V^T y = S p(z). The columns of V are a basis of the remaining space, and p
/// is the coding curve, V^T x(z) (see Decoder). The vectors can therefore be averaged without bias.
/// A test of parallelism that accounts for the noise variances v and v' decides whether two pixels
/// are averaged:
///   lambda = (a + b - sqrt((a - b)^2 + 4 c^2)) / 2,  a = |u|^2 / v, b = |u'|^2 / v',
///   c = max(0, u . u') / sqrt(v v').
/// lambda is the smallest chi^2 with which one direction explains both vectors. It has rank - 1
/// degrees of freedom. The weight of a neighbour follows from the mean of lambda over a 5 x 5
/// patch. Each further window combines every fifth pixel of the previous result. These pixels share
/// no measurement, so the variance of the average is exact.
///
/// A pass along slopes decodes the current result and fits a plane to the depths around each pixel.
/// Before averaging, the light of each neighbour is moved along the coding curve by the difference
/// in depth between the two pixels on this plane. Slanted surfaces thus keep their depth and use
/// the whole window.
///
/// Ambient light and other returns are averaged as well. Invalid and saturated pixels keep their
/// values and have no weight. With three measurements the test has one degree of freedom and little
/// power. PixelMaps are applied after filtering, so neighbours whose offsets differ by more than
/// the noise are not averaged.
///
/// Immutable and thread-safe, if each thread has its own FilteredFrame.
class Filter {
 public:
  /// @throws std::invalid_argument if the table or the options are invalid
  explicit Filter(DecodingTable table, const FilterOptions& options = {});
  ~Filter();
  Filter(Filter&&) noexcept;
  Filter& operator=(Filter&&) noexcept;

  const DecodingTable& table() const;
  const FilterOptions& options() const;
  int measurements() const { return table().measurements(); }
  /// Returns the memory for frames of this size [bytes]: a FilteredFrame and the working memory of
  /// all threads.
  static std::size_t memory_bytes(const FilterOptions& options, int height, int width,
                                  int measurements, int threads);

  /// Filters one frame on all threads. Allocates nothing if `filtered` already holds a frame of the
  /// same size.
  /// @param raw  electrons or counts with the measurements of the table; may be averages, whose
  ///   number of measurements is RawView::averaged
  /// @param left_out  (H, W) or empty: pixels with nonzero values keep their raw values and have no
  ///   weight (e.g. mixed pixels of mark_mixed_pixels())
  /// @throws std::invalid_argument if measurements or sizes differ; Interrupted if `progress`
  ///   requests it
  /// @note the same bits for any number of threads and any memory layout
  void apply(const RawView& raw, FilteredFrame& filtered, const Progress& progress = {},
             const Image<std::uint8_t>& left_out = {}) const;
  /// Filters frame `frame` of a stack (F, H, W, K).
  FilteredFrame apply(const RawFrames& raw, int frame = 0, const Progress& progress = {}) const;

  struct Plan;  ///< implementation

 private:
  friend const Plan& plan_of(const Filter& filter);
  std::unique_ptr<const Plan> plan_;
};

}  // namespace tofsmith

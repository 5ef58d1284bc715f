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

/// How much a Filter does.
enum class FilterStrength {
  light,   ///< 5 x 5 pixels, once: several times as fast as normal
  normal,  ///< 25 x 25 pixels, and once more along the slopes found
  strong,  ///< as normal, with a second round along the slopes
};
inline constexpr std::array all_filter_strengths = {FilterStrength::light, FilterStrength::normal,
                                                    FilterStrength::strong};
constexpr std::array<std::string_view, 3> words_of(FilterStrength /*any*/) {
  return {"light", "normal", "strong"};
}
/// "light", "normal", "strong".
std::string_view name_of(FilterStrength strength);
/// @throws std::invalid_argument for any other word
FilterStrength parse_filter_strength(std::string_view name);

/// Options of a Filter.
struct FilterOptions {
  int windows = 2;
  int slope_rounds = 1;
  double max_difference_sigma = 3.5;
  /// Larger values detect smaller depth steps, smaller values smooth slopes more.
  double trusted_pixels = 12.0;
  double same_depth_sigma = 4.0;
  /// Avoids that light leaks across edges.
  double own_light_sigma = 8.0;

  static FilterOptions of(FilterStrength strength);
  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};
auto fields_of(ConstOrNot<FilterOptions> auto& o) {
  return std::tuple(
      Field("windows", o.windows, closed(1, 3),
            Help{"windows of 5 x 5 pixels, each over the results of the previous one: 5, 25 or 125 "
                 "pixels wide in all"}),
      Field("slope_rounds", o.slope_rounds, closed(0, 4),
            Help{"additional passes over all windows, along the surface slopes estimated in the "
                 "previous pass"}),
      Field("max_difference_sigma", o.max_difference_sigma, above(0),
            Help{"difference above which a neighbour has no weight"}),
      Field("trusted_pixels", o.trusted_pixels, at_least(1),
            Help{"upper limit on the number of already averaged pixels that the similarity test of "
                 "the next window assumes"}),
      Field("same_depth_sigma", o.same_depth_sigma, above(0),
            Help{"along slopes, distance within which depths belong to the same surface"}),
      Field("own_light_sigma", o.own_light_sigma, at_least(0),
            Help{"a dark pixel in a dark neighbourhood of 7 x 7 pixels keeps its raw value if "
                 "filtering would raise it by more than this"}));
}

struct FilterPlanes;

/// A filtered frame, with the memory that filtering the next one of its size uses again.
class FilteredFrame {
 public:
  FilteredFrame();
  ~FilteredFrame();
  FilteredFrame(FilteredFrame&&) noexcept;
  FilteredFrame& operator=(FilteredFrame&&) noexcept;

  int height() const;
  int width() const;
  /// Raw numbers as any decoder takes them, and of how many measurements each is the mean. Valid
  /// while the frame lives and nothing else is filtered into it.
  RawView view() const;
  /// The same numbers, (1, H, W, K).
  RawFrames values() const;
  /// (H, W): of how many measurements of a pixel's light each of its numbers is the mean, in
  /// variance; 1 where nothing was added.
  const Image<float>& averaged() const;

 private:
  friend class Filter;
  friend FilterPlanes& planes_of(FilteredFrame& frame);
  std::unique_ptr<FilterPlanes> planes_;
};

/// Adds the raw measurements of pixels that see the same depth, before anything is decoded.
///
/// Without ambient light, the vectors of pixels at one depth are parallel, whatever their albedo: u
/// = V^T y = S p(z), so that they may be added without bias. Whether two may be is a test of
/// parallelism that knows the noise v of each,
///   lambda = (a + b - sqrt((a - b)^2 + 4 c^2)) / 2,  a = |u|^2 / v, b = |u'|^2 / v',
///   c = max(0, u . u') / sqrt(v v'),
/// the least chi^2 of one direction for both, with rank - 1 degrees of freedom. Its mean over a
/// patch of 5 x 5 weighs the neighbour. Later windows take every fifth pixel of the results of the
/// one before, which share no measurement, so that the variance of the sum is exact.
/// Rounds along slopes decode what they have, fit a plane to the depths around every pixel, and
/// move each neighbour's light along the curve by what the planes say before it is added: a surface
/// that slants keeps its depth, and all of the window counts.
///
/// What a pixel has of ambient light and of other returns is added along. Pixels that are invalid
/// or saturated are left as they are and weigh nothing. With three measurements the test has one
/// degree of freedom and tells little. Maps of pixels (PixelMaps) are applied to what is decoded:
/// offsets that differ from pixel to pixel by more than noise keep neighbours apart.
///
/// Immutable and safe to use from many threads at once, each with a frame of its own.
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
  /// Memory that frames of this size are filtered in [bytes]: a FilteredFrame's, and what each
  /// thread works in.
  static std::size_t memory_bytes(const FilterOptions& options, int height, int width,
                                  int measurements, int threads);

  /// Filters one frame on all threads. Allocates nothing if the frame held one of the same size.
  /// @param raw  electrons or counts, with as many measurements as the table, or means of several
  ///             as its `averaged` says
  /// @param left_out  (H, W), or empty: pixels that are not 0 are left as they were measured and
  ///                  weigh nothing, as those that mark_mixed_pixels() found
  /// @throws std::invalid_argument if the measurements or sizes differ; Interrupted if progress
  ///         says so
  /// @note the same bits for any number of threads and any layout of the raw numbers
  void apply(const RawView& raw, FilteredFrame& filtered, const Progress& progress = {},
             const Image<std::uint8_t>& left_out = {}) const;
  /// The same for frame `frame` of several (F, H, W, K).
  FilteredFrame apply(const RawFrames& raw, int frame = 0, const Progress& progress = {}) const;

  struct Plan;  ///< of the implementation

 private:
  friend const Plan& plan_of(const Filter& filter);
  std::unique_ptr<const Plan> plan_;
};

}  // namespace tofsmith

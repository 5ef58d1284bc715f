// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
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
/// "light", "normal", "strong".
std::string_view name_of(FilterStrength strength);
/// @throws std::invalid_argument for any other word
FilterStrength parse_filter_strength(std::string_view name);

struct FilterOptions {
  /// Windows of 5 x 5, each over the results of the one before, so that no pixel is counted twice:
  /// 5, 25 or 125 pixels wide in all.
  int windows = 2;
  /// Times that all windows are gone through again, now along the slopes of the depth found before.
  int slope_rounds = 1;
  /// Neighbours that differ by more standard deviations than this weigh nothing.
  double max_difference_sigma = 3.5;
  /// Pixels added before, at most, that the next window counts on when it asks what differs: more
  /// tell smaller steps from noise, fewer let slopes be averaged.
  double trusted_pixels = 12.0;
  /// Along slopes, depths within this many standard deviations are the same surface.
  double same_depth_sigma = 4.0;
  /// A pixel is left as it was measured where neither it nor most of the 7 x 7 pixels around it
  /// show any light, but what the filter would give it stands out by this many standard deviations
  /// of their mean: beside an edge of light, dark pixels are given none of it.
  double own_light_sigma = 8.0;

  static FilterOptions of(FilterStrength strength);
  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<FilterOptions> auto& o) {
  return std::tuple(Field("windows", o.windows, "in [1, 3]"),
                    Field("slope_rounds", o.slope_rounds, "in [0, 4]"),
                    Field("max_difference_sigma", o.max_difference_sigma, "finite and > 0"),
                    Field("trusted_pixels", o.trusted_pixels, "finite and >= 1"),
                    Field("same_depth_sigma", o.same_depth_sigma, "finite and > 0"),
                    Field("own_light_sigma", o.own_light_sigma, "finite and >= 0"));
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

/// Filters a frame and has it decoded; where mixed pixels are found, once more without them, so
/// that their neighbours take nothing from them.
/// @param filtered  memory for it
/// @param decode    called with the filtered numbers and what mark_mixed_pixels() asks beside them
/// @param statuses  of the frame's pixels, as `decode` writes them; null: none will be mixed
/// @throws std::invalid_argument as Filter::apply(); what `decode` throws
void decode_filtered(
    const Filter& filter, const RawView& raw, FilteredFrame& filtered,
    const std::function<void(const RawView&, const UnfilteredPixels&, const Progress&)>& decode,
    const PixelStatus* statuses, const Progress& progress = {});
/// The same by what filters and decodes in one, as a DeviceFilter.
/// @param filter_and_decode  leaves out the pixels that are mixed before; throws what it may
void decode_filtered(
    const RawView& raw,
    const std::function<void(const UnfilteredPixels&, const Progress&)>& filter_and_decode,
    const PixelStatus* statuses, const Progress& progress = {});

struct TimeFilterOptions {
  /// The newest frame weighs 1 / max_frames or more: what is older by much more is forgotten. 1: no
  /// frame is added to another.
  int max_frames = 64;
  /// Pixels that differ from what was added up by more standard deviations start anew; from half of
  /// it on the past weighs less.
  double max_difference_sigma = 5.0;
  /// Pixels are added in space afterwards, which leaves so little noise that smaller changes
  /// matter: those that only 24 x 24 pixels together show are looked for, too.
  bool before_filter = false;
  /// So many later frames are added, too, as long as they stay the same; each frame waits for
  /// them. 0: none does.
  int look_ahead = 0;

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<TimeFilterOptions> auto& o) {
  return std::tuple(Field("max_frames", o.max_frames, ">= 1"),
                    Field("max_difference_sigma", o.max_difference_sigma, "finite and > 0"),
                    Field("before_filter", o.before_filter),
                    Field("look_ahead", o.look_ahead, "in [0, 1000]"));
}

/// Adds the raw measurements of each pixel, frame after frame, as long as they stay the same,
/// before anything is decoded. No frame waits for a later one, unless it is to look ahead.
///
/// Kept is one frame: the mean s of what was added to a pixel, of n measurements in variance. A new
/// measurement y differs from it, if nothing changed, by noise of variance v (1 + 1 / n) for each
/// of its K numbers, where v is that of the mean of both: shot noise of the light collected,
/// read-out, and what subtracted buckets hide. Three tests must agree that nothing did: chi^2 of
/// the pixel, of the 5 x 5 pixels around it, and of the mean difference of those, which finds what
/// all of them share long before one shows it. Where one says by how much it changed at least, that
/// is added to the variance of s; from max_difference_sigma on the pixel is that of the new frame
/// alone.
///
/// With `look_ahead` the frames after one are added up from the last of them backwards, just so,
/// and the frame itself is tested against what came before and against what comes after, each for
/// itself: s_past and s_future with the weights w that stay give
///   (w_past s_past + y + w_future s_future) / (w_past + 1 + w_future).
/// A recording played backwards comes out backwards if it is looked ahead over all of it.
///
/// Pixels that are invalid or saturated come out as they are and start anew after that: a mean of
/// those frames alone in which they are not clipped would be too low. Light whose power changes is
/// light that changes. Ambient light that subtracted buckets hide makes noise that is not known: in
/// much of it fewer frames are added.
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
  /// Memory that frames of this size take [bytes]: K + 2 floats a pixel, and what each thread works
  /// in; with look_ahead 2 (K + 2) + (look_ahead + 1) (K + 1) floats a pixel.
  static std::size_t memory_bytes(const TimeFilterOptions& options, int height, int width,
                                  int measurements, int threads);

  /// Adds the next frame, on all threads. Allocates nothing from the second frame on; with
  /// look_ahead, once that many have come.
  /// @param raw  electrons or counts, as large as the frames before, or means of several
  /// @return raw numbers as any decoder and Filter take them, and of how many measurements each is
  ///         the mean, of the frame look_ahead before this one; none while there is no such frame.
  ///         Valid until the next frame.
  /// @throws std::invalid_argument if the size or the measurements differ
  /// @note the same bits for any number of threads and any layout of the raw numbers
  std::optional<RawView> add(const RawView& raw);
  /// After the last frame: the next of those that wait; none after the last of them. After that the
  /// next frame is the first again.
  std::optional<RawView> add_end();
  /// The next frame is the first again, of any size.
  void forget();

  struct State;  ///< of the implementation

 private:
  friend const State& state_of(const TimeFilter& filter);
  std::unique_ptr<State> state_;
};

/// Frames of several exposures as one of the shortest.
struct MergedExposures {
  RawFrames values;       ///< (1, H, W, K), raw numbers as any decoder takes them
  Image<float> averaged;  ///< (H, W): of how many of the shortest exposure, in variance

  /// Of both, while this lives.
  RawView view() const;
};

/// @param field  what they are called in errors
/// @throws std::invalid_argument unless there are 2 or more, each from 1 to 1e6, the shortest 1
void check_exposures(std::span<const double> exposures, const std::string& field);

/// Merges frames of one scene at several exposures (HDR), before anything is decoded. In each pixel
/// those count in which no measurement is saturated or invalid, each by one over its variance,
///   sum_f w_f y_f / e_f / sum_f w_f,  w_f = e_f^2 / (e_f shot + constant),
/// where y_f are electrons and shot those of the shortest exposure, estimated from all that count;
/// of subtracted buckets, whose light is hidden, that is the least it can be. Pixels that are
/// saturated in all stay so, pixels that are invalid in all are NaN.
/// @param frames     of the table's measurements, or means as their `averaged` says
/// @param exposures  of each, over the shortest: that of the table
/// @throws std::invalid_argument as check_exposures(), or if sizes differ
/// @note the same bits for any number of threads
void merge_exposures(std::span<const RawView> frames, std::span<const double> exposures,
                     const DecodingTable& table, MergedExposures& merged);

/// Light that a lens scatters from every pixel to others, over the whole image: of light x the
/// sensor sees (1 - s) x + kernel * x, s the kernel's sum. What is scattered beyond the image is
/// lost; what comes from there is not known and stays.
/// Keeps what it made for frames of one size; not for several threads at once.
class StrayLight {
 public:
  /// @param kernel  (2 R + 1, 2 Q + 1): the share of a pixel's light that goes to each other, its
  ///                middle the pixel itself
  /// @throws std::invalid_argument unless it is of odd size, each share finite and >= 0, and their
  ///         sum < 0.5
  explicit StrayLight(Image<float> kernel);
  ~StrayLight();
  StrayLight(StrayLight&&) noexcept;
  StrayLight& operator=(StrayLight&&) noexcept;

  const Image<float>& kernel() const { return kernel_; }
  /// s, of all light.
  double share() const { return share_; }
  /// Memory that remove() takes for frames of this size [bytes].
  double memory_bytes(int height, int width, int measurements) const;

  /// What the sensor sees of light (H, W).
  Image<float> scatter(const Image<float>& light);
  /// The light of what the sensor sees: scatter() undone, by x <- (y - kernel * x) / (1 - s) until
  /// it changes by less than 1e-6 of the largest, 60 times at most.
  Image<float> gather(const Image<float>& seen);
  /// gather() of each measurement of a frame. Pixels that are saturated or invalid stay as they
  /// are; saturated ones scatter at least what they say, invalid ones nothing.
  /// @param table  whose black level and saturation the raw numbers have
  /// @param clean  (1, H, W, K), of noise about that of the raw numbers
  /// @throws std::invalid_argument if the measurements differ
  /// @note the same bits for any number of threads
  void remove(const RawView& raw, const DecodingTable& table, RawFrames& clean);

 private:
  struct Plan;
  const Plan& plan_of(int height, int width);
  Image<float> gathered(const Plan& plan, const Image<float>& seen) const;

  Image<float> kernel_;
  double share_ = 0.0;
  std::unique_ptr<Plan> plan_;
};

}  // namespace tofsmith

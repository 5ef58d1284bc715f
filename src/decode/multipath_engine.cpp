// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/multipath_engine.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "decode/multipath_support.hpp"
#include "decode/pixel_output.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/exponential_average.hpp"

namespace tofsmith {

namespace {

const DecodingTable& checked(const DecodingTable& table, const MultipathOptions& options) {
  table.validate();
  options.validate(table.range_m);
  return table;
}

double on_chord(const RowMajorMatrix& table, double bin, int k) {
  const auto from = std::min(static_cast<Eigen::Index>(bin), table.rows() - 1);
  const double t = bin - static_cast<double>(from);
  return (1 - t) * table(from, k) + t * table((from + 1) % table.rows(), k);
}

}  // namespace

/// Pixels that wait for a search, with their places in the block.
struct MultipathEngine::Queue {
  std::array<std::int64_t, pixels_per_group> pixel{};
  std::array<float, pixels_per_group> depth_m{};
  int count = 0;
};

MultipathEngine::MultipathEngine(DecodingTable table, const MultipathOptions& options,
                                 LaterLight later)
    : MultipathEngine(checked(table, options), options, later, AmbientProjection(table)) {}

MultipathEngine::MultipathEngine(DecodingTable table, const MultipathOptions& options,
                                 LaterLight later, const AmbientProjection& projection)
    : options_(options),
      later_(later),
      single_(std::move(table), options.doubt),
      scale_(single_.table()),
      noise_(single_.table()),
      has_own_shot_noise_(single_.table().shot_correlation.size() > 0),
      ambient_(projection.ambient),
      gated_(projection.gated),
      curve_(single_.table(), projection, later == LaterLight::tail ? options.tail_m : 0.0) {
  require(missing_support(projection, later));
  const DecodingTable& known = single_.table();
  const double points_per_m = curve_.points / known.range_m;
  const double longest_m = options.longest_delay_m.value_or(known.range_m / 3);
  delays_ = {static_cast<float>(points_per_m * options.shortest_delay_m),
             static_cast<float>(points_per_m * longest_m)};
  if (later == LaterLight::tail)
    gated_tail_ = exponential_average(gated_, options.tail_m / known.bin_m());
  const double freedom = curve_.span - 2;
  unexplained_chi2_ =
      static_cast<float>(freedom + std::sqrt(options.threshold) * std::sqrt(2 * freedom));
  if (options.prior) posterior_.emplace(curve_, *options.prior, known.range_m, delays_);
}

void MultipathEngine::decode(const RawView& raw, const DecodedView& decoded,
                             const Progress& progress) const {
  decode_frame(raw, decoded, table().measurements(), progress,
               [&](const float* values, std::int64_t pixels, const DecodedView& block) {
                 decode_block(values, pixels, block);
               });
}

void MultipathEngine::decode_depth_bins(const float* measurements, std::int64_t pixels,
                                        double* depth_bin) const {
  constexpr std::int64_t most = 16384;
  std::vector<float> depth_m(static_cast<std::size_t>(std::min(pixels, most)));
  for (std::int64_t first = 0; first < pixels; first += most) {
    const std::int64_t count = std::min(most, pixels - first);
    const float* raw = measurements + first * table().measurements();
    decode_block(raw, count, {.depth_m = depth_m.data()});
    std::transform(depth_m.begin(), depth_m.begin() + count, depth_bin + first,
                   [&](float depth) { return depth / table().bin_m(); });
  }
}

/// One pixel into a lane. Light that was seen tells how noisy it is; where buckets are subtracted,
/// what the single return says of it does.
void MultipathEngine::load(const float* raw, float depth_m, int lane, PixelGroup& group) const {
  const int k_count = table().measurements();
  const bool is_valid = std::isfinite(depth_m);
  const double bin = is_valid ? depth_m / table().bin_m() : 0.0;
  double along = 0.0, own = 0.0;
  for (int k = 0; k < k_count; ++k) {
    const double electrons = is_valid ? scale_.electrons(raw[k], k) : 0.0;
    group.electrons[k][lane] = static_cast<float>(electrons);
    group.variance_e2[k][lane] = static_cast<float>(
        std::max(least_variance_e2, std::max(electrons, 0.0) + noise_.floor_variance_e2[k]));
    if (!has_own_shot_noise_) continue;
    const double x = on_chord(gated_, bin, k);
    along += x * electrons;
    own += x * x;
  }
  group.guess[lane] = static_cast<float>(bin * curve_.points_per_bin);
  if (!has_own_shot_noise_) return;
  const double signal = own > 0.0 ? std::max(along / own, 0.0) : 0.0;
  for (int k = 0; k < k_count; ++k)
    group.variance_e2[k][lane] = static_cast<float>(
        std::max(least_variance_e2,
                 signal * on_chord(noise_.shot_gated, bin, k) + noise_.floor_variance_e2[k]));
}

void MultipathEngine::decode_block(const float* raw, std::int64_t pixels,
                                   const DecodedView& decoded) const {
  const int k_count = table().measurements();
  DecodedView planes = decoded;
  std::vector<float> own_depth;
  if (!planes.depth_m) {
    own_depth.resize(static_cast<std::size_t>(pixels));
    planes.depth_m = own_depth.data();
  }
  single_.decode(RawView::interleaved(raw, 1, static_cast<int>(pixels), k_count), planes);

  PixelGroup group;
  SingleFits fits;
  Queue queue;
  for (std::int64_t first = 0; first < pixels; first += pixels_per_group) {
    for (int lane = 0; lane < pixels_per_group; ++lane) {
      const std::int64_t pixel = std::min(first + lane, pixels - 1);
      load(raw + pixel * k_count, planes.depth_m[pixel], lane, group);
    }
    fit_single(curve_, group, fits);
    for (int lane = 0; lane < pixels_per_group && first + lane < pixels; ++lane) {
      const std::int64_t pixel = first + lane;
      const bool has_depth = std::isfinite(planes.depth_m[pixel]);
      const auto at = static_cast<std::size_t>(pixel);
      if (planes.returns)
        planes.returns[at] = has_depth ? ReturnStatus::single : ReturnStatus::none;
      for (float* plane : {planes.delay_m, planes.ratio})
        if (plane) plane[at] = std::numeric_limits<float>::quiet_NaN();
      if (!has_depth || is_single(fits.chi2[lane])) continue;
      queue.pixel[static_cast<std::size_t>(queue.count)] = pixel;
      queue.depth_m[static_cast<std::size_t>(queue.count)] = planes.depth_m[pixel];
      if (++queue.count == pixels_per_group) search(queue, raw, planes);
    }
  }
  if (queue.count > 0) search(queue, raw, planes);
}

void MultipathEngine::search(Queue& queue, const float* raw, const DecodedView& decoded) const {
  PixelGroup group;
  PairFits fits;
  for (int lane = 0; lane < pixels_per_group; ++lane) {
    const auto i = static_cast<std::size_t>(std::min(lane, queue.count - 1));
    load(raw + queue.pixel[i] * table().measurements(), queue.depth_m[i], lane, group);
  }
  fit_pair(curve_, delays_, group, fits);
  for (int lane = 0; lane < queue.count; ++lane)
    store(queue.pixel[static_cast<std::size_t>(lane)], group, fits, lane, decoded);
  queue.count = 0;
}

/// Weighted least squares of ambient light beside both returns.
double MultipathEngine::ambient_e_per_s(const PixelGroup& group, const PairFits& fits,
                                        int lane) const {
  const double per_bin = 1.0 / curve_.points_per_bin;
  const double bin = fits.position[lane] * per_bin;
  double later_bin = bin + fits.delay[lane] * per_bin;
  if (later_bin >= table().samples()) later_bin -= table().samples();
  const RowMajorMatrix& later = later_ == LaterLight::tail ? gated_tail_ : gated_;
  double along = 0.0, own = 0.0;
  for (int k = 0; k < table().measurements(); ++k) {
    const double left = group.electrons[k][lane] -
                        fits.signal_e_per_s[lane] * on_chord(gated_, bin, k) -
                        fits.second_e_per_s[lane] * on_chord(later, later_bin, k);
    along += left * ambient_[k] / group.variance_e2[k][lane];
    own += ambient_[k] * ambient_[k] / group.variance_e2[k][lane];
  }
  return own > 0.0 ? along / own : std::numeric_limits<double>::quiet_NaN();
}

/// What one return did not explain, with or without a second.
void MultipathEngine::store(std::int64_t pixel, const PixelGroup& group, const PairFits& fits,
                            int lane, const DecodedView& decoded) const {
  const auto at = static_cast<std::size_t>(pixel);
  const double point_m = table().range_m / curve_.points;
  const float drop = fits.single_chi2[lane] - fits.chi2[lane];
  const bool are_two = drop > static_cast<float>(options_.threshold);
  const bool is_explained =
      is_single(fits.single_chi2[lane]) || fits.single_chi2[lane] <= unexplained_chi2_;
  if (decoded.returns && !are_two && !is_explained) decoded.returns[at] = ReturnStatus::unresolved;
  if (!are_two && !posterior_) return;

  double position = fits.position[lane], deviation = fits.deviation[lane];
  if (posterior_) {
    const DepthPosterior posterior =
        posterior_->around(curve_, group, lane, are_two ? position : group.guess[lane]);
    position = posterior.median, deviation = posterior.deviation;
  }
  if (decoded.bin)
    decoded.bin[at] = static_cast<std::int32_t>(std::lround(position / curve_.points_per_bin)) %
                      table().samples();
  const auto depth_m = static_cast<float>(position * point_m);
  decoded.depth_m[at] = depth_m < static_cast<float>(table().range_m) ? depth_m : 0.0f;
  if (decoded.predicted_standard_deviation_m)
    decoded.predicted_standard_deviation_m[at] = static_cast<float>(deviation * point_m);
  if (!are_two) return;
  if (decoded.returns) decoded.returns[at] = ReturnStatus::two;
  if (decoded.signal_e_per_s) decoded.signal_e_per_s[at] = fits.signal_e_per_s[lane];
  if (decoded.ambient_e_per_s)
    decoded.ambient_e_per_s[at] = static_cast<float>(ambient_e_per_s(group, fits, lane));
  if (decoded.confidence) {
    const double lead = std::max(fits.rival_chi2[lane] - fits.chi2[lane], 0.0f);
    decoded.confidence[at] = static_cast<float>(1.0 / (1.0 + std::exp(-0.5 * lead)));
  }
  if (decoded.ratio) decoded.ratio[at] = fits.second_e_per_s[lane] / fits.signal_e_per_s[lane];
  if (decoded.delay_m)
    decoded.delay_m[at] = static_cast<float>(
        later_ == LaterLight::tail ? options_.tail_m : fits.delay[lane] * point_m);
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate/pixel_trials.hpp"

#include <algorithm>
#include <cmath>

#include "camera/shared/depth_prior.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

void PixelSums::add(const TrueDepths& true_m, double depth_m, double deviation_m,
                    PixelStatus status, double range_m) {
  inconsistent += status == PixelStatus::inconsistent;
  if (std::isnan(depth_m)) {  // as a guess; linear: in the middle of the range
    linear_m.add(std::abs(0.5 * range_m - true_m[0]));
    circular_m.add(0.25 * range_m);
    circular_square_m2.add(range_m * range_m / 12.0);
    return;
  }
  const double first_m = circular_difference(depth_m, true_m[0], range_m);
  const double second_m = circular_difference(depth_m, true_m[1], range_m);
  const double nearest_m = std::abs(second_m) < std::abs(first_m) ? second_m : first_m;
  linear_m.add(std::min(std::abs(depth_m - true_m[0]), std::abs(depth_m - true_m[1])));
  circular_m.add(std::abs(nearest_m));
  circular_square_m2.add(nearest_m * nearest_m);
  bias_m.add(nearest_m);
  if (!(std::abs(nearest_m) > 3.0 * deviation_m)) return;
  ++wrong;
  wrong_ok += status == PixelStatus::ok;
  wrong_inconsistent += status == PixelStatus::inconsistent;
}

Estimate PixelSums::circular_rmse_m() const {
  const double rmse_m = std::sqrt(circular_square_m2.mean());
  if (rmse_m == 0.0) return {};
  return {rmse_m, 0.5 * circular_square_m2.standard_error() / rmse_m};
}

WrongShares PixelSums::shares() const {
  const auto share = [&](std::int64_t count) {
    return static_cast<double>(count) / static_cast<double>(circular_m.count());
  };
  return {.wrong = share(wrong),
          .wrong_ok = share(wrong_ok),
          .wrong_inconsistent = share(wrong_inconsistent),
          .inconsistent = share(inconsistent)};
}

WrongShares mean_shares(const std::vector<WrongShares>& shares) {
  WrongShares mean;
  for (const WrongShares& one : shares)
    for (const auto share : {&WrongShares::wrong, &WrongShares::wrong_ok,
                             &WrongShares::wrong_inconsistent, &WrongShares::inconsistent})
      mean.*share += one.*share / static_cast<double>(shares.size());
  return mean;
}

std::optional<double> WrongShares::detected() const {
  if (!(wrong > 0.0)) return std::nullopt;
  return wrong_inconsistent / wrong;
}

PixelTrials::PixelTrials(const CodeSet& code, const Camera& camera, const EvaluateOptions& options)
    : camera_(camera),
      options_(options),
      depths_(camera),
      model_(code, camera),
      pixel_(model_, camera),
      decoder_(make_decoder(options.method, make_decoding_table(model_, camera), {},
                            options.unwrap_weights)) {}

std::pair<double, double> PixelTrials::draw_surface(double quantile, double signal_e_per_s,
                                                    RandomStream& random) const {
  const OperatingRange& operating = camera_.operating;
  const double albedo = operating.uniform_albedo ? random.uniform() : operating.albedo;
  return {depths_.quantile(quantile) * camera_.range_m(), albedo * signal_e_per_s};
}

void PixelTrials::add_decoded(const RawFrames& raw, const std::vector<TrueDepths>& true_m,
                              PixelSums& sums) const {
  DepthImage image({DecodedPlane::depth, DecodedPlane::deviation, DecodedPlane::status}, 1,
                   raw.width);
  decoder_->decode(RawView::interleaved(raw.values.data(), 1, raw.width, raw.measurements),
                   DecodedView::of(image));
  for (std::size_t i = 0; i < true_m.size(); ++i)
    sums.add(true_m[i], image.depth_m.pixels[i], image.deviation_m.pixels[i],
             image.status.pixels[i], camera_.range_m());
}

namespace {

Estimate mean_of_sum(double sum, double squared_differences, std::int64_t trials, double scale) {
  const double per_trial = scale / static_cast<double>(trials);
  return {sum * per_trial, std::sqrt(squared_differences) * per_trial};
}

/// The standard error is of first order.
Estimate root_mean_square(const PairSums& sums, std::int64_t trials, double scale) {
  const Estimate mean = mean_of_sum(sums.of_squares(), sums.squared_product, trials, 1.0);
  if (!(mean.value > 0.0)) return {};
  const double root = std::sqrt(mean.value);
  return {scale * root, scale * mean.standard_error / (2.0 * root)};
}

class AdaptiveTrials {
 public:
  AdaptiveTrials(const Camera& camera, const EvaluateOptions& options)
      : camera_(camera), options_(options) {}

  bool is_met(const ErrorSums& sums) const {
    const Estimate error = judged(sums);
    return sums.trials >= foreseen_trials(sums) &&
           error.standard_error <= options_.target_standard_error * error.value;
  }

  /// Returns 0 at the maximum.
  std::int64_t more_trials(const ErrorSums& sums) const {
    constexpr double margin = 1.1, min_growth = 1.5, max_growth = 16.0;
    const auto made = static_cast<double>(sums.trials);
    const Estimate error = judged(sums);
    const double miss = error.standard_error / (options_.target_standard_error * error.value);
    const double needed =
        std::max(margin * made * miss * miss, static_cast<double>(foreseen_trials(sums)));
    const double next = std::isfinite(needed)
                            ? std::clamp(needed, min_growth * made, max_growth * made)
                            : max_growth * made;
    const auto total = std::min(static_cast<double>(options_.max_trials), next);
    return std::max<std::int64_t>(0, static_cast<std::int64_t>((total - made) / 2)) * 2;
  }

 private:
  Estimate judged(const ErrorSums& sums) const {
    return camera_.operating.error == DepthErrorKind::linear ? sums.linear(camera_.bin_m())
                                                             : sums.circular(camera_.bin_m());
  }

  /// A few trials may contain no wrap and thus underestimate the variance. For uniform depths, the
  /// linear error is about twice the circular error, and its variance about (circular error) x
  /// range. If the ends are w times as frequent, the factors are 1 + w and w.
  std::int64_t foreseen_trials(const ErrorSums& sums) const {
    if (camera_.operating.error != DepthErrorKind::linear) return 0;
    const double circular_m = sums.circular(camera_.bin_m()).value;
    const double target = options_.target_standard_error;
    const DepthPrior depths(camera_);
    const double at_ends = 0.5 * (depths.density(0.0) + depths.density(1.0));
    if (!(circular_m > 0.0)) return 0;
    return static_cast<std::int64_t>(
        std::min(static_cast<double>(options_.max_trials),
                 at_ends * camera_.range_m() /
                     ((1 + at_ends) * (1 + at_ends) * circular_m * target * target)));
  }

  const Camera& camera_;
  const EvaluateOptions& options_;
};

/// Returns the number of points that miss the target.
int refine(const DepthTrials& trials, const AdaptiveTrials& plan, double threshold_bin,
           const Progress& progress, std::vector<ErrorSums>& of_point) {
  for (Progress left = progress;;) {
    std::vector<TrialRound> rounds;
    int short_of_target = 0;
    for (std::size_t p = 0; p < of_point.size(); ++p) {
      if (plan.is_met(of_point[p])) continue;
      ++short_of_target;
      if (const std::int64_t more = plan.more_trials(of_point[p]); more > 0)
        rounds.push_back({p, of_point[p].trials, more});
    }
    if (rounds.empty()) return short_of_target;
    const ProgressParts halves(left, 2);
    const auto added = sum_errors(trials, rounds, threshold_bin, halves[0]);
    left = halves[1];
    for (std::size_t r = 0; r < rounds.size(); ++r) of_point[rounds[r].point].merge(added[r]);
  }
}

}  // namespace

void ErrorSums::merge(const ErrorSums& other) {
  sums.merge(other.sums);
  trials += other.trials;
}

Estimate ErrorSums::linear(double bin_m) const {
  return mean_of_sum(sums.linear.sum, sums.linear.squared_difference, trials, bin_m);
}
Estimate ErrorSums::circular(double bin_m) const {
  return mean_of_sum(sums.circular.sum, sums.circular.squared_difference, trials, bin_m);
}
Estimate ErrorSums::linear_rms(double bin_m) const {
  return root_mean_square(sums.linear, trials, bin_m);
}
Estimate ErrorSums::circular_rms(double bin_m) const {
  return root_mean_square(sums.circular, trials, bin_m);
}
Estimate ErrorSums::outlier_rate() const {
  return mean_of_sum(sums.outliers, sums.outlier_squared_difference, trials, 1.0);
}

std::vector<ErrorSums> sum_errors(const DepthTrials& trials, std::span<const TrialRound> rounds,
                                  double threshold_bin, const Progress& progress) {
  return trials.sum(
      rounds, ErrorSums{},
      [&](ErrorSums& total, const TrialBlock& block) {
        const auto count = static_cast<int>(block.true_bin.size());
        total.merge({sum_errors(block.true_bin.data(), block.decoded_bin.data(), count,
                                trials.samples(), threshold_bin),
                     count});
      },
      progress);
}

DepthErrorReport trial_errors(const DepthTrials& trials, const CodeSet& code, const Camera& camera,
                              const EvaluateOptions& options, const Progress& progress) {
  const double bin_m = camera.bin_m(), threshold_bin = options.outlier_threshold_m / bin_m;
  const bool is_adaptive = options.target_standard_error > 0.0;
  const ProgressParts parts(progress, {10, is_adaptive ? 90.0 : 0.0});
  std::vector<ErrorSums> of_point =
      sum_errors(trials, trials.first_rounds(), threshold_bin, parts[0]);

  DepthErrorReport result;
  if (is_adaptive)
    result.points_short_of_target =
        refine(trials, AdaptiveTrials(camera, options), threshold_bin, parts[1], of_point);
  result.code = code.name();
  result.exposures = code.exposures();
  result.taps = code.taps();
  result.measurements = trials.measurements();
  result.samples = code.samples();
  result.seed = options.seed;
  result.outlier_threshold_m = options.outlier_threshold_m;
  for (std::size_t p = 0; p < of_point.size(); ++p) {
    const ErrorSums& sums = of_point[p];
    PointDepthError error;
    error.point = trials.points()[p];
    error.trials = sums.trials;
    error.linear_mde_m = sums.linear(bin_m);
    error.circular_mde_m = sums.circular(bin_m);
    error.linear_rmse_m = sums.linear_rms(bin_m);
    error.circular_rmse_m = sums.circular_rms(bin_m);
    error.outlier_rate = sums.outlier_rate();
    result.trials = std::max(result.trials, sums.trials);
    result.points.push_back(error);
  }
  result.linear = mean_over_points(result.points, &PointDepthError::linear_mde_m);
  result.circular = mean_over_points(result.points, &PointDepthError::circular_mde_m);
  result.linear_rmse = mean_over_points(result.points, &PointDepthError::linear_rmse_m);
  result.circular_rmse = mean_over_points(result.points, &PointDepthError::circular_rmse_m);
  return result;
}

}  // namespace tofsmith

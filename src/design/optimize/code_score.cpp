// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/optimize/code_score.hpp"

#include <algorithm>
#include <cmath>

#include "simulate/shared/error_by_rotation.hpp"

namespace tofsmith {

namespace {

constexpr double min_error_bin = 1e-9;  // avoids log(0)

SampledCode on_grid_of(const SampledCamera& judge, const SampledCode& code) {
  const int repeat = judge.samples() / code.samples();
  if (repeat == 1) return code;
  SampledCode fine{Eigen::MatrixXd(judge.samples(), code.modulation.cols()),
                   Eigen::MatrixXd(judge.samples(), code.demodulation.cols()), code.shares};
  for (int n = 0; n < judge.samples(); ++n) {
    fine.modulation.row(n) = code.modulation.row(n / repeat);
    fine.demodulation.row(n) = code.demodulation.row(n / repeat);
  }
  return fine;
}

/// correlation'(z) = correlation(z + rotation_bin)
SampledCode rotated(const SampledCode& code, int rotation_bin) {
  SampledCode result = code;
  const int samples = code.samples();
  for (int n = 0; n < samples; ++n)
    result.modulation.row((n + rotation_bin) % samples) = code.modulation.row(n);
  return result;
}

std::vector<TrialBatch> draw_batches(const DesignProblem& problem, int trials, bool ends_matter,
                                     const DepthPrior& depths, std::uint64_t seed,
                                     std::uint64_t work_item) {
  const CameraVariant* widest = &problem.variants.front();
  for (const CameraVariant& variant : problem.variants)
    if (variant.levels.size() > widest->levels.size()) widest = &variant;
  std::vector<TrialBatch> batches;
  for (std::size_t p = 0; p < widest->levels.size(); ++p) {
    RandomStream random(seed, work_item, static_cast<std::uint32_t>(2 * p + ends_matter));
    const LightLevel& level = widest->levels[p];
    batches.push_back(draw_trials(DesignProblem::trials_of(level, trials), problem.measurements(),
                                  problem.operating, ends_matter, random, nullptr,
                                  problem.multipath_of(level), depths));
  }
  return batches;
}

/// Returns the linear error [bin], averaged over origins of depth within `window` of bin 0. The
/// expected error hardly depends on the origin close to the best one, and the average has a much
/// smaller variance.
double linear_error_bin(double true_bin, double decoded_bin, int samples, double window) {
  const double difference = decoded_bin - true_bin;
  const double error = difference - samples * std::round(difference / samples);
  const double low = std::min(true_bin, true_bin + error), high = low + std::abs(error);
  double separating = 0.0;  // length of origins between the two depths
  for (const int origin : {0, samples})
    separating += std::max(0.0, std::min(high, origin + window) - std::max(low, origin - window));
  const double circular = std::abs(error);
  return circular + separating / (2.0 * window) * (samples - 2.0 * circular);
}

/// Always circular for two-return decoding.
double mean_error_bin(const TrialBatch& batch, const std::vector<double>& decoded_bin, int samples,
                      bool linear) {
  constexpr double window_periods = 1.0 / 120.0;
  linear = linear && !batch.two_returns;
  double sum = 0.0;
  for (std::size_t t = 0; t < decoded_bin.size(); ++t) {
    const double true_bin = batch.trials[t].depth_periods * samples;
    const double error = std::abs(true_bin - decoded_bin[t]);
    sum += batch.trials[t].weight *
           (linear ? linear_error_bin(true_bin, decoded_bin[t], samples, window_periods * samples)
                   : std::min(error, samples - error));
  }
  return sum / static_cast<double>(decoded_bin.size());
}

template <typename Errors>
std::vector<double> sums_of(Errors errors, const TrialBatch& batch,
                            const std::vector<double>& decoded_bin) {
  for (std::size_t t = 0; t < decoded_bin.size(); ++t) {  // the end of the last chord is bin 0
    const int samples = errors.samples();
    errors.add(batch.trials[t].depth_periods * samples,
               std::min(decoded_bin[t], std::nextafter(samples, 0.0)));
  }
  return errors.sums();
}

}  // namespace

CodeJudge::CodeJudge(const DesignProblem& problem, int trials, std::uint64_t seed,
                     std::uint64_t work_item)
    : problem_(&problem),
      judging_(draw_batches(problem, trials, problem.linear(), problem.depths, seed, work_item)) {
  // Too few trials would rotate codes away from their best origin.
  constexpr int enough = 1000;
  const int rotating_trials = std::min(trials, std::max(enough, trials / 4));
  if (problem.linear() || !problem.depths.is_uniform())
    rotating_ = draw_batches(problem, rotating_trials, false, DepthPrior(), seed, work_item);
}

CodeScore CodeJudge::score(const SampledCode& code) const {
  const SampledCode fine = on_grid_of(problem_->variants.front().judge, code);
  const int finer = fine.samples() / code.samples();
  const double in_bins_of_code = std::log(finer);
  if (rotating_.empty()) return {log_error(fine) - in_bins_of_code, 0};
  const int rotation = best_rotation(fine);
  return {log_error(rotated(fine, rotation)) - in_bins_of_code, rotation / finer};
}

double CodeJudge::log_error(const SampledCode& code) const {
  double worst = -1e300;
  std::vector<double> decoded_bin;
  for (const CameraVariant& variant : problem_->variants) {
    const SampledCamera::Measured measured = variant.judge.measure(code);
    DepthErrorLoss loss(variant.judge, measured.table, measured.times, problem_->operating.error);
    double sum = 0.0;
    for (std::size_t p = 0; p < variant.levels.size(); ++p) {
      loss.decode(variant.levels[p].point, judging_[p], decoded_bin);
      sum += variant.levels[p].weight *
             std::log(std::max(min_error_bin, mean_error_bin(judging_[p], decoded_bin,
                                                             code.samples(), problem_->linear())));
    }
    worst = std::max(worst, sum / variant.total_weight());
  }
  return worst;
}

int CodeJudge::best_rotation(const SampledCode& code) const {
  const int samples = code.samples();
  std::vector<double> worst(static_cast<std::size_t>(samples), -1e300), decoded_bin;
  for (const CameraVariant& variant : problem_->variants) {
    const SampledCamera::Measured measured = variant.judge.measure(code);
    DepthErrorLoss loss(variant.judge, measured.table, measured.times, problem_->operating.error);
    std::vector<double> log_error(worst.size(), 0.0);
    for (std::size_t p = 0; p < variant.levels.size(); ++p) {
      const DepthPrior& depths = problem_->depths;
      const bool circular = !problem_->linear() || rotating_[p].two_returns;
      if (circular && depths.is_uniform()) continue;  // independent of the rotation
      loss.decode(variant.levels[p].point, rotating_[p], decoded_bin);
      const auto kind = circular ? DepthErrorKind::circular : DepthErrorKind::linear;
      const std::vector<double> sums =
          depths.is_uniform()
              ? sums_of(ErrorByRotation(samples), rotating_[p], decoded_bin)
              : sums_of(WeighedErrorByRotation(depths, kind, samples), rotating_[p], decoded_bin);
      for (std::size_t r = 0; r < sums.size(); ++r)
        log_error[r] += variant.levels[p].weight * std::log(std::max(min_error_bin, sums[r])) /
                        variant.total_weight();
    }
    for (std::size_t r = 0; r < worst.size(); ++r) worst[r] = std::max(worst[r], log_error[r]);
  }
  return best_of_rotations(smoothed_over_rotations(worst));
}

WaveformParameters rotated(const WaveformSpace& space, const WaveformParameters& parameters,
                           int rotation_bin) {
  const int cells = (rotation_bin + space.repeat / 2) / space.repeat % space.cells;
  WaveformParameters result = parameters;
  for (int c = 0; c < space.cells; ++c)
    result.modulation.row((c + cells) % space.cells) = parameters.modulation.row(c);
  return result;
}

}  // namespace tofsmith

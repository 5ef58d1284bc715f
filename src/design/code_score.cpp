// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/code_score.hpp"

#include <algorithm>
#include <cmath>

#include "design/depth_error_loss.hpp"
#include "simulate/error_by_rotation.hpp"

namespace tofsmith {

namespace {

/// Sums over the trials of the error at every rotation; one entry for the circular error.
std::vector<double> error_sums(const TrialBatch& batch, const std::vector<double>& decoded_bin,
                               int samples, bool linear) {
  if (linear) {
    ErrorByRotation errors(samples);
    for (std::size_t t = 0; t < decoded_bin.size(); ++t) {
      // The end of the last chord is the origin.
      const double decoded = std::min(decoded_bin[t], std::nextafter(samples, 0.0));
      errors.add(batch.trials[t].depth_periods * samples, decoded);
    }
    return errors.sums();
  }
  double sum = 0.0;
  for (std::size_t t = 0; t < decoded_bin.size(); ++t) {
    const double error = std::abs(batch.trials[t].depth_periods * samples - decoded_bin[t]);
    sum += std::min(error, samples - error);
  }
  return {sum};
}

}  // namespace

CodeJudge::CodeJudge(const DesignProblem& problem, int trials, std::uint64_t seed,
                     std::uint64_t work_item)
    : problem_(&problem) {
  std::size_t most = 0;
  for (const CameraVariant& variant : problem.variants)
    most = std::max(most, variant.points.size());
  for (std::size_t p = 0; p < most; ++p) {
    RandomStream random(seed, work_item, static_cast<std::uint32_t>(p));
    batches_.push_back(draw_trials(trials, problem.measurements(), problem.operating,
                                   /*ends_matter=*/false, random));
  }
}

CodeScore CodeJudge::score(const SampledCode& code) const {
  const int samples = code.samples();
  const bool linear = problem_->linear();
  std::vector<double> worst(linear ? static_cast<std::size_t>(samples) : 1, -1e300), decoded_bin;
  for (const CameraVariant& variant : problem_->variants) {
    DepthErrorLoss loss(variant.camera, variant.camera.measure(code).table,
                        problem_->operating.error);
    std::vector<double> log_error(worst.size(), 0.0);
    for (std::size_t p = 0; p < variant.points.size(); ++p) {
      loss.decode(variant.points[p], batches_[p], decoded_bin);
      const std::vector<double> sums = error_sums(batches_[p], decoded_bin, samples, linear);
      for (std::size_t r = 0; r < sums.size(); ++r)
        log_error[r] += std::log(std::max(1e-9, sums[r] / static_cast<double>(decoded_bin.size())));
    }
    for (std::size_t r = 0; r < worst.size(); ++r)
      worst[r] = std::max(worst[r], log_error[r] / static_cast<double>(variant.points.size()));
  }
  const auto best = std::min_element(worst.begin(), worst.end());
  return {*best, static_cast<int>(best - worst.begin())};
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

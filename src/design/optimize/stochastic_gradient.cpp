// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/optimize/stochastic_gradient.hpp"

#include <algorithm>
#include <cmath>

#include "design/optimize/depth_error_loss.hpp"

namespace tofsmith {

namespace {
constexpr double worst_case_sharpness = 20.0;
}

StochasticGradient::StochasticGradient(const DesignProblem& problem, int trials,
                                       RandomStream random)
    : problem_(&problem), trials_(trials), noise_(random) {
  for (const CameraVariant& variant : problem.variants)
    average_error_.emplace_back(variant.levels.size(), 0.0);
}

double StochasticGradient::mean_log(std::size_t variant) const {
  const CameraVariant& its = problem_->variants[variant];
  double sum = 0.0;
  for (std::size_t p = 0; p < its.levels.size(); ++p)
    sum += its.levels[p].weight * std::log(std::max(1e-12, average_error_[variant][p]));
  return sum / its.total_weight();
}

double StochasticGradient::weight(std::size_t variant, std::size_t point) const {
  double total = 0.0;
  for (std::size_t v = 0; v < average_error_.size(); ++v)
    total += std::exp(worst_case_sharpness * (mean_log(v) - mean_log(variant)));
  const CameraVariant& its = problem_->variants[variant];
  return its.levels[point].weight / (total * its.total_weight() * average_error_[variant][point]);
}

void StochasticGradient::add(std::size_t variant, std::size_t point, double error) {
  double& average = average_error_[variant][point];
  average = average > 0.0 ? 0.9 * average + 0.1 * error : error;
}

SampledCode StochasticGradient::at(const SampledCode& code, double decision_sharpness,
                                   RandomStream& random) {
  SampledCode gradient{Eigen::MatrixXd::Zero(code.modulation.rows(), code.modulation.cols()),
                       Eigen::MatrixXd::Zero(code.demodulation.rows(), code.demodulation.cols()),
                       Eigen::VectorXd::Zero(code.shares.size())};
  for (std::size_t v = 0; v < problem_->variants.size(); ++v) {
    const CameraVariant& variant = problem_->variants[v];
    const SampledCamera::Measured measured = variant.camera.measure(code);
    DepthErrorLoss loss(variant.camera, measured.table, measured.times, problem_->operating.error);
    const int trials =
        trials_ / static_cast<int>(variant.usual_levels() * problem_->variants.size());
    for (std::size_t p = 0; p < variant.levels.size(); ++p) {
      const LightLevel& level = variant.levels[p];
      const TrialBatch batch =
          draw_trials(DesignProblem::trials_of(level, trials), variant.camera.measurements(),
                      problem_->operating, problem_->linear(), random, &noise_,
                      problem_->multipath_of(level), problem_->depths);
      const double sharpness = decision_sharpness / loss.mean_variance_e2(level.point);
      if (average_error_[v][p] == 0.0)
        add(v, p, std::max(1e-9, loss.soft_error(level.point, batch, sharpness)));
      add(v, p, std::max(1e-9, loss.soft_error(level.point, batch, sharpness, weight(v, p))));
    }
    Eigen::VectorXd by_exposure_s = Eigen::VectorXd::Zero(variant.camera.measurements());
    const SampledCode part = variant.camera.pull_back(measured, loss.gradient(&by_exposure_s));
    gradient.modulation += part.modulation;
    gradient.demodulation += part.demodulation;
    if (code.shares.size() > 0) gradient.shares += variant.camera.pull_back_times(by_exposure_s);
  }
  return gradient;
}

}  // namespace tofsmith

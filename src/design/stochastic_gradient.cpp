// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/stochastic_gradient.hpp"

#include <algorithm>
#include <cmath>

#include "design/depth_error_loss.hpp"

namespace tofsmith {

namespace {
constexpr double worst_case_sharpness = 20.0;  // per unit of log error
}

StochasticGradient::StochasticGradient(const DesignProblem& problem, int trials,
                                       RandomStream random)
    : problem_(&problem), trials_(trials), noise_(random) {
  for (const CameraVariant& variant : problem.variants)
    average_error_.emplace_back(variant.points.size(), 0.0);
}

double StochasticGradient::mean_log(std::size_t variant) const {
  double sum = 0.0;
  for (const double average : average_error_[variant]) sum += std::log(std::max(1e-12, average));
  return sum / static_cast<double>(average_error_[variant].size());
}

double StochasticGradient::weight(std::size_t variant, std::size_t point) const {
  double total = 0.0;
  for (std::size_t v = 0; v < average_error_.size(); ++v)
    total += std::exp(worst_case_sharpness * (mean_log(v) - mean_log(variant)));
  return 1.0 / (total * static_cast<double>(average_error_[variant].size()) *
                average_error_[variant][point]);
}

void StochasticGradient::add(std::size_t variant, std::size_t point, double error) {
  double& average = average_error_[variant][point];
  average = average > 0.0 ? 0.9 * average + 0.1 * error : error;
}

SampledCode StochasticGradient::at(const SampledCode& code, double doubt, RandomStream& random) {
  SampledCode gradient{Eigen::MatrixXd::Zero(code.modulation.rows(), code.modulation.cols()),
                       Eigen::MatrixXd::Zero(code.demodulation.rows(), code.demodulation.cols())};
  for (std::size_t v = 0; v < problem_->variants.size(); ++v) {
    const CameraVariant& variant = problem_->variants[v];
    const SampledCamera::Measured measured = variant.camera.measure(code);
    DepthErrorLoss loss(variant.camera, measured.table, problem_->operating.error);
    const auto levels = static_cast<int>(variant.points.size() * problem_->variants.size());
    for (std::size_t p = 0; p < variant.points.size(); ++p) {
      const TrialBatch batch =
          draw_trials(std::max(8, trials_ / levels), variant.camera.measurements(),
                      problem_->operating, problem_->linear(), random, &noise_);
      const double sharpness = doubt / loss.mean_variance_e2(variant.points[p]);
      if (average_error_[v][p] == 0.0)
        add(v, p, std::max(1e-9, loss.soft_error(variant.points[p], batch, sharpness)));
      add(v, p, std::max(1e-9, loss.soft_error(variant.points[p], batch, sharpness, weight(v, p))));
    }
    const SampledCode part = variant.camera.pull_back(measured, loss.gradient());
    gradient.modulation += part.modulation;
    gradient.demodulation += part.demodulation;
  }
  return gradient;
}

}  // namespace tofsmith

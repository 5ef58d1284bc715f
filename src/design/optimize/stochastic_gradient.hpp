// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/shared/random.hpp"
#include "design/optimize/design_problem.hpp"
#include "design/optimize/trial_batch.hpp"

namespace tofsmith {

/// Stochastic gradient of the objective with respect to the waveforms, from new trials in every
/// call. The objective is the smooth maximum, over the variants of the camera, of the mean log
/// error over the light levels. The weights of the levels follow from running means of their
/// errors.
class StochasticGradient {
 public:
  /// @param trials  per call, over all light levels and variants
  /// @param random  for the stored noise
  StochasticGradient(const DesignProblem& problem, int trials, RandomStream random);

  /// @param decision_sharpness  sharpness of decisions per log likelihood
  SampledCode at(const SampledCode& code, double decision_sharpness, RandomStream& random);

 private:
  double mean_log(std::size_t variant) const;
  double weight(std::size_t variant, std::size_t point) const;
  void add(std::size_t variant, std::size_t point, double error);

  const DesignProblem* problem_;
  int trials_;
  NoiseStore noise_;
  std::vector<std::vector<double>> average_error_;  // 0: not yet known
};

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/shared/random.hpp"
#include "design/optimize/design_problem.hpp"
#include "design/optimize/trial_batch.hpp"

namespace tofsmith {

/// Stochastic gradient w.r.t. the waveforms and shares, from new trials in every call. The
/// objective is the smooth maximum over camera variants of the mean log error over light levels.
class StochasticGradient {
 public:
  /// @param trials  per call, in total
  StochasticGradient(const DesignProblem& problem, int trials, RandomStream random);

  /// @param decision_sharpness  per log likelihood
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

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "design/factorize/pair_model.hpp"

namespace tofsmith {

struct SampledPair {
  Eigen::VectorXd modulation;    // (N), in [0, p], mean <= 1
  Eigen::VectorXd demodulation;  // (N), in [0, 1]
};

Eigen::VectorXd binary_demodulation(const Eigen::VectorXd& x, double threshold);

/// On where x > threshold * max(x), with unit mean power, or at the peak if lower.
Eigen::VectorXd binary_modulation(const Eigen::VectorXd& x, double threshold, double peak_factor);

struct BinaryProjection {
  SampledPair pair;
  double residual_rms;
};

/// Thresholds each binary arm at the best of 19 levels with the other arm fixed, twice.
BinaryProjection project_to_binary(const PairModel& model, const SampledPair& relaxed);

}  // namespace tofsmith

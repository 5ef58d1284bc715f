// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "design/factorize/pair_model.hpp"

namespace tofsmith {

/// Sampled waveforms of one measurement.
struct SampledPair {
  Eigen::VectorXd modulation;    // (N), in [0, p], mean <= 1
  Eigen::VectorXd demodulation;  // (N), in [0, 1]
};

/// 1 where x > threshold, else 0.
Eigen::VectorXd binary_demodulation(const Eigen::VectorXd& x, double threshold);

/// On where x > threshold times its maximum, at the level of unit mean power, or at the peak where
/// that is lower.
Eigen::VectorXd binary_modulation(const Eigen::VectorXd& x, double threshold, double peak_factor);

struct BinaryProjection {
  SampledPair pair;
  double residual_rms;
};

/// The nearest playable pair: arms that may only switch are thresholded, each at the level (of 19)
/// that leaves the smallest residual with the other arm as it is; twice in turn.
BinaryProjection project_to_binary(const PairModel& model, const SampledPair& relaxed);

}  // namespace tofsmith

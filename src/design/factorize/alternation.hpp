// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "design/factorize/pair_model.hpp"
#include "tofsmith/design/circulant_tv.hpp"
#include "tofsmith/design/factorize.hpp"

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

struct AlternationResult {
  SampledPair relaxed;
  SampledPair playable;  ///< best projection of all iterates
  double playable_residual_rms = 0.0;
  std::vector<FactorizeIteration> history;
};

/// Alternates the convex steps of problem (6) / (7) from `start`: optimizes demodulation and
/// modulation in turn.
///
/// With c the current rms, rms <= rms^2 / (2 c) + c / 2 converts each step to 1/2 |A x - b|^2 +
/// lambda N c TV(x), which does not increase the objective.
/// @param total_variation_weight  lambda >= 0; 0 omits total variation: each step then starts from
///   the previous waveforms, because the solution is not unique
AlternationResult alternate(const PairModel& model, SampledPair start,
                            double total_variation_weight, const FactorizeOptions& options,
                            CirculantTvSolver& solver);

struct AlternationStart {
  std::string name;
  SampledPair pair;
};

AlternationStart random_start(const PairModel& model, std::uint64_t seed, int index);

/// Returns binary pairs of the thresholded target with single pulses and pulse trains.
std::vector<PairCandidate> structured_starts(const PairModel& model);

/// Returns the target's ideal demodulation with one pulse of duty max(1/p, ideal); empty if unknown
/// or not supported.
std::vector<PairCandidate> naive_start(const PairModel& model);

}  // namespace tofsmith

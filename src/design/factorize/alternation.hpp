// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/shared/periodic.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/design/circulant_tv.hpp"
#include "tofsmith/design/factorize.hpp"

namespace tofsmith {

/// Model of both arms for waveforms that are constant within cells, and the residual to a target at
/// the N bins, where the model is exact (grid_transfer()).
class PairModel {
 public:
  PairModel(const CorrelationTarget& target, const Camera& camera);

  const Camera& camera() const { return camera_; }
  int samples() const { return transform_.samples(); }
  double peak_factor() const { return camera_.light.peak_factor; }
  bool binary_modulation() const { return camera_.light.binary; }
  bool binary_demodulation() const { return camera_.sensor.binary; }
  double shortest_run() const { return shortest_run_; }
  const CorrelationTarget& target() const { return target_; }
  /// The target at the bins; reversed in time for the modulation step.
  const Eigen::VectorXd& target_samples() const { return target_.samples; }
  const Eigen::VectorXd& reversed_target_samples() const { return reversed_target_; }

  Eigen::VectorXcd spectrum(const Eigen::VectorXd& samples) const;

  /// First column of the circulant matrix that maps demodulation to correlation samples.
  Eigen::VectorXd demodulation_kernel(const Eigen::VectorXd& modulation) const;
  /// First column for modulation and time-reversed correlation samples.
  Eigen::VectorXd modulation_kernel(const Eigen::VectorXd& demodulation) const;

  double residual_rms(const Eigen::VectorXcd& modulation,
                      const Eigen::VectorXcd& demodulation) const;
  double residual_rms(const Eigen::VectorXd& modulation, const Eigen::VectorXd& demodulation) const;
  /// RMS residual over depth with exact switching times and 8 points per bin; the target is linear
  /// between bins. Uses the actual waveforms of generators; infinite if the actual modulation is
  /// zero.
  double residual_rms(const WaveformPair& pair) const;

 private:
  WaveformPair actual(const WaveformPair& pair) const;

  CorrelationTarget target_;
  Camera camera_;
  double shortest_run_;
  PeriodicTransform transform_;
  Eigen::VectorXd reversed_target_;
  Eigen::VectorXcd target_spectrum_;
  Eigen::VectorXcd grid_transfer_;  // G / N
};

struct SampledPair {
  Eigen::VectorXd modulation;    // (N), in [0, p], mean <= 1
  Eigen::VectorXd demodulation;  // (N), in [0, 1]
};

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

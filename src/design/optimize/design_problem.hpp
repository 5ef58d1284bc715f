// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "design/optimize/sampled_camera.hpp"
#include "design/optimize/trial_batch.hpp"
#include "design/optimize/waveform_parameters.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/design/optimize.hpp"

namespace tofsmith {

/// Returns in a trial, and the number that the decoder assumes.
enum class TrialReturns { one, two_taken_for_one, two };

struct LightLevel {
  OperatingPoint point;
  TrialReturns returns = TrialReturns::one;
  double weight = 1.0;  ///< of the log error in the mean over all levels
};

/// A grid and its training light levels.
struct CameraVariant {
  SampledCamera camera;
  /// Model for evaluating codes. Without band limit it has the camera's grid, because more bins
  /// reduce the errors of the decoder.
  SampledCamera judge;
  std::vector<LightLevel> levels;

  double total_weight() const;
  std::size_t usual_levels() const;
};

/// Minimizes the error on the worst variant of a camera, by weighted geometric means over light
/// levels.
struct DesignProblem {
  WaveformSpace space;
  std::vector<CameraVariant> variants;  ///< the camera itself first; never empty
  OperatingRange operating;             ///< kind of error and albedo
  DepthPrior depths;
  double shortest_run_periods = 0.0;
  std::optional<MultipathTrials> later;
  std::optional<MultipathTrials> multipath_as_two;  ///< second returns decoded as two returns
  bool binary_modulation = true, binary_demodulation = true;

  /// Null without second returns.
  const MultipathTrials* multipath_of(const LightLevel& level) const {
    if (level.returns == TrialReturns::one) return nullptr;
    return level.returns == TrialReturns::two ? &*multipath_as_two : &*later;
  }
  int measurements() const { return variants.front().camera.measurements(); }
  /// Uses fewer trials for two-return decoding, which is expensive.
  static int trials_of(const LightLevel& level, int trials) {
    constexpr int min_trials = 8;
    return std::max(min_trials, level.returns == TrialReturns::two ? trials / 4 : trials);
  }
  bool linear() const { return operating.error == DepthErrorKind::linear; }
};

/// Chooses the requested number of cells, or of shortest pulses per period, slightly reduced if a
/// pulse at the peak then fills whole cells.
WaveformSpace waveform_space(const Camera& camera, int exposures, int samples);

/// Returns the operating points, or 6 signal x 6 ambient levels for more than 40: spaced evenly in
/// the logarithm of signal, and of ambient light above the floor of read noise.
std::vector<OperatingPoint> training_points(const Camera& camera);

/// Returns why codes of a valid camera cannot be optimized, or nothing: too few measurements,
/// constant light, neither band limit nor shortest pulse, or a shortest pulse too long for the
/// period.
std::optional<BrokenRule> why_not_optimizable(const Camera& camera, int exposures);

/// With operating.multipath, adds levels with second returns, decoded as one return and, with
/// enough measurements, as two.
/// @throws std::invalid_argument as why_not_optimizable(), or if variants support different codes
DesignProblem make_design_problem(std::span<const Camera> variants, int exposures, int samples,
                                  double two_return_weight = 0.0);

}  // namespace tofsmith

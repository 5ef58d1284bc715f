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

/// Returns in every trial, and the number of returns assumed by the decoder.
enum class TrialReturns { one, two_taken_for_one, two };

/// Light conditions for the evaluation of a code.
struct LightLevel {
  OperatingPoint point;
  TrialReturns returns = TrialReturns::one;
  double weight = 1.0;  ///< weight of the log error in the mean over all levels
};

/// Model of a camera for the optimizer: a grid and the light levels of the training.
struct CameraVariant {
  SampledCamera camera;
  /// The model for evaluating codes. Without a bandwidth limit it has the grid of the camera,
  /// because more bins reduce the errors of the decoder.
  SampledCamera judge;
  std::vector<LightLevel> levels;

  double total_weight() const;
  /// Returns the number of levels that are not decoded as two returns.
  std::size_t usual_levels() const;
};

/// Optimization problem: waveforms of a space, to minimize the error on the worst variant of a
/// camera. The error of a variant is the weighted geometric mean over its light levels.
struct DesignProblem {
  WaveformSpace space;
  std::vector<CameraVariant> variants;              ///< the camera itself first; never empty
  OperatingRange operating;                         ///< kind of error and albedo
  DepthPrior depths;                                ///< prior of the depths
  double shortest_run_periods = 0.0;                ///< of binary waveforms
  std::optional<MultipathTrials> later;             ///< second returns of levels that have them
  std::optional<MultipathTrials> multipath_as_two;  ///< second returns decoded as two returns
  bool binary_modulation = true, binary_demodulation = true;

  /// Returns the second returns of the trials at a level, or null.
  const MultipathTrials* multipath_of(const LightLevel& level) const {
    if (level.returns == TrialReturns::one) return nullptr;
    return level.returns == TrialReturns::two ? &*multipath_as_two : &*later;
  }
  int measurements() const { return variants.front().camera.measurements(); }
  /// Returns the number of trials for a level; decoding two returns is expensive and has fewer.
  static int trials_of(const LightLevel& level, int trials) {
    constexpr int min_trials = 8;
    return std::max(min_trials, level.returns == TrialReturns::two ? trials / 4 : trials);
  }
  bool linear() const { return operating.error == DepthErrorKind::linear; }
};

/// Chooses the grid for a camera: the requested number of cells, or the number of shortest pulses
/// that fit into a period. It is reduced slightly if then a pulse at the peak fills whole cells.
WaveformSpace waveform_space(const Camera& camera, int exposures, int samples);

/// Returns the points of the camera's operating range. If there are more than 40, returns 6 signal
/// x 6 ambient levels instead, evenly spaced in the logarithm of signal, and of ambient light above
/// the floor set by read noise.
std::vector<OperatingPoint> training_points(const Camera& camera);

/// Returns why codes with this number of exposures cannot be optimized for a valid camera, or
/// nothing: too few measurements, constant light, neither bandwidth limit nor shortest pulse, or a
/// shortest pulse that is too long for the period.
std::optional<BrokenRule> why_not_optimizable(const Camera& camera, int exposures);

/// Creates the optimization problem. With operating.multipath, levels with second returns are
/// added, decoded as one return and, if there are enough measurements, as two returns.
/// @param two_return_weight  OptimizeOptions::two_return_weight
/// @throws std::invalid_argument as why_not_optimizable(), or if the variants support different
///   codes
DesignProblem make_design_problem(std::span<const Camera> variants, int exposures, int samples,
                                  double two_return_weight = 0.0);

}  // namespace tofsmith

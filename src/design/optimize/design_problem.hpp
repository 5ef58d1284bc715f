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

/// What comes back in every trial, and what the decoder takes it for.
enum class TrialReturns { one, two_taken_for_one, two };

/// Light that a code is judged in.
struct LightLevel {
  OperatingPoint point;
  TrialReturns returns = TrialReturns::one;
  double weight = 1.0;  ///< of its log error among those of all levels
};

/// A camera as the optimizer sees it: on a grid, at the light levels it learns from.
struct CameraVariant {
  SampledCamera camera;
  /// The same on the grid codes are judged on: that of the camera itself where nothing limits the
  /// band, since there a decoder with more bins goes wrong less often.
  SampledCamera judge;
  std::vector<LightLevel> levels;

  double total_weight() const;
  /// Without those of two returns.
  std::size_t usual_levels() const;
};

/// What is to be optimized: waveforms of a space, for the error of the worst of one or more
/// variants of a camera; of each, the weighted geometric mean over its light levels.
struct DesignProblem {
  WaveformSpace space;
  std::vector<CameraVariant> variants;              ///< the first is the camera itself; never empty
  OperatingRange operating;                         ///< kind of error and albedo
  DepthPrior depths;                                ///< how often they occur
  double shortest_run_periods = 0.0;                ///< of binary waveforms
  std::optional<MultipathTrials> later;             ///< second returns of the levels that have them
  std::optional<MultipathTrials> multipath_as_two;  ///< the same, decoded as two returns
  bool binary_modulation = true, binary_demodulation = true;

  /// Second returns of a level's trials; null: none.
  const MultipathTrials* multipath_of(const LightLevel& level) const {
    if (level.returns == TrialReturns::one) return nullptr;
    return level.returns == TrialReturns::two ? &*multipath_as_two : &*later;
  }
  int measurements() const { return variants.front().camera.measurements(); }
  /// How many trials a level takes where one of single returns takes so many: pairs are expensive.
  static int trials_of(const LightLevel& level, int trials) {
    constexpr int min_trials = 8;
    return std::max(min_trials, level.returns == TrialReturns::two ? trials / 4 : trials);
  }
  bool linear() const { return operating.error == DepthErrorKind::linear; }
};

/// The grid for a camera: as many cells as asked, or as many of the shortest pulse as fit in a
/// period, such that a pulse at the peak fills whole cells where that costs little.
WaveformSpace waveform_space(const Camera& camera, int exposures, int samples);

/// The points of the camera's operating range; where they are more than 40, 6 signal by 6 ambient
/// levels in between, spread evenly over the logarithm of signal, and of ambient over the floor
/// that read noise sets.
std::vector<OperatingPoint> training_points(const Camera& camera);

/// What keeps codes of so many exposures from being optimized for a camera, a valid one: too few
/// measurements, light that cannot change, neither band limit nor a shortest pulse, or one so long
/// that the period holds too few.
std::optional<BrokenRule> why_not_optimizable(const Camera& camera, int exposures);

/// With operating.multipath, levels with second returns stand beside those without, taken for one
/// return and, where the camera gives enough measurements, for two.
/// @param two_return_weight  OptimizeOptions::two_return_weight
/// @throws std::invalid_argument as why_not_optimizable(), or if variants differ in what may be
///         played
DesignProblem make_design_problem(std::span<const Camera> variants, int exposures, int samples,
                                  double two_return_weight = 0.0);

}  // namespace tofsmith

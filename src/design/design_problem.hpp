// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "design/sampled_camera.hpp"
#include "design/trial_batch.hpp"
#include "design/waveform_parameters.hpp"
#include "tofsmith/design/optimize.hpp"

namespace tofsmith {

/// Light that a code is judged in.
struct LightLevel {
  OperatingPoint point;
  bool has_second_return = false;  ///< in every trial
  double weight = 1.0;             ///< of its log error among those of all levels
};

/// A camera as the optimizer sees it: on a grid, at the light levels it learns from.
struct CameraVariant {
  SampledCamera camera;
  /// The same on the grid codes are judged on: that of the camera itself where nothing limits the
  /// band, since there a decoder with more bins goes wrong less often.
  SampledCamera judge;
  std::vector<LightLevel> levels;

  double total_weight() const;
};

/// What is to be optimized: waveforms of a space, for the error of the worst of one or more
/// variants of a camera; of each, the weighted geometric mean over its light levels.
struct DesignProblem {
  WaveformSpace space;
  std::vector<CameraVariant> variants;  ///< the first is the camera itself; never empty
  OperatingRange operating;             ///< kind of error and albedo
  double shortest_run_periods = 0.0;    ///< of binary waveforms
  std::optional<LaterTrials> later;     ///< second returns of the levels that have them
  bool binary_modulation = true, binary_demodulation = true;

  /// Second returns of a level's trials; null: none.
  const LaterTrials* later_of(const LightLevel& level) const {
    return level.has_second_return ? &*later : nullptr;
  }
  int measurements() const { return variants.front().camera.measurements(); }
  bool linear() const { return operating.error == DepthErrorKind::linear; }
};

/// The grid for a camera: as many cells as asked, or as many of the shortest pulse as fit in a
/// period, such that a pulse at the peak fills whole cells where that costs little.
WaveformSpace waveform_space(const Camera& camera, int exposures, int samples);

/// The points of the camera's operating range; where they are more than 40, 6 signal by 6 ambient
/// levels in between, spread evenly over the logarithm of signal, and of ambient over the floor
/// that read noise sets.
std::vector<OperatingPoint> training_points(const Camera& camera);

/// With operating.multipath, levels with second returns stand beside those without.
/// @throws std::invalid_argument if the camera gives fewer than 3 measurements, has no band limit
///         and no shortest pulse, or variants differ in what may be played
DesignProblem make_design_problem(std::span<const Camera> variants, int exposures, int samples);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "camera/shared/depth_prior.hpp"
#include "core/shared/random.hpp"
#include "design/optimize/soft_two_return_decoder.hpp"
#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

/// One true depth and its weight.
struct DepthTrial {
  double depth_periods = 0.0;        ///< in [0, 1)
  double weight = 1.0;               ///< prior density / sampling density
  double albedo = 1.0;               ///< scales the signal
  double multipath_ratio = 0.0;      ///< signal of the second return / signal of the direct one
  double later_delay_periods = 0.0;  ///< relative to the direct return, in [0, 1)
};

/// Stored standard normal numbers, so that drawing a window is cheap. Windows overlap, so use this
/// for gradients, which average many of them, but not for evaluating codes.
class NoiseStore {
 public:
  explicit NoiseStore(RandomStream& random);
  /// Returns `count` consecutive numbers from a random position.
  std::vector<double> window(std::size_t count, RandomStream& random) const;

 private:
  std::vector<double> normals_;
};

/// Grid for trials decoded as two returns; its bins divide those of the waveforms.
struct TwoReturnGrid {
  int bins = 0;
  DelayBins delays;  ///< range of delays in the decoder
};

/// Depths and noise for evaluating codes, drawn in advance, so that codes and gradients can be
/// compared on the same trials.
struct TrialBatch {
  int measurements = 0;
  std::vector<DepthTrial> trials;
  std::vector<double> normals;               ///< standard normal, (trials, measurements)
  std::optional<TwoReturnGrid> two_returns;  ///< grid; none: decode as one return

  const double* normals_of(std::size_t trial) const {
    return normals.data() + trial * static_cast<std::size_t>(measurements);
  }
};

/// Distribution of the second returns of trials.
struct MultipathTrials {
  OperatingMultipath returns;
  double range_m = 1.0;
  std::optional<TwoReturnGrid> decoded_as_two;  ///< if set, depths and delays lie on this grid
};

/// Draws trials with depths from the prior, stratified over the range. With ends_matter, half of
/// them are near the ends of the range, with a density proportional to 1 / distance, because a wrap
/// costs the whole range there. Trials decoded as two returns ignore ends_matter.
/// @param store  source of noise; null: new random numbers
/// @param later  distribution of second returns; null: none
/// @param depths  prior of the depths
TrialBatch draw_trials(int count, int measurements, const OperatingRange& range, bool ends_matter,
                       RandomStream& random, const NoiseStore* store = nullptr,
                       const MultipathTrials* later = nullptr, const DepthPrior& depths = {});

}  // namespace tofsmith

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

struct DepthTrial {
  double depth_periods = 0.0;        ///< in [0, 1)
  double weight = 1.0;               ///< prior / sampling density
  double albedo = 1.0;               ///< scales the signal
  double multipath_ratio = 0.0;      ///< second / direct signal
  double later_delay_periods = 0.0;  ///< after the direct return, in [0, 1)
};

/// Drawing windows is cheap, but windows overlap: for averaged gradients only.
class NoiseStore {
 public:
  explicit NoiseStore(RandomStream random);
  std::vector<double> window(std::size_t count, RandomStream& random) const;

 private:
  std::vector<double> normals_;
};

/// Grid of two-return decoding; its bins divide the samples of the waveforms.
struct TwoReturnGrid {
  int bins = 0;
  DelayBins delays;
};

/// Depths and noise, drawn in advance so that codes and gradients share the same trials.
struct TrialBatch {
  int measurements = 0;
  std::vector<DepthTrial> trials;
  std::vector<double> normals;               ///< standard normal, (trials, measurements)
  std::optional<TwoReturnGrid> two_returns;  ///< none: decode as one return

  const double* normals_of(std::size_t trial) const {
    return normals.data() + trial * static_cast<std::size_t>(measurements);
  }
};

struct MultipathTrials {
  OperatingMultipath returns;
  double range_m = 1.0;
  std::optional<TwoReturnGrid> decoded_as_two;  ///< grid of depths and delays, if any
};

/// Draws depths from the prior, stratified. With ends_matter, half of them are near the ends of the
/// range, with density 1 / distance, because a wrap costs the whole range there; not for two-return
/// decoding.
/// @param store  source of noise; null: new numbers
/// @param later  second returns; null: none
TrialBatch draw_trials(int count, int measurements, const OperatingRange& range, bool ends_matter,
                       RandomStream& random, const NoiseStore* store = nullptr,
                       const MultipathTrials* later = nullptr, const DepthPrior& depths = {});

}  // namespace tofsmith

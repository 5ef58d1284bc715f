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

/// One true depth and how much it counts.
struct DepthTrial {
  double depth_periods = 0.0;        ///< in [0, 1)
  double weight = 1.0;               ///< density of depths over the density it was drawn from
  double albedo = 1.0;               ///< scales the signal
  double multipath_ratio = 0.0;      ///< of a second return over the direct one
  double later_delay_periods = 0.0;  ///< behind the direct return, in [0, 1)
};

/// Standard normal numbers in store: a window of them costs nothing. Windows overlap, so this is
/// for gradients, of which very many are averaged, not for verdicts.
class NoiseStore {
 public:
  explicit NoiseStore(RandomStream& random);
  /// `count` numbers in a row, from a random place.
  std::vector<double> window(std::size_t count, RandomStream& random) const;

 private:
  std::vector<double> normals_;
};

/// The grid on which trials are decoded as two returns; its bins divide those of the waveforms.
struct TwoReturnGrid {
  int bins = 0;
  DelayBins delays;  ///< that the decoder looks for
};

/// Depths and noise to judge a code by; drawn before the code is known, so that codes can be
/// compared, and gradients taken, on the same ones.
struct TrialBatch {
  int measurements = 0;
  std::vector<DepthTrial> trials;
  std::vector<double> normals;               ///< standard normal, (trials, measurements)
  std::optional<TwoReturnGrid> two_returns;  ///< decode them as two returns; none: as one

  const double* normals_of(std::size_t trial) const {
    return normals.data() + trial * static_cast<std::size_t>(measurements);
  }
};

/// Second returns of trials, with delays in periods.
struct MultipathTrials {
  OperatingMultipath returns;
  double range_m = 1.0;
  std::optional<TwoReturnGrid> decoded_as_two;  ///< depths and delays lie on this grid then
};

/// Draws trials: depths stratified over the range, as often as they occur. With ends_matter, half
/// of them lie near the ends of the range, where a wrap costs the whole of it, with a density that
/// falls as 1 / distance; not so where they are decoded as two returns.
/// @param store  where noise comes from; null: fresh
/// @param later  every trial has such a second return; null: none
/// @param depths  how often they occur
TrialBatch draw_trials(int count, int measurements, const OperatingRange& range, bool ends_matter,
                       RandomStream& random, const NoiseStore* store = nullptr,
                       const MultipathTrials* later = nullptr, const DepthPrior& depths = {});

}  // namespace tofsmith

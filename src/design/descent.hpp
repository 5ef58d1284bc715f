// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "design/design_problem.hpp"
#include "tofsmith/core/shared_progress.hpp"

namespace tofsmith {

/// How waveforms go downhill. They begin soft and a decoder that doubts; both sharpen on the way.
struct DescentSchedule {
  int steps = 300;
  int trials_per_step = 360;  ///< over all light levels
  double rate = 0.08;         ///< of the parameters, where waveforms are soft
  Sharpness final_sharpness{6.0, 8.0};
  double soft_share = 0.4;                    ///< of the steps, before waveforms begin to sharpen
  double doubt_begin = 1.0, doubt_end = 3.0;  ///< sharpness of decisions per log likelihood
};

/// Parameters of lower error. Draws from the streams (seed, work item, step).
/// @param progress  told of every step
WaveformParameters descend(const DesignProblem& problem, WaveformParameters parameters,
                           const DescentSchedule& schedule, std::uint64_t seed,
                           std::uint64_t work_item, SharedProgress* progress = nullptr);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "design/optimize/depth_error_loss.hpp"
#include "design/optimize/design_problem.hpp"
#include "design/optimize/trial_batch.hpp"

namespace tofsmith {

/// How good a code is on the grid.
struct CodeScore {
  double log_error_bin = 0.0;  ///< mean over light levels of log depth error; of the worst variant
  int rotation_bin = 0;        ///< at which it is judged; 0 where the error does not depend on it
};

/// Judges codes by the error of the hard decoder, all of them on the same trials. For the linear
/// error, and where depths are not all alike, one set of trials finds the best common rotation and
/// another, for the linear error denser at the ends of the range, judges the code there.
class CodeJudge {
 public:
  /// @param trials  per light level
  CodeJudge(const DesignProblem& problem, int trials, std::uint64_t seed, std::uint64_t work_item);

  CodeScore score(const SampledCode& code) const;

 private:
  double log_error(const SampledCode& code) const;
  int best_rotation(const SampledCode& code) const;

  const DesignProblem* problem_;
  std::vector<TrialBatch> judging_;   // one per light level, shared by variants
  std::vector<TrialBatch> rotating_;  // of depths that are all alike, to find the rotation
};

/// The parameters with the origin of depth moved to `rotation_bin`, to the nearest cell.
WaveformParameters rotated(const WaveformSpace& space, const WaveformParameters& parameters,
                           int rotation_bin);

}  // namespace tofsmith

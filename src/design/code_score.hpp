// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "design/design_problem.hpp"
#include "design/trial_batch.hpp"

namespace tofsmith {

/// How good a code is on the grid.
struct CodeScore {
  double log_error_bin = 0.0;  ///< mean over light levels of log depth error; of the worst variant
  int rotation_bin = 0;        ///< of the least linear error, 0 for the circular one
};

/// Judges codes by the error of a decoder that does not doubt, all of them on the same trials. The
/// linear error is that at the best common rotation of the code.
class CodeJudge {
 public:
  /// @param trials  per light level
  CodeJudge(const DesignProblem& problem, int trials, std::uint64_t seed, std::uint64_t work_item);

  CodeScore score(const SampledCode& code) const;

 private:
  const DesignProblem* problem_;
  std::vector<TrialBatch> batches_;  // one per light level, shared by variants
};

/// The parameters with the origin of depth moved to `rotation_bin`, to the nearest cell.
WaveformParameters rotated(const WaveformSpace& space, const WaveformParameters& parameters,
                           int rotation_bin);

}  // namespace tofsmith

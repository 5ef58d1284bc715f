// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "design/optimize/depth_error_loss.hpp"
#include "design/optimize/design_problem.hpp"
#include "design/optimize/trial_batch.hpp"

namespace tofsmith {

/// Quality of a code on the grid.
struct CodeScore {
  double log_error_bin = 0.0;  ///< mean log depth error over light levels, for the worst variant
  int rotation_bin = 0;        ///< rotation for this error; 0 if the error does not depend on it
};

/// Evaluates codes by the error of the hard decoder, all on the same trials. For the linear error,
/// or weighted depths, one set of trials determines the best common rotation and another one the
/// error there. For the linear error the latter is denser at the ends of the range.
class CodeJudge {
 public:
  /// @param trials  number per light level
  CodeJudge(const DesignProblem& problem, int trials, std::uint64_t seed, std::uint64_t work_item);

  CodeScore score(const SampledCode& code) const;

 private:
  double log_error(const SampledCode& code) const;
  int best_rotation(const SampledCode& code) const;

  const DesignProblem* problem_;
  std::vector<TrialBatch> judging_;   // one per light level, shared by the variants
  std::vector<TrialBatch> rotating_;  // uniform depths, to determine the rotation
};

/// Moves the origin of depth to `rotation_bin`, rounded to a cell.
WaveformParameters rotated(const WaveformSpace& space, const WaveformParameters& parameters,
                           int rotation_bin);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "design/optimize/depth_error_loss.hpp"
#include "design/optimize/design_problem.hpp"
#include "design/optimize/trial_batch.hpp"

namespace tofsmith {

struct CodeScore {
  double log_error_bin = 0.0;  ///< mean over light levels, for the worst variant
  int rotation_bin = 0;        ///< rotation of this error; 0 if irrelevant
};

/// Evaluates codes by the error of the hard decoder, on common trials. For the linear error or
/// weighted depths, one set of trials determines the best rotation and another one the error there.
class CodeJudge {
 public:
  /// @param trials  per light level
  CodeJudge(const DesignProblem& problem, int trials, std::uint64_t seed, std::uint64_t work_item);

  CodeScore score(const SampledCode& code) const;

 private:
  double log_error(const SampledCode& code) const;
  int best_rotation(const SampledCode& code) const;

  const DesignProblem* problem_;
  std::vector<TrialBatch> judging_;
  std::vector<TrialBatch> rotating_;  // uniform depths, for the rotation
};

WaveformParameters rotated(const WaveformSpace& space, const WaveformParameters& parameters,
                           int rotation_bin);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/judge.hpp"

#include <algorithm>

namespace tofsmith {

std::uint64_t search_seed(const DesignOptions& options) { return options.seed + 1; }

bool rotates(const Camera& camera, const DesignOptions& options) {
  return options.best_rotation && camera.operating.error == DepthErrorKind::linear;
}

void judge(Candidate& candidate, const Camera& camera, const DesignOptions& options,
           const Progress& progress) {
  EvaluateOptions judging;
  judging.trials = options.trials;
  judging.seed = options.seed;
  const auto& later = camera.operating.multipath;
  const ProgressParts parts(progress, {50, later ? 10.0 : 50.0, later ? 40.0 : 0.0});
  if (rotates(camera, options)) {
    EvaluateOptions search = judging;
    search.seed = search_seed(options);
    candidate.rotation_bin = best_rotation(candidate.code, camera, search, parts[0]).rotation_bin;
    candidate.code = candidate.code.rotated(candidate.rotation_bin);
  }
  candidate.error = evaluate(candidate.code, camera, judging, parts[1]);
  if (later)
    candidate.second_returns =
        second_return_report(candidate.code, camera, *later, judging, parts[2]);
  candidate.code.provenance.depth_error_m = chosen_error_m(candidate.error, camera.operating.error);
}

void judge_robustness(Candidate& candidate, const Camera& camera, const DesignOptions& options,
                      const Progress& progress) {
  constexpr int most_trials = 4000;  // ratios, with the same trials on every camera
  candidate.robustness =
      robustness(candidate.code, camera,
                 {.trials = std::min(options.trials, most_trials), .seed = options.seed}, progress);
}

}  // namespace tofsmith

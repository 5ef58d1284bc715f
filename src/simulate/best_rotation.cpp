// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "simulate/depth_trials.hpp"
#include "simulate/error_by_rotation.hpp"

namespace tofsmith {

BestRotation best_rotation(const CodeSet& code, const Camera& camera,
                           const EvaluateOptions& options, const Progress& progress) {
  const ForwardModel model(code, camera);
  const DepthTrials trials(model, camera, options);
  const int samples = trials.samples();
  std::vector<double> log_sum(static_cast<std::size_t>(samples), 0.0);

  const auto points = static_cast<double>(trials.points().size());
  for (std::size_t p = 0; p < trials.points().size(); ++p) {
    std::vector<ErrorByRotation> of_block(static_cast<std::size_t>(trials.blocks()),
                                          ErrorByRotation(samples));
    trials.run(
        p,
        [&](const TrialBlock& block) {
          ErrorByRotation& errors = of_block[static_cast<std::size_t>(block.block)];
          for (std::size_t t = 0; t < block.true_bin.size(); ++t)
            errors.add(block.true_bin[t], block.decoded_bin[t]);
        },
        part_of(progress, static_cast<double>(p) / points, static_cast<double>(p + 1) / points));
    ErrorByRotation total(samples);
    for (const ErrorByRotation& errors : of_block) total.merge(errors);
    const std::vector<double> sums = total.sums();
    for (std::size_t r = 0; r < sums.size(); ++r)
      log_sum[r] += std::log(sums[r] * camera.bin_m() / static_cast<double>(trials.trials()));
  }

  BestRotation best;
  for (const double sum : log_sum) best.linear_geometric_mean_m.push_back(std::exp(sum / points));
  best.rotation_bin =
      static_cast<int>(std::min_element(log_sum.begin(), log_sum.end()) - log_sum.begin());
  return best;
}

}  // namespace tofsmith

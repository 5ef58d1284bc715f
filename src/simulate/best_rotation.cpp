// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "camera/shared/actual_code.hpp"
#include "simulate/depth_trials.hpp"
#include "simulate/shared/error_by_rotation.hpp"

namespace tofsmith {

BestRotation best_rotation(const CodeSet& code, const Camera& on, const EvaluateOptions& options,
                           const Progress& progress) {
  const Camera camera = judged_camera(on);
  constexpr std::int64_t runs_at_once = 64;  // each keeps N figures
  const ForwardModel model(code, camera);
  const DepthTrials trials(model, camera, options);
  const std::vector<TrialRound> rounds = trials.first_rounds();
  const std::vector<ErrorByRotation> of_point = trials.sum(
      rounds, ErrorByRotation(trials.samples()),
      [](ErrorByRotation& errors, const TrialBlock& block) {
        for (std::size_t t = 0; t < block.true_bin.size(); ++t)
          errors.add(block.true_bin[t], block.decoded_bin[t]);
      },
      progress, runs_at_once);

  std::vector<double> log_sum(static_cast<std::size_t>(trials.samples()), 0.0);
  for (std::size_t p = 0; p < of_point.size(); ++p) {
    const std::vector<double> sums = of_point[p].sums();
    for (std::size_t r = 0; r < sums.size(); ++r)
      log_sum[r] += std::log(sums[r] * camera.bin_m() / static_cast<double>(rounds[p].trials));
  }
  BestRotation best;
  for (const double sum : log_sum)
    best.linear_geometric_mean_m.push_back(std::exp(sum / static_cast<double>(of_point.size())));
  for (int r = 0; r < std::ssize(log_sum); ++r)
    if (!plays_alike_rotated(camera, trials.samples(), r))
      log_sum[static_cast<std::size_t>(r)] = std::numeric_limits<double>::infinity();
  best.rotation_bin = best_of_rotations(log_sum);
  return best;
}

}  // namespace tofsmith

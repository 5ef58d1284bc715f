// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <span>

#include "camera/shared/actual_code.hpp"
#include "simulate/depth_trials.hpp"
#include "simulate/shared/error_by_rotation.hpp"

namespace tofsmith {
namespace {

template <typename Errors>
std::vector<std::vector<double>> sums_by_rotation(const DepthTrials& trials,
                                                  std::span<const TrialRound> rounds,
                                                  const Errors& none, const Progress& progress) {
  constexpr std::int64_t runs_at_once = 64;
  const std::vector<Errors> of_round = trials.sum(
      rounds, none,
      [](Errors& errors, const TrialBlock& block) {
        for (std::size_t t = 0; t < block.true_bin.size(); ++t)
          errors.add(block.true_bin[t], block.decoded_bin[t]);
      },
      progress, runs_at_once);
  std::vector<std::vector<double>> sums;
  for (const Errors& errors : of_round) sums.push_back(errors.sums());
  return sums;
}

}  // namespace

BestRotation best_rotation(const CodeSet& code, const Camera& on, const EvaluateOptions& options,
                           const Progress& progress) {
  Camera camera = judged_camera(on);
  const DepthPrior prior(camera);
  camera.operating.depths.reset();  // uniform depths serve all rotations
  camera.operating.working_distance_m.reset();
  const ForwardModel model(code, camera);
  const DepthTrials trials(model, camera, options);
  const std::vector<TrialRound> rounds = trials.first_rounds();
  const int samples = trials.samples();
  const std::vector<std::vector<double>> of_point =
      prior.is_uniform()
          ? sums_by_rotation(trials, rounds, ErrorByRotation(samples), progress)
          : sums_by_rotation(trials, rounds,
                             WeighedErrorByRotation(prior, camera.operating.error, samples),
                             progress);

  std::vector<double> log_sum(static_cast<std::size_t>(samples), 0.0);
  for (std::size_t p = 0; p < of_point.size(); ++p) {
    const std::vector<double>& sums = of_point[p];
    for (std::size_t r = 0; r < sums.size(); ++r)
      log_sum[r] += std::log(sums[r] * camera.bin_m() / static_cast<double>(rounds[p].trials));
  }
  BestRotation best;
  for (const double sum : log_sum)
    best.linear_geometric_mean_m.push_back(std::exp(sum / static_cast<double>(of_point.size())));
  for (int r = 0; r < std::ssize(log_sum); ++r)
    if (!plays_alike_rotated(camera, trials.samples(), r))
      log_sum[static_cast<std::size_t>(r)] = std::numeric_limits<double>::infinity();
  // After a rotation, rounding errors may remove a narrow pulse on the points of the generator.
  for (;;) {
    best.rotation_bin = best_of_rotations(log_sum);
    if (best.rotation_bin == 0 || !why_not_playable(code.rotated(best.rotation_bin), camera))
      return best;
    log_sum[static_cast<std::size_t>(best.rotation_bin)] = std::numeric_limits<double>::infinity();
  }
}

}  // namespace tofsmith

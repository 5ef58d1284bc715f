// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "simulate/depth_trials.hpp"

namespace tofsmith {

namespace {

/// Sum of linear errors [bin] at every rotation, as a step function of the rotation kept by its
/// jumps: jumps[r] is what rotation r adds over rotation r - 1; jumps[0] is the sum at rotation 0.
class ErrorByRotation {
 public:
  explicit ErrorByRotation(int samples) : jumps_(static_cast<std::size_t>(samples) + 1, 0.0) {}

  void add(double true_bin, double decoded_bin) {
    const auto samples = static_cast<double>(jumps_.size() - 1);
    const auto [low, high] = std::minmax(true_bin, decoded_bin);
    const double error = high - low;
    jumps_[0] += error;
    // The origin, put at bin r, parts the two if low < r <= high.
    const double longer = samples - 2.0 * error;
    jumps_[static_cast<std::size_t>(std::floor(low)) + 1] += longer;
    if (high < samples - 1.0) jumps_[static_cast<std::size_t>(std::floor(high)) + 1] -= longer;
  }
  void merge(const ErrorByRotation& other) {
    for (std::size_t r = 0; r < jumps_.size(); ++r) jumps_[r] += other.jumps_[r];
  }
  /// Sums at rotations 0 .. N - 1.
  std::vector<double> sums() const {
    std::vector<double> result(jumps_.begin(), jumps_.end() - 1);
    for (std::size_t r = 1; r < result.size(); ++r) result[r] += result[r - 1];
    return result;
  }

 private:
  std::vector<double> jumps_;
};

}  // namespace

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

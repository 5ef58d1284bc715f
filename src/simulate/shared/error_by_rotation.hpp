// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace tofsmith {

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

/// The best origin of depth: of all rotations by their errors, or monotone functions of them, the
/// first of the least. Wherever a code is given an origin, this is how it is chosen.
inline int best_of_rotations(const std::vector<double>& errors) {
  return static_cast<int>(std::min_element(errors.begin(), errors.end()) - errors.begin());
}

/// The errors of all rotations, smoothed over their neighbours round the circle: errors of all
/// rotations share trials, and where these are few the least of noisy values is an accident.
inline std::vector<double> smoothed_over_rotations(const std::vector<double>& errors) {
  constexpr std::array<double, 5> weights = {1.0, 2.0, 3.0, 2.0, 1.0};
  const std::size_t count = errors.size();
  std::vector<double> sums(count, 0.0);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < weights.size(); ++k)
      sums[i] += weights[k] * errors[(i + count + k - 2) % count];
  return sums;
}

}  // namespace tofsmith

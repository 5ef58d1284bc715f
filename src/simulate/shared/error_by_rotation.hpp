// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <vector>

#include "camera/shared/depth_prior.hpp"
#include "core/shared/periodic.hpp"

namespace tofsmith {

/// Sum of linear errors [bin] at every rotation for uniform depths.
class ErrorByRotation {
 public:
  explicit ErrorByRotation(int samples)
      : jumps_(static_cast<std::size_t>(samples) + 1, 0.0),
        jumps_of_means_(jumps_),
        parts_of_means_(jumps_) {}

  int samples() const { return static_cast<int>(jumps_.size()) - 1; }

  void add(double true_bin, double decoded_bin) {
    const auto samples = static_cast<double>(jumps_.size() - 1);
    const auto [low, high] = std::minmax(true_bin, decoded_bin);
    const double error = high - low;
    sum_ += error;
    // An origin at bin r separates the two depths if low < r <= high.
    const double longer = samples - 2.0 * error;
    jumps_[static_cast<std::size_t>(low) + 1] += longer;
    if (high < samples - 1.0) jumps_[static_cast<std::size_t>(high) + 1] -= longer;
    // Origins in [r - 0.5, r + 0.5); the last half bin of the range counts as r = samples.
    const auto first = static_cast<std::size_t>(low + 0.5);
    const auto last = static_cast<std::size_t>(high + 0.5);
    if (first == last) {
      parts_of_means_[first] += longer * error;
      return;
    }
    parts_of_means_[first] += longer * (static_cast<double>(first) + 0.5 - low);
    parts_of_means_[last] += longer * (high + 0.5 - static_cast<double>(last));
    jumps_of_means_[first + 1] += longer;
    jumps_of_means_[last] -= longer;
  }
  void merge(const ErrorByRotation& other) {
    sum_ += other.sum_;
    for (std::size_t r = 0; r < jumps_.size(); ++r) {
      jumps_[r] += other.jumps_[r];
      jumps_of_means_[r] += other.jumps_of_means_[r];
      parts_of_means_[r] += other.parts_of_means_[r];
    }
  }
  std::vector<double> sums() const { return accumulated(jumps_); }
  /// Sums of errors, averaged over the origins within half a bin of each rotation. Their variance
  /// is much smaller where errors are small, because few depths are separated by one origin.
  std::vector<double> means_over_origins() const {
    std::vector<double> result = accumulated(jumps_of_means_);
    for (std::size_t r = 0; r < result.size(); ++r) result[r] += parts_of_means_[r];
    result[0] += parts_of_means_.back();
    return result;
  }

 private:
  std::vector<double> accumulated(const std::vector<double>& jumps) const {
    std::vector<double> result(jumps.begin(), jumps.end() - 1);
    result[0] += sum_;
    for (std::size_t r = 1; r < result.size(); ++r) result[r] += result[r - 1];
    return result;
  }

  double sum_ = 0.0;           // of all errors, without separation
  std::vector<double> jumps_;  // [r]: increase of sums() from rotation r - 1 to r
  std::vector<double> jumps_of_means_, parts_of_means_;
};

/// Sum of errors [bin] at every rotation for non-uniform depths, from trials with uniform depths:
/// each trial is weighted by the frequency of its depth relative to the origin. The linear error is
/// the circular error, plus the difference where the origin separates the shorter arc.
class WeighedErrorByRotation {
 public:
  WeighedErrorByRotation(const DepthPrior& prior, DepthErrorKind kind, int samples)
      : weight_(samples * prior.masses(samples)),
        is_linear_(kind == DepthErrorKind::linear),
        circular_(Eigen::VectorXd::Zero(samples)),
        parted_(Eigen::VectorXd::Zero(samples)) {}

  int samples() const { return static_cast<int>(weight_.size()); }

  void add(double true_bin, double decoded_bin) {
    const Eigen::Index samples = weight_.size();
    const auto around = static_cast<double>(samples);
    const auto [low, high] = std::minmax(true_bin, decoded_bin);
    const double error = std::min(high - low, around - (high - low));
    const auto at = static_cast<Eigen::Index>(true_bin);
    circular_[at] += error;
    if (!is_linear_) return;
    const double begin = high - low <= error ? low : high;
    const auto last = static_cast<Eigen::Index>(std::floor(begin + error));
    for (auto origin = static_cast<Eigen::Index>(begin) + 1; origin <= last; ++origin)
      parted_[origin % samples] +=
          weight_[(at + 2 * samples - origin) % samples] * (around - 2.0 * error);
  }
  void merge(const WeighedErrorByRotation& other) {
    circular_ += other.circular_;
    parted_ += other.parted_;
  }
  std::vector<double> sums() const {
    const Eigen::VectorXd all = parted_ + circular_correlation(circular_, weight_);
    std::vector<double> result(static_cast<std::size_t>(all.size()));
    std::transform(all.begin(), all.end(), result.begin(),
                   [](double sum) { return std::max(sum, 0.0); });  // removes rounding errors
    return result;
  }
  /// Without averages: true depths are in the middle of their bins.
  std::vector<double> means_over_origins() const { return sums(); }

 private:
  Eigen::VectorXd weight_;  // per bin, mean 1
  bool is_linear_;
  Eigen::VectorXd circular_;  // in each bin, without weights
  Eigen::VectorXd parted_;    // additional error at each rotation
};

/// Returns the first rotation with the smallest error, or with the smallest monotone function of
/// it.
inline int best_of_rotations(const std::vector<double>& errors) {
  return static_cast<int>(std::min_element(errors.begin(), errors.end()) - errors.begin());
}

/// Returns means within 1/120 of the range, because with few trials the minimum is due to noise.
inline std::vector<double> smoothed_over_rotations(const std::vector<double>& errors) {
  const auto count = static_cast<std::ptrdiff_t>(errors.size()), reach = (count + 60) / 120;
  const auto total = static_cast<double>((reach + 1) * (reach + 1));
  std::vector<double> means(errors.size(), 0.0);
  for (std::ptrdiff_t i = 0; i < count; ++i)
    for (std::ptrdiff_t k = -reach; k <= reach; ++k)
      means[static_cast<std::size_t>(i)] +=
          static_cast<double>(reach + 1 - std::abs(k)) *
          errors[static_cast<std::size_t>((i + count + k) % count)];
  for (double& mean : means) mean /= total;
  return means;
}

}  // namespace tofsmith

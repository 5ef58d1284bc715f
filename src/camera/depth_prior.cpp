// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "camera/shared/depth_prior.hpp"

#include <algorithm>
#include <cmath>

namespace tofsmith {
namespace {

/// Begin (end = 0) or end (end = 1) of depths, as a fraction of the range.
double share_of(const Camera& camera, std::size_t end) {
  const auto& distance_m = camera.operating.working_distance_m;
  return distance_m ? (*distance_m)[end] / camera.range_m() : static_cast<double>(end);
}

}  // namespace

DepthPrior::DepthPrior(const std::vector<double>& weights, double begin, double end)
    : begin_(begin), end_(end) {
  const bool alike = are_alike(weights);
  if (alike && begin == 0.0 && end == 1.0) return;
  mass_ = alike ? std::vector<double>{1.0} : weights;
  const double largest = *std::max_element(mass_.begin(), mass_.end());
  double sum = 0.0;
  for (double& mass : mass_) sum += mass /= largest;  // sums of very large numbers overflow
  double below = 0.0;
  for (double& mass : mass_) {
    mass /= sum;
    below_.push_back(std::min(1.0, below));
    below += mass;
  }
  below_.push_back(1.0);
}

DepthPrior::DepthPrior(const Camera& camera)
    : DepthPrior(camera.operating.depths.value_or(std::vector<double>()), share_of(camera, 0),
                 share_of(camera, 1)) {}

bool DepthPrior::are_alike(const std::vector<double>& weights) {
  return std::all_of(weights.begin(), weights.end(),
                     [&](double weight) { return weight == weights.front(); });
}

std::size_t DepthPrior::cell_of(double share) const {
  const auto parts = static_cast<double>(mass_.size());
  const double cell = std::floor((share - begin_) / (end_ - begin_) * parts);
  return static_cast<std::size_t>(std::clamp(cell, 0.0, parts - 1.0));
}

double DepthPrior::begin_of(std::size_t cell) const {
  return begin_ + (end_ - begin_) * (static_cast<double>(cell) / static_cast<double>(mass_.size()));
}

double DepthPrior::density(double share) const {
  if (is_uniform()) return 1.0;
  if (share < begin_ || share > end_) return 0.0;
  return mass_[cell_of(share)] * static_cast<double>(mass_.size()) / (end_ - begin_);
}

double DepthPrior::max_density() const {
  return is_uniform() ? 1.0
                      : *std::max_element(mass_.begin(), mass_.end()) *
                            static_cast<double>(mass_.size()) / (end_ - begin_);
}

double DepthPrior::below(double share) const {
  if (is_uniform()) return share;
  if (share <= begin_) return 0.0;
  if (share >= end_) return 1.0;
  const std::size_t cell = cell_of(share);
  return std::clamp(below_[cell] + density(share) * (share - begin_of(cell)), 0.0, 1.0);
}

double DepthPrior::quantile(double part) const {
  if (is_uniform()) return part;
  const auto next = std::upper_bound(below_.begin(), below_.end() - 1, part);
  auto cell = static_cast<std::size_t>(next - below_.begin()) - 1;
  while (mass_[cell] == 0.0) --cell;  // empty parts, reached only by rounding
  const double within = std::clamp((part - below_[cell]) / mass_[cell], 0.0, 1.0);
  const double begin = begin_of(cell);
  return std::min(begin + within * (begin_of(cell + 1) - begin), std::nextafter(1.0, 0.0));
}

Eigen::VectorXd DepthPrior::masses(Eigen::Index parts) const {
  if (is_uniform()) return {};
  constexpr double rounding = 1e-12;  // at borders of parts
  const auto count = static_cast<double>(parts);
  Eigen::VectorXd masses(parts);
  for (Eigen::Index i = 0; i < parts; ++i) {
    const double mass =
        below(static_cast<double>(i + 1) / count) - below(static_cast<double>(i) / count);
    masses[i] = mass > rounding ? mass : 0.0;
  }
  return masses;
}

double mean_over_depths(const Eigen::VectorXd& values, const Eigen::VectorXd& masses) {
  if (masses.size() == 0) return values.mean();
  double sum = 0.0;
  for (Eigen::Index i = 0; i < values.size(); ++i)
    if (masses[i] > 0.0) sum += masses[i] * values[i];
  return sum;
}

}  // namespace tofsmith

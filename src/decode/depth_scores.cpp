// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/depth_scores.hpp"

#include <algorithm>
#include <array>

namespace tofsmith {

namespace {
constexpr int bins_per_block = 64;
/// Signal and ambient light that differ in direction by less (square of the sine) are one.
constexpr double parallel_light = 1e-13;
}  // namespace

DepthScores::DepthScores(const AmbientProjection& projection)
    : directions_(projection.curve.rowwise().normalized().transpose()),
      gated_(projection.gated.transpose()),
      ambient_(projection.ambient) {}

std::int32_t DepthScores::best_correlation(const double* plane) const {
  double best = -1.0;
  std::int32_t best_bin = -1;
  std::array<double, bins_per_block> score;
  for (int first = 0; first < samples(); first += bins_per_block) {
    const int count = std::min(bins_per_block, samples() - first);
    score.fill(0.0);
    for (Eigen::Index j = 0; j < directions_.rows(); ++j) {
      const double* direction = directions_.row(j).data() + first;
      for (int i = 0; i < count; ++i) score[static_cast<std::size_t>(i)] += plane[j] * direction[i];
    }
    for (int i = 0; i < count; ++i)
      if (best_bin < 0 || score[static_cast<std::size_t>(i)] > best) {
        best = score[static_cast<std::size_t>(i)];
        best_bin = first + i;
      }
  }
  return best_bin;
}

void DepthScores::weighted_fall(const double* electrons, const double* weight, double* fall) const {
  std::array<double, bins_per_block> xx, xa, xy;
  double aa = 0.0, ay = 0.0;
  for (Eigen::Index k = 0; k < ambient_.size(); ++k) {
    aa += weight[k] * ambient_[k] * ambient_[k];
    ay += weight[k] * ambient_[k] * electrons[k];
  }
  const double ambient_alone = ay > 0.0 ? ay * ay / aa : 0.0;
  for (int first = 0; first < samples(); first += bins_per_block) {
    const int count = std::min(bins_per_block, samples() - first);
    xx.fill(0.0), xa.fill(0.0), xy.fill(0.0);
    for (Eigen::Index k = 0; k < ambient_.size(); ++k) {
      const double* x = gated_.row(k).data() + first;
      const double by_a = weight[k] * ambient_[k], by_y = weight[k] * electrons[k];
      for (int i = 0; i < count; ++i) {
        const auto at = static_cast<std::size_t>(i);
        xx[at] += weight[k] * x[i] * x[i];
        xa[at] += by_a * x[i];
        xy[at] += by_y * x[i];
      }
    }
    for (int i = 0; i < count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const double signal = xy[at] * aa - ay * xa[at], ambient = ay * xx[at] - xy[at] * xa[at];
      const double determinant = xx[at] * aa - xa[at] * xa[at];
      const double signal_alone = xy[at] > 0.0 ? xy[at] * xy[at] / xx[at] : 0.0;
      const bool both = signal > 0.0 && ambient > 0.0 && determinant > parallel_light * xx[at] * aa;
      fall[first + i] = both ? (signal * xy[at] + ambient * ay) / determinant
                             : std::max(signal_alone, ambient_alone);
    }
  }
}

}  // namespace tofsmith

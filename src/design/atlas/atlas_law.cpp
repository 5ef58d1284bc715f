// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

double AtlasLaw::error_m(const AtlasCamera& camera) const {
  return at_ones_m * std::pow(camera.bandwidth_f0, -bandwidth_power) *
         std::pow(camera.peak_factor, -peak_power);
}

std::vector<AtlasEntry> best_by_exposures(const std::vector<AtlasEntry>& entries) {
  std::vector<AtlasEntry> best;
  for (const AtlasEntry& entry : entries) {
    const auto same = std::find_if(best.begin(), best.end(), [&](const AtlasEntry& other) {
      AtlasCamera its = other.of;
      its.exposures = entry.of.exposures;
      return its == entry.of;
    });
    if (same == best.end())
      best.push_back(entry);
    else if (entry.error_m().value < same->error_m().value)
      *same = entry;
  }
  return best;
}

std::optional<AtlasLaw> fit_atlas_law(const std::vector<AtlasEntry>& entries) {
  constexpr Eigen::Index unknowns = 3, min_entries = 2 * unknowns;
  std::vector<const AtlasEntry*> fitted;
  for (const AtlasEntry& entry : entries)
    if (entry.of.bandwidth_f0 > 0.0) fitted.push_back(&entry);
  if (std::ssize(fitted) < min_entries) return std::nullopt;
  Eigen::MatrixXd powers(std::ssize(fitted), unknowns);
  Eigen::VectorXd logs(std::ssize(fitted));
  for (Eigen::Index i = 0; i < logs.size(); ++i) {
    const AtlasEntry& entry = *fitted[static_cast<std::size_t>(i)];
    powers.row(i) << 1.0, -std::log(entry.of.bandwidth_f0), -std::log(entry.of.peak_factor);
    logs[i] = std::log(entry.error_m().value);
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> least_squares(powers);
  if (least_squares.rank() < unknowns) return std::nullopt;
  const Eigen::VectorXd law = least_squares.solve(logs);
  const Eigen::ArrayXd residuals = (powers * law - logs).array();
  return AtlasLaw{.at_ones_m = std::exp(law[0]),
                  .bandwidth_power = law[1],
                  .peak_power = law[2],
                  .rms_residual = std::sqrt(residuals.square().mean()),
                  .max_residual = residuals.abs().maxCoeff(),
                  .entries = static_cast<int>(fitted.size())};
}

}  // namespace tofsmith

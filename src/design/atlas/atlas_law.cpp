// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/QR>
#include <cmath>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

double AtlasLaw::error_m(const AtlasCamera& camera) const {
  return at_ones_m * std::pow(camera.bandwidth_f0, -bandwidth_power) *
         std::pow(camera.peak_factor, -peak_power) * std::pow(camera.exposures, -exposures_power);
}

std::optional<AtlasLaw> fit_atlas_law(const std::vector<AtlasEntry>& entries, int taps,
                                      DepthErrorKind error) {
  constexpr Eigen::Index unknowns = 4, min_entries = 2 * unknowns;
  std::vector<const AtlasEntry*> fitted;
  for (const AtlasEntry& entry : entries)
    if (entry.of.taps == taps && entry.of.error == error && entry.of.bandwidth_f0 > 0.0)
      fitted.push_back(&entry);
  if (std::ssize(fitted) < min_entries) return std::nullopt;
  Eigen::MatrixXd powers(std::ssize(fitted), unknowns);
  Eigen::VectorXd logs(std::ssize(fitted));
  for (Eigen::Index i = 0; i < logs.size(); ++i) {
    const AtlasEntry& entry = *fitted[static_cast<std::size_t>(i)];
    powers.row(i) << 1.0, -std::log(entry.of.bandwidth_f0), -std::log(entry.of.peak_factor),
        -std::log(entry.of.exposures);
    logs[i] = std::log(entry.error_m().value);
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> least_squares(powers);
  if (least_squares.rank() < unknowns) return std::nullopt;
  const Eigen::VectorXd law = least_squares.solve(logs);
  const Eigen::ArrayXd residuals = (powers * law - logs).array();
  return AtlasLaw{.taps = taps,
                  .error = error,
                  .at_ones_m = std::exp(law[0]),
                  .bandwidth_power = law[1],
                  .peak_power = law[2],
                  .exposures_power = law[3],
                  .rms_residual = std::sqrt(residuals.square().mean()),
                  .max_residual = residuals.abs().maxCoeff(),
                  .entries = static_cast<int>(fitted.size())};
}

}  // namespace tofsmith

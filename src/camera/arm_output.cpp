// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "camera/shared/arm_output.hpp"

#include "core/shared/periodic.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

Eigen::VectorXd arm_output(const Waveform& waveform, const ImpulseResponse& response,
                           double fundamental_frequency_hz, int points) {
  require(points >= 2, "points", points, "must be >= 2");
  if (response.kind == ImpulseResponse::Kind::none) return waveform.cell_averages(points);
  const PeriodicTransform transform(points);
  Eigen::VectorXcd spectrum = waveform.harmonics(transform.coefficients() - 1);
  for (Eigen::Index n = 0; n < spectrum.size(); ++n)
    spectrum[n] *= static_cast<double>(points) *
                   response.transfer(static_cast<double>(n) * fundamental_frequency_hz);
  Eigen::VectorXd samples;
  transform.inverse(spectrum, samples);
  return samples;
}

}  // namespace tofsmith

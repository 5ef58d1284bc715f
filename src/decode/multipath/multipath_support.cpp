// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/multipath/multipath_support.hpp"

#include <cmath>
#include <string>

#include "core/shared/periodic.hpp"
#include "decode/multipath/multipath_engine.hpp"

namespace tofsmith {

namespace {

/// Harmonics with more than 1 % of the largest amplitude.
int harmonics_of(const AmbientProjection& projection) {
  const PeriodicTransform transform(static_cast<int>(projection.curve.rows()));
  Eigen::VectorXd power = Eigen::VectorXd::Zero(transform.coefficients());
  Eigen::VectorXcd spectrum(transform.coefficients());
  for (Eigen::Index i = 0; i < projection.curve.cols(); ++i) {
    transform.forward(projection.curve.col(i), spectrum);
    power += spectrum.cwiseAbs2();
  }
  const Eigen::VectorXd harmonics = power.tail(power.size() - 1);
  return static_cast<int>((harmonics.array() > 1e-4 * harmonics.maxCoeff()).count());
}

}  // namespace

std::optional<BrokenRule> missing_support(const AmbientProjection& projection,
                                          MultipathKind later) {
  const bool sees_ambient = !projection.ambient.isZero(0.0);
  const int means = independent_directions(projection) + (sees_ambient ? 1 : 0);
  const int needed = (later == MultipathKind::tail ? 5 : 6) - (sees_ambient ? 0 : 1);
  if (means >= needed) return std::nullopt;
  const int harmonics = harmonics_of(projection);
  std::string rule = "must be >= " + std::to_string(needed) + " to distinguish ";
  rule += later == MultipathKind::tail ? "a tail" : "two returns";
  rule += " from one";
  if (harmonics <= 2)
    rule +=
        harmonics == 1
            ? "; the code has only one frequency, at which several returns are equivalent to one"
            : "; the code has only two frequencies, at which pairs of returns are ambiguous";
  rule += "; decode it with zncc or ml, or ";
  const Eigen::Index measurements = projection.gated.cols();
  if (measurements >= needed)  // too few independent means
    rule += "increase the number of harmonics: its " + std::to_string(measurements) +
            " measurements suffice, but contain too few harmonics; use a higher bandwidth of light "
            "and sensor (light.impulse_response, sensor.impulse_response) or a code with more "
            "harmonics";
  else
    rule +=
        "use a code with more means, such as hamiltonian-k5 on a sensor with two taps (--set "
        "sensor.taps=2), which has 10 measurements in 5 exposures";
  return broken("independent means", means, rule);
}

}  // namespace tofsmith

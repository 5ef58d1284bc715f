// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/multipath/multipath_support.hpp"

#include <cmath>
#include <string>

#include "core/shared/periodic.hpp"
#include "decode/multipath/multipath_engine.hpp"

namespace tofsmith {

namespace {

/// Returns the number of harmonics with more than 1 % of the largest amplitude.
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
  std::string rule = "must be >= " + std::to_string(needed) + " to tell ";
  rule += later == MultipathKind::tail ? "a tail" : "two returns";
  rule += " from one";
  if (harmonics <= 2)
    rule += harmonics == 1
                ? "; the code holds one frequency only, in which any returns add up to one"
                : "; the code holds two frequencies only, in which pairs of returns look "
                  "alike";
  rule += "; decode it with zncc or ml, or ";
  const Eigen::Index measurements = projection.gated.cols();
  if (measurements >= needed)  // enough measurements, but too few independent means
    rule += "let more harmonics through: its " + std::to_string(measurements) +
            " measurements are enough, but hold too few; a higher bandwidth of light and sensor "
            "(light.impulse_response, sensor.impulse_response) keeps more of the code's, and some "
            "codes have more";
  else
    rule +=
        "play a code with more means: hamiltonian-k5 on a sensor of two taps (--set "
        "sensor.taps=2), which gives 10 measurements in 5 exposures";
  return broken("independent means", means, rule);
}

}  // namespace tofsmith

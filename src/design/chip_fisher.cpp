// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/chip_fisher.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/design/chip_metric.hpp"

namespace tofsmith {

namespace {
// Gauss-Legendre on [0, 1].
constexpr std::array<double, nodes_per_chip> node_position = {
    0.06943184420297371, 0.33000947820757187, 0.66999052179242813, 0.93056815579702629};
constexpr std::array<double, nodes_per_chip> node_weight = {
    0.17392742256872693, 0.32607257743127307, 0.32607257743127307, 0.17392742256872693};
}  // namespace

FisherMatrix& FisherMatrix::operator+=(const FisherMatrix& other) {
  zz += other.zz;
  zs += other.zs;
  ss += other.ss;
  za += other.za;
  sa += other.sa;
  aa += other.aa;
  return *this;
}

double FisherMatrix::depth_variance() const {
  // Schur complements: ambient light is taken out first, then the signal.
  const double per_ambient = 1.0 / aa;
  const double signal = ss - sa * sa * per_ambient;
  constexpr double rounding = 1e-12;
  if (!(signal > rounding * ss)) return infinity;
  const double across = zs - za * sa * per_ambient;
  const double depth = zz - za * za * per_ambient - across * across / signal;
  return depth > rounding * zz ? 1.0 / depth : infinity;
}

void add_exposure(ChipWord modulation, const ChipWord* taps, int tap_count, const ChipLight& light,
                  FisherMatrix* nodes) {
  const double electrons = light.electrons_of(std::popcount(modulation));
  for (int i = 0; i < tap_count; ++i) {
    const double open = std::popcount(taps[i]);
    const double dark_e2 = light.ambient_e * open + light.constant_e2;
    double here = std::popcount(taps[i] & modulation);
    FisherMatrix* node = nodes;
    for (int s = 0; s < light.chips; ++s) {
      const double next = std::popcount(taps[i] & delayed_chips(modulation, s + 1, light.chips));
      const double slope = electrons * (next - here);
      for (int q = 0; q < nodes_per_chip; ++q, ++node) {
        const double signal =
            electrons * (here + (next - here) * node_position[static_cast<std::size_t>(q)]);
        const double weight = 1.0 / (signal + dark_e2);
        node->zz += weight * slope * slope;
        node->zs += weight * slope * signal;
        node->ss += weight * signal * signal;
        node->za += weight * slope * open;
        node->sa += weight * signal * open;
        node->aa += weight * open * open;
      }
      here = next;
    }
  }
}

double mean_depth_variance(const FisherMatrix* nodes, int chips, double limit) {
  const double stop = limit * chips;
  double sum = 0.0;
  for (int s = 0; s < chips; ++s) {
    for (int q = 0; q < nodes_per_chip; ++q)
      sum +=
          node_weight[static_cast<std::size_t>(q)] * nodes[s * nodes_per_chip + q].depth_variance();
    if (!(sum <= stop)) break;
  }
  return sum / chips;
}

double chip_gamma(const ChipCode& code, const ChipLight& light, double limit) {
  std::array<FisherMatrix, std::size_t{most_chips} * nodes_per_chip> nodes{};
  for (int e = 0; e < code.exposures(); ++e)
    add_exposure(code.modulation[static_cast<std::size_t>(e)], code.taps_of(e), code.taps, light,
                 nodes.data());
  return mean_depth_variance(nodes.data(), code.chips, limit);
}

FisherMatrix largest_tap_fisher(int correlation, int next, int open_chips,
                                double electrons_per_chip, const ChipLight& light) {
  const double slope = electrons_per_chip * (next - correlation);
  const double signal = electrons_per_chip * correlation, open = open_chips;
  const double weight = 1.0 / (electrons_per_chip * std::min(correlation, next) +
                               light.ambient_e * open + light.constant_e2);
  return {.zz = weight * slope * slope,
          .zs = weight * slope * signal,
          .ss = weight * signal * signal,
          .za = weight * slope * open,
          .sa = weight * signal * open,
          .aa = weight * open * open};
}

double chip_metric_rms_m(const ChipCode& code, const Camera& camera, const OperatingPoint& point) {
  code.validate();
  const ChipLight light(camera, point, code.chips, code.exposures());
  return light.chip_m * std::sqrt(chip_gamma(code, light));
}

}  // namespace tofsmith

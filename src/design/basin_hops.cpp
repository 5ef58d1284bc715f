// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/basin_hops.hpp"

#include <algorithm>

#include "design/optimize_starts.hpp"

namespace tofsmith {

namespace {

constexpr double softness = 1.2;
constexpr double noise = 0.3;

int below(int count, RandomStream& random) {
  return std::min(count - 1, static_cast<int>(random.uniform() * count));
}

/// Gates of exposure e, `cells` later.
void rotate_gates(const WaveformSpace& space, int exposure, int cells,
                  WaveformParameters& parameters) {
  auto gates = parameters.demodulation.middleCols(exposure * space.columns(), space.columns());
  const Eigen::MatrixXd before = gates;
  for (int c = 0; c < space.cells; ++c) gates.row((c + cells) % space.cells) = before.row(c);
}

}  // namespace

WaveformParameters softened(WaveformParameters parameters, double limit) {
  for (Eigen::MatrixXd* values : {&parameters.modulation, &parameters.demodulation})
    *values = values->cwiseMax(-limit).cwiseMin(limit);
  return parameters;
}

PoolEntry hop(const DesignProblem& problem, const std::vector<PoolEntry>& pool,
              RandomStream& random) {
  const WaveformSpace& space = problem.space;
  const int columns = space.columns();
  const auto entries = static_cast<int>(pool.size());
  const int base = random.uniform() < 0.6 ? 0 : below(std::min(3, entries), random);
  PoolEntry next = pool[static_cast<std::size_t>(base)];
  next.parameters = softened(std::move(next.parameters), softness);
  const int e = below(space.exposures, random);
  const double kind = random.uniform();
  if (kind < 0.3) {
    const WaveformParameters pair = softened(random_pair(problem, random), softness);
    next.parameters.modulation.col(e) = pair.modulation;
    next.parameters.demodulation.middleCols(e * columns, columns) = pair.demodulation;
  } else if (kind < 0.6) {
    const WaveformParameters donor =
        softened(pool[static_cast<std::size_t>(below(entries, random))].parameters, softness);
    const int from = below(space.exposures, random);
    next.parameters.modulation.col(e) = donor.modulation.col(from);
    next.parameters.demodulation.middleCols(e * columns, columns) =
        donor.demodulation.middleCols(from * columns, columns);
  }
  if (kind >= 0.3 && kind < 0.8)
    rotate_gates(space, e, below(space.cells, random), next.parameters);
  for (Eigen::MatrixXd* values : {&next.parameters.modulation, &next.parameters.demodulation})
    for (double& value : values->reshaped()) value += noise * random.normal();
  return next;
}

}  // namespace tofsmith

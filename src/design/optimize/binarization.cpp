// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/optimize/binarization.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tofsmith {

namespace {

Eigen::VectorXd cell_values(const WaveformSpace& space, const Eigen::VectorXd& samples) {
  Eigen::VectorXd cells(space.cells);
  for (int c = 0; c < space.cells; ++c) cells[c] = samples[c * space.repeat];
  return cells;
}

std::vector<int> ranked(const Eigen::VectorXd& cells) {
  std::vector<int> order(static_cast<std::size_t>(cells.size()));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return cells[a] > cells[b]; });
  return order;
}

SwitchedLabels first_of(const std::vector<int>& order, int count) {
  std::vector<int> cells(order.size(), 0);
  for (int i = 0; i < count; ++i)
    cells[static_cast<std::size_t>(order[static_cast<std::size_t>(i)])] = 1;
  return SwitchedLabels::from_cells(cells);
}

SwitchedLabels gates_of(const WaveformSpace& space, const SampledCode& code, int e) {
  const Eigen::VectorXd first = cell_values(space, code.demodulation.col(e * space.taps));
  if (space.equal_duties) {
    SwitchedLabels halves = first_of(ranked(first), space.cells / 2);
    for (int& label : halves.label) label = 1 - label;  // class 0 is the first bucket
    return halves;
  }
  Eigen::MatrixXd shares(space.cells, space.classes());
  for (int t = 0; t < space.taps; ++t)
    shares.col(t) = cell_values(space, code.demodulation.col(e * space.taps + t));
  if (space.drain)
    shares.col(space.taps) = 1.0 - shares.leftCols(space.taps).rowwise().sum().array();
  std::vector<int> cells(static_cast<std::size_t>(space.cells));
  for (int c = 0; c < space.cells; ++c) {
    Eigen::Index largest = 0;
    shares.row(c).maxCoeff(&largest);
    cells[static_cast<std::size_t>(c)] = static_cast<int>(largest);
  }
  return SwitchedLabels::from_cells(cells);
}

int nearest_count(const Eigen::VectorXd& cells, const std::vector<int>& order, int min_on) {
  const auto total = static_cast<double>(order.size());
  int best = min_on;
  double smallest = 1e300, lit = 0.0;
  for (int on = 1; on < static_cast<int>(order.size()); ++on) {
    lit += cells[order[static_cast<std::size_t>(on - 1)]];
    if (on < min_on) continue;
    // Squared distance to level total / on, up to a constant.
    const double distance = total * total / on - 2.0 * total / on * lit;
    if (distance < smallest) {
      smallest = distance;
      best = on;
    }
  }
  return best;
}

}  // namespace

SwitchedCode binarized(const DesignProblem& problem, const SampledCode& code) {
  const WaveformSpace& space = problem.space;
  SwitchedCode result;
  result.sampled = code;
  if (problem.binary_demodulation)
    for (int e = 0; e < space.exposures; ++e) result.gates.push_back(gates_of(space, code, e));
  if (!problem.binary_modulation) return result;

  const int min_on =
      std::max(1, static_cast<int>(std::ceil(space.cells / space.peak_factor - 1e-9)));
  for (int e = 0; e < space.exposures; ++e) {
    const Eigen::VectorXd cells = cell_values(space, code.modulation.col(e));
    const std::vector<int> order = ranked(cells);
    result.light.push_back(first_of(order, nearest_count(cells, order, min_on)));
  }
  return result;
}

}  // namespace tofsmith

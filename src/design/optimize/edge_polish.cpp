// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/optimize/edge_polish.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "design/exposure_shares.hpp"
#include "design/optimize/depth_error_loss.hpp"
#include "design/optimize/optimize_pool.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {

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
  if (space.equal_duties) {
    const Eigen::VectorXd first =
        first_samples(code.demodulation.col(e * space.taps), space.repeat);
    SwitchedLabels halves = first_of(ranked(first), space.cells / 2);
    for (int& label : halves.label) label = 1 - label;  // class 0 is the first bucket
    return halves;
  }
  const Eigen::ArrayXXd shares = class_shares(space, code, e);
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
    const Eigen::VectorXd cells = first_samples(code.modulation.col(e), space.repeat);
    const std::vector<int> order = ranked(cells);
    result.light.push_back(first_of(order, nearest_count(cells, order, min_on)));
  }
  return result;
}

namespace {

using EdgeGradient = std::vector<std::vector<std::vector<double>>>;

Eigen::Index sample_at(double time, int samples) {
  return std::min<Eigen::Index>(samples - 1, static_cast<Eigen::Index>(wrap(time, 1.0) * samples));
}

/// A delay of an edge by t changes its sample by N t times the level; a longer pulse lowers the
/// level.
std::vector<double> pull_back_light(const SwitchedLabels& light, const Eigen::VectorXd& gradient,
                                    const Eigen::VectorXd& modulation) {
  const auto samples = static_cast<int>(gradient.size());
  const double level = 1.0 / light.share(1);
  const double by_level = gradient.dot(modulation) * level;
  std::vector<double> result;
  for (std::size_t i = 0; i < light.runs(); ++i) {
    const double longer = light.label[i] == 1 ? -1.0 : 1.0;
    result.push_back(longer *
                     (samples * level * gradient[sample_at(light.at[i], samples)] - by_level));
  }
  return result;
}

/// Delaying an edge assigns its sample to the class before it.
std::vector<double> pull_back_gates(const WaveformSpace& space, const SwitchedLabels& gates,
                                    const Eigen::MatrixXd& gradient) {
  const auto by_class = [&](int label, Eigen::Index n) {
    return label < space.taps ? gradient(n, label) : 0.0;
  };
  std::vector<double> result;
  for (std::size_t i = 0; i < gates.runs(); ++i) {
    const Eigen::Index n = sample_at(gates.at[i], space.samples());
    const int before = gates.label[(i + gates.runs() - 1) % gates.runs()];
    result.push_back(space.samples() * (by_class(before, n) - by_class(gates.label[i], n)));
  }
  return result;
}

/// Returns true if all runs are long enough.
bool lengthen_short_runs(SwitchedLabels& labels, double shortest) {
  constexpr int rounds = 20;
  const std::size_t count = labels.runs();
  for (int round = 0; round < rounds; ++round) {
    bool good = true;
    for (std::size_t i = 0; i < count; ++i) {
      const double missing = shortest - labels.length(i);
      if (missing <= 0.0) continue;
      good = false;
      labels.at[i] -= 0.5001 * missing;
      labels.at[(i + 1) % count] += 0.5001 * missing;
    }
    if (good) return true;
  }
  return false;
}

void lengthen_pulses(SwitchedLabels& light, double peak_factor) {
  const double missing = 1.0 / peak_factor - light.share(1);
  if (missing <= 0.0) return;
  const double each = missing / (0.5 * static_cast<double>(light.runs()));
  const SwitchedLabels before_it = light;
  for (std::size_t i = 0; i < light.runs(); ++i)
    light.at[i] += (before_it.label[i] == 1 ? -0.5 : 0.5) * each * (1.0 + 1e-12);
}

bool is_playable(const SwitchedLabels& labels, double shortest) {
  for (std::size_t i = 0; i < labels.runs(); ++i)
    if (labels.length(i) < shortest) return false;
  return true;
}

/// Restores feasibility, if possible.
void step_edges(SwitchedLabels& labels, const std::vector<double>& gradient, double rate,
                double shortest, double light_peak, Adam& adam) {
  if (labels.runs() == 0) return;
  const SwitchedLabels unmoved = labels;
  Eigen::MatrixXd times =
      Eigen::Map<const Eigen::VectorXd>(labels.at.data(), std::ssize(labels.at));
  adam.step(times, Eigen::Map<const Eigen::VectorXd>(gradient.data(), std::ssize(gradient)), rate);
  labels.at.assign(times.data(), times.data() + times.size());
  constexpr int rounds = 5;
  bool good = false;
  for (int round = 0; round < rounds && !good; ++round) {
    good = lengthen_short_runs(labels, shortest);
    if (light_peak > 0.0) lengthen_pulses(labels, light_peak);
    good = good && is_playable(labels, shortest);
  }
  if (!good) labels = unmoved;
}

constexpr double decision_sharpness = 3.0;

/// Steps of the logits of exposure shares.
class ShareSteps {
 public:
  ShareSteps(const Eigen::VectorXd& shares, double first_rate)
      : logits_(logits_of_shares(shares)), first_rate_(first_rate) {}

  Eigen::VectorXd step(const Eigen::VectorXd& by_shares, double done) {
    constexpr double least = 0.03;  // of the first rate
    adam_.step(logits_, pull_back_shares(shares_of_logits(logits_), by_shares),
               first_rate_ * std::max(least, 1.0 - done));
    return shares_of_logits(logits_);
  }

 private:
  Eigen::MatrixXd logits_;
  double first_rate_;
  Adam adam_;
};

}  // namespace

EdgeGradient pull_back_to_edges(const WaveformSpace& space, const SwitchedCode& code,
                                const SampledCode& gradient) {
  EdgeGradient result(2);
  const SampledCode sampled = sampled_on(space, code);
  for (std::size_t e = 0; e < code.light.size(); ++e) {
    const auto column = static_cast<Eigen::Index>(e);
    result[0].push_back(pull_back_light(code.light[e], gradient.modulation.col(column),
                                        sampled.modulation.col(column)));
  }
  for (std::size_t e = 0; e < code.gates.size(); ++e)
    result[1].push_back(pull_back_gates(
        space, code.gates[e],
        gradient.demodulation.middleCols(static_cast<Eigen::Index>(e) * space.taps, space.taps)));
  return result;
}

SwitchedCode polish_edges(const DesignProblem& problem, SwitchedCode code, int steps,
                          int trials_per_step, std::uint64_t seed, std::uint64_t work_item,
                          SharedProgress* progress) {
  constexpr double min_run = 1e-3;     // in periods; keeps edges apart
  constexpr double first_rate = 0.15;  // cells per step
  const WaveformSpace& space = problem.space;
  const double shortest = std::max(min_run, problem.shortest_run_periods);
  Eigen::VectorXd& shares = code.sampled.shares;
  if (space.equal_duties && code.light.empty() && shares.size() == 0) return code;
  StochasticGradient gradient(problem, trials_per_step, seed, work_item);
  std::vector<Adam> light(code.light.size()), gates(code.gates.size());
  std::optional<ShareSteps> share_steps;
  if (shares.size() > 0) share_steps.emplace(shares, 0.03);
  for (int step = 0; step < steps; ++step) {
    if (progress) progress->add();
    const double done = static_cast<double>(step) / steps;
    RandomStream random(seed, work_item, static_cast<std::uint32_t>(step));
    const SampledCode by_samples = gradient.at(sampled_on(space, code), decision_sharpness, random);
    const EdgeGradient by_edges = pull_back_to_edges(space, code, by_samples);
    const double rate = first_rate / space.cells * std::max(0.03, 1.0 - done);
    if (share_steps) shares = share_steps->step(by_samples.shares, done);
    for (std::size_t e = 0; e < light.size(); ++e)
      step_edges(code.light[e], by_edges[0][e], rate, shortest, space.peak_factor, light[e]);
    if (space.equal_duties) continue;
    for (std::size_t e = 0; e < gates.size(); ++e)
      step_edges(code.gates[e], by_edges[1][e], rate, shortest, 0.0, gates[e]);
  }
  return code;
}

Eigen::VectorXd descend_shares(const DesignProblem& problem, SampledCode code, int steps,
                               int trials_per_step, std::uint64_t seed, std::uint64_t work_item) {
  StochasticGradient gradient(problem, trials_per_step, seed, work_item);
  ShareSteps share_steps(code.shares, 0.1);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(code.shares.size());
  for (int step = 0; step < steps; ++step) {
    RandomStream random(seed, work_item, static_cast<std::uint32_t>(step));
    const SampledCode by = gradient.at(code, decision_sharpness, random);
    code.shares = share_steps.step(by.shares, static_cast<double>(step) / steps);
    if (2 * (step + 1) > steps) sum += code.shares;
  }
  return sum / sum.sum();
}

}  // namespace tofsmith

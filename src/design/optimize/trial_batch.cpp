// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/optimize/trial_batch.hpp"

#include <algorithm>
#include <cmath>

namespace tofsmith {

namespace {

constexpr double closest = 1e-4;
const double decades = -std::log(closest);

/// `quantile` in [0, 1).
double depth_near_end(double quantile, bool upper) {
  const double distance = 0.5 * std::exp(-decades * quantile);
  return upper ? std::nextafter(1.0, 0.0) * (1.0 - distance) : distance;
}

void move_to(const TwoReturnGrid& grid, DepthTrial& trial) {
  const auto bin_of = [&](double periods) { return std::round(periods * grid.bins); };
  const double bin = bin_of(trial.depth_periods);
  trial.depth_periods = (bin < grid.bins ? bin : 0.0) / grid.bins;
  trial.later_delay_periods = std::clamp<double>(bin_of(trial.later_delay_periods),
                                                 grid.delays.shortest, grid.delays.longest) /
                              grid.bins;
}

/// Prior density / density of its equal mixture with depths near the ends.
double weight_in_mixture(double depth_periods, const DepthPrior& depths) {
  const double distance = std::min(depth_periods, 1.0 - depth_periods);
  const double near_ends = distance > 0.5 * closest ? 0.5 / (distance * decades) : 0.0;
  const double density = depths.density(depth_periods);
  return density == 0.0 ? 0.0 : density / (0.5 * density + 0.5 * near_ends);
}

}  // namespace

NoiseStore::NoiseStore(RandomStream random) : normals_(std::size_t{1} << 15) {
  for (double& normal : normals_) normal = random.normal();
}

std::vector<double> NoiseStore::window(std::size_t count, RandomStream& random) const {
  std::vector<double> numbers(count);
  auto at = static_cast<std::size_t>(random.uniform() * static_cast<double>(normals_.size()));
  for (double& number : numbers) {
    number = normals_[at];
    at = at + 1 < normals_.size() ? at + 1 : 0;
  }
  return numbers;
}

TrialBatch draw_trials(int count, int measurements, const OperatingRange& range, bool ends_matter,
                       RandomStream& random, const NoiseStore* store, const MultipathTrials* later,
                       const DepthPrior& depths) {
  TrialBatch batch;
  batch.measurements = measurements;
  if (later) batch.two_returns = later->decoded_as_two;
  batch.trials.resize(static_cast<std::size_t>(count));
  if (batch.two_returns) ends_matter = false;  // always circular errors
  if (depths.density(0.0) == 0.0 && depths.density(1.0) == 0.0) ends_matter = false;
  const int uniform = ends_matter ? count / 2 : count;
  for (int t = 0; t < count; ++t) {
    DepthTrial& trial = batch.trials[static_cast<std::size_t>(t)];
    const double u = random.uniform();
    if (t < uniform)
      trial.depth_periods = depths.quantile((t + u) / uniform);
    else
      trial.depth_periods = depth_near_end((t - uniform + u) / (count - uniform), t % 2 == 1);
    if (ends_matter) trial.weight = weight_in_mixture(trial.depth_periods, depths);
    trial.albedo = range.uniform_albedo ? random.uniform() : range.albedo;
    if (later) {
      trial.multipath_ratio = later->returns.ratio_at(random.uniform());
      trial.later_delay_periods = later->returns.delay_at_m(random.uniform()) / later->range_m;
      if (later->decoded_as_two) move_to(*later->decoded_as_two, trial);
    }
  }
  const auto numbers = static_cast<std::size_t>(count) * static_cast<std::size_t>(measurements);
  if (store) {
    batch.normals = store->window(numbers, random);
    return batch;
  }
  batch.normals.resize(numbers);
  for (double& normal : batch.normals) normal = random.normal();
  return batch;
}

}  // namespace tofsmith

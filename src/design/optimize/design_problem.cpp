// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/optimize/design_problem.hpp"

#include <fmt/format.h>

#include <cmath>

#include "camera/shared/listed_exposures.hpp"
#include "design/run_lengths.hpp"
#include "tofsmith/camera/forward_model.hpp"

namespace tofsmith {

namespace {

constexpr int min_samples = 96;
constexpr int min_cells = 4;

bool factors_are_small(int count) {
  for (const int factor : {2, 3, 5})
    while (count % factor == 0) count /= factor;
  return count == 1;
}

double usable_peak(int cells, double peak_factor) {
  return cells / std::ceil(cells / peak_factor - 1e-9) / peak_factor;
}

int cells_within(int most, double peak_factor) {
  const auto largest = [&](double min_usable) {
    for (int cells = most; cells >= min_cells && 5 * cells >= 4 * most; --cells)
      if (cells % 2 == 0 && factors_are_small(cells) &&
          usable_peak(cells, peak_factor) >= min_usable)
        return cells;
    return 0;
  };
  for (const double min_usable : {0.98, 0.9, 0.0})
    if (const int cells = largest(min_usable)) return cells;
  return most;
}

/// `count` values that interpolate the sorted list: uniform in rank, logarithmic above `floor`.
std::vector<double> in_between(std::vector<double> levels, int count, double floor) {
  std::sort(levels.begin(), levels.end());
  if (std::ssize(levels) <= count) return levels;
  std::vector<double> result;
  for (int i = 0; i < count; ++i) {
    const double rank = (i + 0.5) / count * static_cast<double>(levels.size() - 1);
    const auto below = static_cast<std::size_t>(rank);
    const double share = rank - static_cast<double>(below);
    const double low = std::log(levels[below] + floor);
    const double high = std::log(levels[below + 1] + floor);
    result.push_back(std::exp(low + share * (high - low)) - floor);
  }
  return result;
}

int runs_per_period(double shortest) { return static_cast<int>(std::floor(1.0 / shortest + 1e-9)); }

/// Two returns need two strengths, two depths, ambient light (if visible) and one more mean.
bool may_tell_two_returns(const Camera& camera, int exposures) {
  const int taps = camera.sensor.taps;
  if (camera.sensor.readout == Readout::difference) return exposures >= 5;
  // Taps that share all charge have a constant sum.
  const bool share_all = taps > 1 && !(taps > 2 && camera.sensor.drain);
  return (share_all ? exposures * (taps - 1) + 1 : exposures * taps) >= 6;
}

/// Rounds second returns to a grid that is coarse enough to test all pairs of bins.
MultipathTrials decoded_as_two(MultipathTrials later, int samples) {
  constexpr int max_bins = 160;
  int step = (samples + max_bins - 1) / max_bins;
  while (samples % step != 0) ++step;
  const int bins = samples / step;
  const auto bin_of = [&](double delay_m) {
    return std::clamp(static_cast<int>(std::lround(delay_m / later.range_m * bins)), 1, bins - 1);
  };
  const auto [shortest_m, longest_m] = later.returns.delay_m;
  later.decoded_as_two =
      TwoReturnGrid{bins, {bin_of(shortest_m), bin_of(std::max(longest_m, later.range_m / 3.0))}};
  return later;
}

std::vector<LightLevel> levels_of(const Camera& camera,
                                  const std::optional<OperatingMultipath>& later,
                                  double two_return_weight) {
  const std::vector<OperatingPoint> points = training_points(camera);
  std::vector<LightLevel> levels;
  const auto add = [&](TrialReturns returns, double weight) {
    for (const OperatingPoint& point : points) levels.push_back({point, returns, weight});
  };
  add(TrialReturns::one, later ? 1.0 - later->weight : 1.0);
  if (later) add(TrialReturns::two_taken_for_one, later->weight);
  if (later && two_return_weight > 0.0) add(TrialReturns::two, two_return_weight);
  return levels;
}

}  // namespace

std::optional<BrokenRule> why_not_optimizable(const Camera& on, int exposures) {
  if (on.sensor.is_signed() && on.sensor.tap_mismatch != 0.0)
    return broken("sensor.tap_mismatch", on.sensor.tap_mismatch,
                  "must be 0 to optimize codes for sensor.demodulation = \"signed\"");
  const Camera camera = in_buckets(on);
  if (exposures < 1 || exposures > 8) return broken("exposures", exposures, "must be in [1, 8]");
  if (camera.sensor.readout == Readout::rows)
    return broken("sensor.readout", "rows", "must be separate or difference to optimize codes");
  const bool difference = camera.sensor.readout == Readout::difference;
  const int measurements = difference ? exposures : exposures * camera.sensor.taps;
  const int fewest = sees_ambient(camera, exposures) ? 3 : 2;
  if (measurements < fewest)
    return broken(
        "exposures", exposures,
        fmt::format("must give at least {} measurements; with sensor.taps = {} this requires {}",
                    fewest, camera.sensor.taps,
                    difference ? fewest : (2 + camera.sensor.taps) / camera.sensor.taps));
  if (camera.light.peak_factor <= 1.0)
    return broken("light.peak_factor", camera.light.peak_factor,
                  "must be > 1 to optimize: constant light cannot measure depth");
  if (!camera.band_limited() && !camera.sensor.shortest_pulse_s)
    return broken("sensor.shortest_pulse_s", "none",
                  fmt::format("is required to optimize for a camera without band limit, for which "
                              "shorter pulses are always better; try {:.2g}",
                              suggested_shortest_pulse_s(camera)));
  if (auto others = other_exposures_listed(camera, exposures)) return others;
  const double shortest = shortest_run_periods(camera);
  if (shortest > 0.0 && runs_per_period(shortest) < min_cells)
    return broken("sensor.shortest_pulse_s", *camera.sensor.shortest_pulse_s,
                  "must be at most a quarter of the period");
  return std::nullopt;
}

double suggested_shortest_pulse_s(const Camera& camera) {
  return 2.0 / (camera.samples * camera.fundamental_frequency_hz);
}

WaveformSpace waveform_space(const Camera& camera, int exposures, int samples) {
  const double shortest = shortest_run_periods(camera);
  const int most = shortest > 0.0 ? std::min(samples, runs_per_period(shortest)) : samples;
  WaveformSpace space;
  space.cells = cells_within(most, camera.light.peak_factor);
  space.repeat = (std::min(samples, min_samples) + space.cells - 1) / space.cells;
  space.exposures = exposures;
  space.taps = camera.sensor.taps;
  space.drain = space.taps == 1 || (space.taps > 2 && camera.sensor.drain);
  space.peak_factor = camera.light.peak_factor;
  space.equal_duties = camera.sensor.readout == Readout::difference;
  return space;
}

std::vector<OperatingPoint> training_points(const Camera& camera) {
  std::vector<OperatingPoint> all = camera.operating.points();
  if (all.size() <= 40) return all;
  const double floor_e_per_s =
      std::max(1.0, constant_variance_e2_of(camera.sensor)) /
      camera.exposure_s.of(
          0, static_cast<int>(std::max<std::size_t>(1, camera.exposure_s.each_s.size())));
  OperatingRange fewer = camera.operating;
  fewer.signal_e_per_s = in_between(fewer.signal_e_per_s, 6, 0.0);
  fewer.ambient_e_per_s = in_between(fewer.ambient_e_per_s, 6, floor_e_per_s);
  return fewer.points();
}

double CameraVariant::total_weight() const {
  double total = 0.0;
  for (const LightLevel& level : levels) total += level.weight;
  return total;
}

std::size_t CameraVariant::usual_levels() const {
  return static_cast<std::size_t>(
      std::count_if(levels.begin(), levels.end(),
                    [](const LightLevel& level) { return level.returns != TrialReturns::two; }));
}

DesignProblem make_design_problem(std::span<const Camera> given, int exposures, int samples,
                                  double two_return_weight) {
  require(!given.empty(), "variants", given.size(), "must contain at least one camera");
  std::vector<Camera> variants;
  for (const Camera& variant : given) variants.push_back(judged_camera(variant));
  require(why_not_optimizable(variants.front(), exposures));
  const Camera camera = in_buckets(variants.front());
  DesignProblem problem;
  problem.space = waveform_space(camera, exposures, samples);
  problem.operating = camera.operating;
  problem.depths = DepthPrior(camera);
  problem.shortest_run_periods = shortest_run_periods(camera);
  problem.binary_modulation = camera.light.binary;
  problem.binary_demodulation = camera.sensor.binary;
  if (const auto& later = camera.operating.multipath)
    problem.later = MultipathTrials{*later, camera.range_m(), {}};
  if (!may_tell_two_returns(camera, exposures)) two_return_weight = 0.0;
  if (problem.later && two_return_weight > 0.0)
    problem.multipath_as_two = decoded_as_two(*problem.later, problem.space.samples());
  for (const Camera& variant : variants) {
    const Sensor &its = variant.sensor, &first = variants.front().sensor;
    require(its.taps == first.taps && its.readout == first.readout &&
                its.demodulation == first.demodulation,
            "variants", variant.name,
            "must have the same taps, readout and demodulation as the first");
    const int samples_here = problem.space.samples();
    const int finer = camera.band_limited() ? 1 : std::clamp(camera.samples / samples_here, 1, 4);
    problem.variants.push_back({SampledCamera(variant, samples_here, exposures),
                                SampledCamera(variant, finer * samples_here, exposures),
                                levels_of(variant, camera.operating.multipath, two_return_weight)});
  }
  return problem;
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Compares designed frequencies with named sets of frequencies and with the first choice of the
// usual rule of thumb, for random sensors. All codes are square waves, evaluated with new trials.
//
//   benchmark_random_sensors [SENSORS] [SEED]
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>

#include "design/frequencies/frequency_search.hpp"
#include "design/judge.hpp"
#include "random_sensors.hpp"
#include "tofsmith/design/design.hpp"

namespace {

using namespace tofsmith;

/// Frequencies that commercial cameras, their software and the built-in families use, as multiples
/// of the fundamental frequency.
const std::vector<std::vector<int>> named_sets = {
    {15, 10, 2}, {5, 4},  {20, 18, 15}, {7, 1}, {3, 1},     {4, 1},     {6, 5},    {10, 9},
    {10, 1},     {5, 1},  {8, 7},       {2, 1}, {1},        {12, 1},    {3, 2},    {4, 3},
    {24, 12},    {24, 8}, {8, 1},       {6, 1}, {24, 8, 1}, {12, 4, 1}, {8, 6, 1}, {24, 12, 1}};

/// Returns the named sets that the sensor can generate, each with 2 to 4 phases within the limit of
/// exposures.
std::vector<SquareCode> named_codes(const FrequencyChoice& choice) {
  std::vector<SquareCode> codes;
  for (const std::vector<int>& set : named_sets) {
    SquareCode code{.duty = choice.duties.back(), .tones = {}};
    bool is_possible = true;
    for (const int frequency : set) {
      code.tones.push_back({.frequency = frequency});
      is_possible &=
          std::count(choice.frequencies.begin(), choice.frequencies.end(), frequency) > 0;
    }
    if (!is_possible) continue;
    for (int phases = choice.first_phases; phases <= 4; ++phases) {
      const int exposures = phases * static_cast<int>(set.size());
      if (exposures <= choice.exposures.back())
        codes.push_back(with_exposures(code, choice, exposures));
    }
  }
  return codes;
}

struct Peer {
  std::string name = "none";
  double error_m = INFINITY, standard_error_m = 0.0;
};

/// Returns the best code by new trials.
Peer best_of(const std::vector<SquareCode>& codes, const Camera& camera,
             const EvaluateOptions& fresh) {
  Peer best;
  for (const SquareCode& code : codes) {
    const CodeSet set = to_code_set(code, camera);
    if (why_no_depth(set, camera)) continue;
    const Estimate error = evaluate(set, camera, fresh).circular.geometric_mean_m;
    if (error.value < best.error_m) best = {set.name(), error.value, error.standard_error};
  }
  return best;
}

}  // namespace

int main(int argc, char** argv) {
  const int sensors = argc > 1 ? std::atoi(argv[1]) : 20;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  int worse = 0;
  double longest_s = 0.0, log_gain = 0.0;
  fmt::print("winner of `design --method frequencies`, best named set, rule of thumb; mm\n");
  for (int i = 0; i < sensors; ++i) {
    const Camera camera = random_sensor(seed, static_cast<std::uint64_t>(i));
    DesignOptions options;
    options.method = DesignMethod::frequencies;
    const std::clock_t begin = std::clock();
    const DesignResult result = design(camera, options);
    const double cpu_s = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    longest_s = std::max(longest_s, cpu_s);

    const EvaluateOptions fresh{.trials = 40000, .seed = seed + 1000, .bounds = false};
    const FrequencyChoice choice = frequency_choice(camera, options);
    const Estimate mine = evaluate(result.winner().code, camera, fresh).circular.geometric_mean_m;
    const Peer named = best_of(named_codes(choice), camera, fresh);
    const auto usual = rule_of_thumb(choice);
    const Peer rule =
        best_of(usual ? std::vector{*usual} : std::vector<SquareCode>{}, camera, fresh);
    const Peer& peer = named.error_m < rule.error_m ? named : rule;
    const double ratio = mine.value / peer.error_m;
    const double error =
        ratio * std::hypot(mine.standard_error / mine.value, peer.standard_error_m / peer.error_m);
    const bool is_worse = ratio > 1.0 + 3.0 * error;
    worse += is_worse;
    if (std::isfinite(rule.error_m)) log_gain += std::log(rule.error_m / mine.value);
    fmt::print(
        "{:10} {} taps {:2} frequencies {:24} {:8.2f}  {:20} {:8.2f}  {:20} {:8.2f}  {:.3f} "
        "+- {:.3f} {:5.1f} s {}\n",
        camera.name, camera.sensor.taps, choice.frequencies.size(), result.winner().code.name(),
        1e3 * mine.value, named.name, 1e3 * named.error_m, rule.name, 1e3 * rule.error_m, ratio,
        error, cpu_s, is_worse ? "WORSE" : "");
    std::fflush(stdout);
  }
  fmt::print(
      "mean gain over the rule of thumb {:.3f}; worse by more than 3 standard errors: {} "
      "(asked: 0); most {:.1f} s of CPU (asked: 60 s on two cores)\n",
      std::exp(log_gain / sensors), worse, longest_s);
  return worse == 0 ? 0 : 1;
}

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/optimize/optimize_starts.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tofsmith/code/families.hpp"

namespace tofsmith {
namespace {

/// Harmonics 1 to `highest_frequency` with normal coefficients.
Eigen::VectorXd smooth_function(int samples, int highest_frequency, RandomStream& random) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(samples);
  for (int f = 1; f <= highest_frequency; ++f) {
    const double a = random.normal(), b = random.normal();
    for (int n = 0; n < samples; ++n) {
      const double angle = 2.0 * std::numbers::pi * f * (n + 0.5) / samples;
      values[n] += a * std::cos(angle) + b * std::sin(angle);
    }
  }
  return values;
}

SampledCode empty_code(const WaveformSpace& space) {
  return {Eigen::MatrixXd::Zero(space.samples(), space.exposures),
          Eigen::MatrixXd::Zero(space.samples(), space.exposures * space.taps)};
}

int highest_useful_frequency(const DesignProblem& problem) {
  constexpr double useful = 0.02;  // fraction of the amplitude
  constexpr int max_frequency = 16;
  int highest = 1;
  for (int n = 1; n <= std::min(max_frequency, problem.space.cells / 4); ++n)
    if (std::abs(problem.variants.front().camera.transfer(n)) > useful) highest = n;
  return highest;
}

void write_pulses(const WaveformSpace& space, int count, double duty, int exposure,
                  SampledCode& code) {
  code.modulation.col(exposure) =
      pulse_train(count, std::min(1.0, duty)).cell_averages(space.samples());
}

void write_turns(const WaveformSpace& space, int frequency, double phase, int exposure,
                 SampledCode& code) {
  const int turns = std::max(2, space.taps), samples = space.samples();
  for (int n = 0; n < samples; ++n) {
    const double x = frequency * (n + 0.5) / samples + phase;
    const int tap = static_cast<int>((x - std::floor(x)) * turns);
    if (tap < space.taps) code.demodulation(n, exposure * space.taps + tap) = 1.0;
  }
}

void write_smooth_gates(const WaveformSpace& space, int highest_frequency, int exposure,
                        RandomStream& random, SampledCode& code) {
  const int choices = std::max(2, space.taps), samples = space.samples();
  Eigen::MatrixXd functions(samples, choices);
  for (int c = 0; c < choices; ++c)
    functions.col(c) = smooth_function(samples, highest_frequency, random);
  for (int n = 0; n < samples; ++n) {
    Eigen::Index tap = 0;
    functions.row(n).maxCoeff(&tap);
    if (tap < space.taps) code.demodulation(n, exposure * space.taps + tap) = 1.0;
  }
}

/// On where a random smooth function is largest, for the shortest duty.
void write_smooth_light(const WaveformSpace& space, int highest_frequency, int exposure,
                        RandomStream& random, SampledCode& code) {
  const int samples = space.samples();
  const Eigen::VectorXd values = smooth_function(samples, highest_frequency, random);
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.rbegin(), sorted.rend());
  const auto on = std::clamp<std::size_t>(
      static_cast<std::size_t>(std::ceil(samples / space.peak_factor - 1e-9)), 1, sorted.size());
  const double threshold = sorted[on - 1];
  for (int n = 0; n < samples; ++n)
    if (values[n] >= threshold)
      code.modulation(n, exposure) = static_cast<double>(samples) / static_cast<double>(on);
}

constexpr double start_scale = 1.5;  // parameters of a waveform that is on
constexpr double start_noise = 0.05;
constexpr double rough_noise = 0.6;

void add_noise(WaveformParameters& parameters, double deviation, RandomStream& random) {
  for (Eigen::MatrixXd* values : {&parameters.modulation, &parameters.demodulation})
    for (double& value : values->reshaped()) value += deviation * random.normal();
}

std::vector<CodeSet> families_of(const WaveformSpace& space) {
  std::vector<CodeSet> codes;
  if (space.taps > 2) return codes;
  std::vector<std::string> names = {fmt::format("hamiltonian-k{}", space.exposures),
                                    fmt::format("pulsed-multifrequency-k{}", space.exposures),
                                    fmt::format("gray-k{}", space.exposures)};
  if (space.exposures == 4 || space.exposures == 5)
    names.push_back(fmt::format("pulsed-multifrequency-k{}-q5", space.exposures));
  const FamilyOptions options{.samples = 240, .peak_factor = space.peak_factor};
  for (const std::string& name : names) {
    if (why_no_family(name, options)) continue;  // no such member
    const CodeSet code = make_family(name, options);
    codes.push_back(space.taps == 2 ? code.with_two_buckets() : code);
  }
  return codes;
}

OptimizeStart start_at(const DesignProblem& problem, const CodeSet& code, double noise,
                       RandomStream& random) {
  constexpr double nearer = 2.0;
  const WaveformSpace& space = problem.space;
  OptimizeStart start{code.name(), parameters_near(space, sampled_on(space, code), start_scale)};
  if (!problem.binary_modulation) start.parameters.modulation *= nearer;
  if (!problem.binary_demodulation) start.parameters.demodulation *= nearer;
  add_noise(start.parameters, noise, random);
  return start;
}

struct ExposureTone {
  int frequency;
  double phase_turns;
};

/// Adds exposures of one frequency: two in quadrature, otherwise with evenly spaced phases.
void add_tones(std::vector<ExposureTone>& tones, int frequency, int count, double spread_turns,
               double first_phase_turns = 0.0) {
  for (int e = 0; e < count; ++e)
    tones.push_back(
        {frequency, first_phase_turns + e * (count == 2 ? 0.25 : spread_turns / count)});
}

double spread_of_phases(const WaveformSpace& space) {
  return space.taps >= 2 ? 0.5 : 1.0;  // buckets add the opposite phase
}

/// Exposures of frequency 1 that measure depth, signal and ambient light without others.
int exposures_for_depth(const WaveformSpace& space) {
  if (space.taps > 2) return 1;
  if (space.taps == 2) return 2;
  return space.exposures >= 4 ? 3 : 2;
}

SampledCode mixture_of_frequencies(const WaveformSpace& space,
                                   std::span<const ExposureTone> tones) {
  SampledCode code = empty_code(space);
  const double duty = std::max(1.0 / space.peak_factor, space.taps > 2 ? 0.5 / space.taps : 0.2);
  for (int e = 0; e < space.exposures; ++e) {
    const ExposureTone& tone = tones[static_cast<std::size_t>(e)];
    write_pulses(space, tone.frequency, duty, e, code);
    write_turns(space, tone.frequency, tone.phase_turns, e, code);
  }
  return code;
}

/// The first exposures have frequency 1, so that depth is unique; the others have random
/// frequencies and phases.
SampledCode random_mixture(const DesignProblem& problem, RandomStream& random) {
  const WaveformSpace& space = problem.space;
  const int highest = highest_useful_frequency(problem);
  std::vector<ExposureTone> tones;
  add_tones(tones, 1, std::min(space.exposures, exposures_for_depth(space)),
            spread_of_phases(space));
  while (std::ssize(tones) < space.exposures) {
    const int frequency = 2 + static_cast<int>(random.uniform() * std::max(1, highest - 1));
    tones.push_back({frequency, random.uniform()});
  }
  return mixture_of_frequencies(space, tones);
}

SampledCode random_gates(const DesignProblem& problem, bool random_light, RandomStream& random) {
  const WaveformSpace& space = problem.space;
  const int highest = std::min(9, highest_useful_frequency(problem));
  const auto any = [&] { return 1 + static_cast<int>(random.uniform() * highest); };
  SampledCode code = empty_code(space);
  for (int e = 0; e < space.exposures; ++e) {
    write_smooth_gates(space, any(), e, random, code);
    if (random_light)
      write_smooth_light(space, any(), e, random, code);
    else
      write_pulses(space, 1, 1.0 / space.peak_factor, e, code);
  }
  return code;
}

}  // namespace

SampledCode sampled_on(const WaveformSpace& space, const CodeSet& code) {
  return {code.resampled(space.samples()).modulation_samples(),
          code.resampled(space.samples()).demodulation_samples()};
}

WaveformParameters random_pair(const DesignProblem& problem, RandomStream& random) {
  WaveformSpace one = problem.space;
  one.exposures = 1;
  SampledCode code = empty_code(one);
  const int highest = highest_useful_frequency(problem);
  const int frequency = 1 + static_cast<int>(random.uniform() * std::min(9, highest));
  const double kind = random.uniform();
  const double duty = std::max(1.0 / one.peak_factor, one.taps > 2 ? 0.5 / one.taps : 0.2);
  if (kind < 0.4) {
    write_pulses(one, frequency, duty, 0, code);
    write_turns(one, frequency, random.uniform(), 0, code);
  } else {
    write_smooth_gates(one, frequency, 0, random, code);
    if (kind < 0.7)
      write_pulses(one, 1, 1.0 / one.peak_factor, 0, code);
    else
      write_smooth_light(one, 1 + static_cast<int>(random.uniform() * std::min(9, highest)), 0,
                         random, code);
  }
  return parameters_near(one, code, start_scale);
}

std::vector<OptimizeStart> frequency_mixtures(const DesignProblem& problem) {
  constexpr int max_middle = 4;
  const WaveformSpace& space = problem.space;
  const int highest = highest_useful_frequency(problem);
  const double spread = spread_of_phases(space);
  std::vector<OptimizeStart> starts;
  const auto add = [&](const std::string& name, std::vector<ExposureTone> tones, int high) {
    add_tones(tones, high, space.exposures - static_cast<int>(std::ssize(tones)), spread);
    starts.push_back(
        {name, parameters_near(space, mixture_of_frequencies(space, tones), start_scale)});
  };
  // One tap also measures depth with two exposures of frequency 1 and the others.
  const int min_lowest = std::min(2, exposures_for_depth(space));
  const int max_lowest = std::min(exposures_for_depth(space) + 1, space.exposures - 1);
  for (int count = min_lowest; count <= max_lowest; ++count) {
    std::vector<ExposureTone> lowest;
    add_tones(lowest, 1, count, spread);
    for (int high = 2; high <= highest; ++high) {
      add(fmt::format("frequencies 1 and {}", high), lowest, high);
      for (int middle = 2; middle < std::min(high, max_middle + 1); ++middle) {
        const auto add_with_middle = [&](int middle_count, double first_phase_turns) {
          if (count + middle_count >= space.exposures) return;
          std::vector<ExposureTone> tones = lowest;
          add_tones(tones, middle, middle_count, spread, first_phase_turns);
          add(fmt::format("frequencies 1, {} and {}", middle, high), std::move(tones), high);
        };
        add_with_middle(1, 0.0);
        add_with_middle(1, 0.25);
        add_with_middle(2, 0.0);
      }
    }
  }
  return starts;
}

std::vector<CodeSet> fitting_codes(const WaveformSpace& space, std::span<const CodeSet> also) {
  std::vector<CodeSet> codes;
  for (const CodeSet& code : also)
    if (code.exposures() == space.exposures && code.taps() == space.taps) codes.push_back(code);
  for (CodeSet& family : families_of(space))
    if (std::none_of(codes.begin(), codes.end(),
                     [&](const CodeSet& code) { return code.name() == family.name(); }))
      codes.push_back(std::move(family));
  return codes;
}

OptimizeStart optimize_start(const DesignProblem& problem, std::span<const CodeSet> codes,
                             std::span<const OptimizeStart> mixtures, int index,
                             RandomStream& random) {
  const auto count = static_cast<int>(codes.size());
  if (index < count)
    return start_at(problem, codes[static_cast<std::size_t>(index)], start_noise, random);
  index -= count;
  if (index < std::ssize(mixtures)) {
    OptimizeStart start = mixtures[static_cast<std::size_t>(index)];
    add_noise(start.parameters, start_noise, random);
    return start;
  }
  index -= static_cast<int>(std::ssize(mixtures));
  const int kind = index % 4, cycle = index / 4;
  if (kind == 1 && count > 0) {
    OptimizeStart start =
        start_at(problem, codes[static_cast<std::size_t>(cycle % count)], rough_noise, random);
    start.name += " with noise";
    return start;
  }
  SampledCode code;
  std::string name;
  if (kind != 3) {
    name = fmt::format("random frequencies {}", 3 * cycle + kind + 1);
    code = random_mixture(problem, random);
  } else {
    const bool random_light = cycle % 2 == 1;
    name = random_light ? "random gates, random light" : "random gates, one pulse";
    code = random_gates(problem, random_light, random);
  }
  OptimizeStart start{name, parameters_near(problem.space, code, start_scale)};
  add_noise(start.parameters, start_noise, random);
  return start;
}

}  // namespace tofsmith

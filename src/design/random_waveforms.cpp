// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/random_waveforms.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tofsmith/code/waveform.hpp"

namespace tofsmith {

namespace {

/// Sum of harmonics 1 .. highest with normal coefficients, at the samples.
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

}  // namespace

SampledCode empty_code(const WaveformSpace& space) {
  return {Eigen::MatrixXd::Zero(space.samples(), space.exposures),
          Eigen::MatrixXd::Zero(space.samples(), space.exposures * space.taps)};
}

int highest_useful_frequency(const DesignProblem& problem) {
  constexpr double useful = 0.02;  // of the amplitude, behind both arms
  constexpr int most = 14;
  int highest = 1;
  for (int n = 1; n <= std::min(most, problem.space.cells / 4); ++n)
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

}  // namespace tofsmith

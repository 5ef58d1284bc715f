// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>

#include "core/shared/periodic.hpp"
#include "core/shared/random.hpp"
#include "tofsmith/design/circulant_tv.hpp"

namespace tofsmith::test {

struct InstanceKind {
  int samples = 240;
  double weight_per_sample = 2e-5;
  bool band_limited = false;  ///< the fixed waveform is smoothed twice by a Hann window
};

/// Convolves with a centred Hann window of `width` samples and sum 1.
inline Eigen::VectorXd smoothed(const Eigen::VectorXd& x, int width) {
  Eigen::VectorXd window = Eigen::VectorXd::Zero(x.size());
  for (int i = 0; i < width; ++i)
    window[(i - width / 2 + x.size()) % x.size()] =
        0.5 - 0.5 * std::cos(2 * std::numbers::pi * (i + 1) / (width + 1));
  return circular_convolution(x, window / window.sum());
}

inline Eigen::VectorXd trapezoid_target(int samples, double pulse_duty) {
  Eigen::VectorXd square(samples), pulse(samples);
  for (int n = 0; n < samples; ++n) {
    square[n] = n + 0.5 < 0.5 * samples ? 1.0 : 0.0;
    pulse[n] = n + 0.5 < pulse_duty * samples ? 1.0 / pulse_duty : 0.0;
  }
  return circular_correlation(square, pulse) / samples;
}

/// Returns a random sub-problem of the alternating design. The fixed waveform is binary with 1 to 8
/// pulses, the target a trapezoid, noisy in half of the cases. The unknown is a demodulation (at
/// most 1, no budget) or a modulation (peak factor 2 to 30, mean at most 1).
inline CirculantTvProblem random_circulant_tv(const InstanceKind& kind, RandomStream& random) {
  const int samples = kind.samples;
  const auto below = [&](int count) { return static_cast<int>(random.uniform() * count); };
  CirculantTvProblem problem;
  Eigen::VectorXd waveform = Eigen::VectorXd::Zero(samples);
  const int pulses = 1 + below(8);
  int position = below(samples);
  for (int edge = 0; edge < 2 * pulses; ++edge) {
    const int length = 1 + below(std::max(1, samples / pulses));
    for (int i = 0; i < length; ++i) waveform[(position + i) % samples] = edge % 2 == 0 ? 1 : 0;
    position += length;
  }
  if (kind.band_limited) {
    const int width = std::max(3, static_cast<int>(samples * (0.04 + 0.1 * random.uniform())));
    waveform = smoothed(smoothed(waveform, width), width);
  }
  problem.kernel = waveform / samples;
  problem.target = trapezoid_target(samples, below(2) == 0 ? 1.0 / 6 : 1.0 / 30);
  if (below(2) == 0)
    for (double& value : problem.target) value += 0.02 * random.normal();
  problem.total_variation_weight = kind.weight_per_sample * samples;
  constexpr double peaks[] = {1, 2, 4, 8, 15, 30};
  problem.upper_bound = peaks[below(6)];
  if (problem.upper_bound > 1) problem.budget = samples;
  return problem;
}

}  // namespace tofsmith::test

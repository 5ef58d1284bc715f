// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/code/families.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "code/shared/family_rules.hpp"

namespace tofsmith {

void FamilyOptions::validate() const { require(options_misfit(*this)); }

CodeSet multi_frequency_code(const std::vector<FrequencySteps>& frequencies,
                             const FamilyOptions& options) {
  require(multi_frequency_misfit(frequencies, options));
  const double depth_of_modulation = std::min(1.0, options.peak_factor - 1.0);
  const int count = options.samples;
  const auto cosine = [count](int frequency, double phase, double mean, double amplitude) {
    Eigen::VectorXd samples(count);
    for (int n = 0; n < count; ++n) {
      // The middle of the cell, so that the sampled cosine has the phase of the continuous one.
      const double turn = 2 * std::numbers::pi * frequency * (n + 0.5) / count;
      samples[n] = mean + amplitude * std::cos(turn - phase);
    }
    return Waveform::sampled(samples.cwiseMax(0.0));
  };
  std::vector<Waveform> modulation, demodulation;
  std::string name = "multifrequency";
  for (const auto& [frequency, steps] : frequencies) {
    name += fmt::format("-{}x{}", frequency, steps);
    for (int step = 0; step < steps; ++step) {
      const double phase = 2 * std::numbers::pi * step / (steps == 2 ? 4 : steps);
      modulation.push_back(cosine(frequency, 0.0, 1.0, depth_of_modulation));
      demodulation.push_back(cosine(frequency, phase, 0.5, 0.5));
    }
  }
  return CodeSet::create(name, count, 1, std::move(modulation), std::move(demodulation));
}

CodeSet sinusoid_code(int phase_steps, const FamilyOptions& options) {
  return multi_frequency_code({{1, phase_steps}}, options)
      .renamed(fmt::format("sinusoid-k{}", phase_steps));
}

}  // namespace tofsmith

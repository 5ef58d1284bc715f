// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/descent.hpp"

#include <algorithm>
#include <cmath>

#include "design/adam.hpp"
#include "design/stochastic_gradient.hpp"

namespace tofsmith {

namespace {

Sharpness sharpness_at(const DescentSchedule& schedule, double done) {
  const double along = std::max(0.0, (done - schedule.soft_share) / (1.0 - schedule.soft_share));
  return {std::pow(schedule.final_sharpness.modulation, along),
          std::pow(schedule.final_sharpness.demodulation, along)};
}

}  // namespace

namespace {
// Of streams whose other trials are steps.
constexpr std::uint32_t noise_in_store = 0xffffffffu;
}  // namespace

WaveformParameters descend(const DesignProblem& problem, WaveformParameters parameters,
                           const DescentSchedule& schedule, std::uint64_t seed,
                           std::uint64_t work_item, SharedProgress* progress) {
  constexpr double largest_modulation = 4.0, largest_demodulation = 3.0;
  StochasticGradient objective(problem, schedule.trials_per_step,
                               RandomStream(seed, work_item, noise_in_store));
  Adam modulation, demodulation;
  for (int step = 0; step < schedule.steps; ++step) {
    if (progress) progress->add();
    const double done = static_cast<double>(step) / schedule.steps;
    const Sharpness sharpness = sharpness_at(schedule, done);
    const double doubt =
        schedule.doubt_begin * std::pow(schedule.doubt_end / schedule.doubt_begin, done);
    RandomStream random(seed, work_item, static_cast<std::uint32_t>(step));
    const SampledCode code = render(problem.space, parameters, sharpness);
    const WaveformParameters gradient =
        pull_back(problem.space, code, sharpness, objective.at(code, doubt, random));
    // Sharper waveforms move further with the same parameters.
    const double rate = schedule.rate * (done < 0.7 ? 1.0 : std::max(0.05, (1.0 - done) / 0.3));
    modulation.step(parameters.modulation, gradient.modulation,
                    rate / std::sqrt(sharpness.modulation));
    demodulation.step(parameters.demodulation, gradient.demodulation,
                      rate / std::sqrt(sharpness.demodulation));
    parameters.modulation =
        parameters.modulation.cwiseMax(-largest_modulation).cwiseMin(largest_modulation);
    parameters.demodulation =
        parameters.demodulation.cwiseMax(-largest_demodulation).cwiseMin(largest_demodulation);
  }
  return parameters;
}

}  // namespace tofsmith

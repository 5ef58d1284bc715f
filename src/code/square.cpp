// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "code/shared/family_members.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "code/shared/on_intervals.hpp"

namespace tofsmith {

CodeSet square_code(int phase_steps, const FamilyOptions& options) {
  require(square_misfit(phase_steps, options));
  // Taps that share an exposure split the period; light is on for half of it, even if the peak
  // factor then limits its mean to less than 1.
  const bool shared = options.taps > 2;
  const double open = shared ? 1.0 / options.taps : 0.5;
  const Waveform light = shared ? Waveform::binary({{0.0, 0.5}}, std::min(2.0, options.peak_factor))
                                : rectangular_pulse(std::max(0.5, 1.0 / options.peak_factor));
  std::vector<Waveform> demodulation;
  for (const int step : steps_by_tap(phase_steps, options.taps)) {
    const double rise = static_cast<double>(step) / phase_steps;
    demodulation.push_back(Waveform::binary(within_period({{rise, rise + open}})));
  }
  const auto exposures = static_cast<std::size_t>(phase_steps / options.taps);
  return CodeSet::create(fmt::format("square-k{}", phase_steps), options.samples, options.taps,
                         std::vector<Waveform>(exposures, light), std::move(demodulation));
}

CodeSet pulsed_multi_frequency_code(int low_steps, int high_frequency,
                                    const FamilyOptions& options) {
  require(pulsed_multi_frequency_misfit(low_steps, high_frequency, options));
  // Quadrature or thirds of a period, with the shortest usable pulses.
  const double low_step = low_steps == 2 ? 1.0 / 4.0 : 1.0 / 3.0;
  const double low_pulse = low_steps == 2 ? 1.0 / 4.0 : 1.0 / 6.0;
  const double low_duty = std::max(1.0 / options.peak_factor, low_pulse);
  const double high_duty = std::max(1.0 / options.peak_factor, 1.0 / 4.0);
  std::vector<Waveform> modulation, demodulation;
  for (int step = 0; step < low_steps; ++step) {
    modulation.push_back(pulse_train(1, low_duty));
    demodulation.push_back(square_wave(1, step * low_step));
  }
  for (int step = 0; step < 2; ++step) {
    modulation.push_back(pulse_train(high_frequency, high_duty));
    demodulation.push_back(square_wave(high_frequency, 0.25 * step / high_frequency));
  }
  return CodeSet::create(pulsed_multi_frequency_name(low_steps, high_frequency), options.samples, 1,
                         std::move(modulation), std::move(demodulation));
}

namespace {

/// Returns pulses at `frequency` in about the first half of the period, or one pulse if the peak
/// factor requires light for the whole half or longer.
Waveform burst(int frequency, double peak_factor) {
  const int pulses = (frequency + 1) / 2;
  const double share = static_cast<double>(pulses) / frequency;  // of the period
  const double duty = std::max(1.0 / (peak_factor * share), 0.25);
  if (duty >= 1.0) return rectangular_pulse(std::max(share, 1.0 / peak_factor));
  std::vector<OnInterval> on;
  for (int m = 0; m < pulses; ++m)
    on.push_back({static_cast<double>(m) / frequency, (m + duty) / frequency});
  return Waveform::binary(std::move(on), 1.0 / (share * duty));
}

}  // namespace

CodeSet burst_code(int high_frequency, const FamilyOptions& options) {
  require(pulsed_multi_frequency_misfit(3, high_frequency, options));
  std::vector<Waveform> demodulation;
  for (int step = 0; step < 3; ++step) demodulation.push_back(square_wave(1, step / 3.0));
  for (int step = 0; step < 2; ++step)
    demodulation.push_back(square_wave(high_frequency, 0.25 * step / high_frequency));
  return CodeSet::create(fmt::format("burst-k5-q{}", high_frequency), options.samples, 1,
                         std::vector<Waveform>(5, burst(high_frequency, options.peak_factor)),
                         std::move(demodulation));
}

CodeSet gray_code(int bits, const FamilyOptions& options) {
  require(gray_misfit(bits, options));
  const int cells = 1 << bits;
  const double duty = std::max(1.0 / options.peak_factor, 1.0 / cells);
  std::vector<Waveform> modulation, demodulation;
  for (int bit = bits - 1; bit >= 0; --bit) {
    Eigen::VectorXd word(cells);
    for (int cell = 0; cell < cells; ++cell) word[cell] = ((cell ^ (cell >> 1)) >> bit) & 1;
    modulation.push_back(rectangular_pulse(duty));
    demodulation.push_back(Waveform::binary_from_samples(word, 1.0));
  }
  return CodeSet::create(fmt::format("gray-k{}", bits), options.samples, 1, std::move(modulation),
                         std::move(demodulation));
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/frequencies/square_code.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tofsmith {

int SquareCode::exposures() const {
  int sum = 0;
  for (const SquareTone& tone : tones) sum += tone.phases;
  return sum;
}

int SquareCode::repetitions() const {
  int common = 0;
  for (const SquareTone& tone : tones) common = std::gcd(common, tone.frequency);
  return common;
}

std::string SquareCode::name() const {
  std::string name = "square";
  for (const SquareTone& tone : tones) name += fmt::format("-{}x{}", tone.frequency, tone.phases);
  return name;
}

std::vector<int> phases_in_steps(int phases, int phase_steps) {
  const double spacing = phases == 2 ? 0.25 : 1.0 / phases;
  std::vector<int> steps;
  for (int i = 0; i < phases; ++i)
    steps.push_back(static_cast<int>(std::lround(i * spacing * phase_steps)));
  return steps;
}

double square_level(double duty, double peak_factor) { return std::min(1.0 / duty, peak_factor); }

namespace {

Waveform square_light(const SquareTone& tone, double duty, double peak_factor) {
  std::vector<OnInterval> on;
  for (int i = 0; i < tone.frequency; ++i)
    on.push_back({static_cast<double>(i) / tone.frequency, (i + duty) / tone.frequency});
  return Waveform::binary(std::move(on), square_level(duty, peak_factor));
}

}  // namespace

CodeSet to_code_set(const SquareCode& code, const Camera& camera) {
  const int phase_steps = camera.light.square->phase_steps;
  std::vector<Waveform> modulation, demodulation;
  std::vector<double> shares;
  for (const SquareTone& tone : code.tones) {
    const Waveform light = square_light(tone, code.duty, camera.light.peak_factor);
    for (const int step : phases_in_steps(tone.phases, phase_steps)) {
      modulation.push_back(light);
      demodulation.push_back(
          square_wave(tone.frequency, static_cast<double>(step) / phase_steps / tone.frequency));
      shares.push_back(tone.share / tone.phases);
    }
  }
  const CodeSet one_tap = CodeSet::create(code.name(), camera.samples, 1, std::move(modulation),
                                          std::move(demodulation))
                              .with_exposure_shares(std::move(shares));
  if (camera.sensor.is_signed()) return one_tap.with_signed_weights();
  return camera.sensor.taps == 2 ? one_tap.with_two_buckets() : one_tap;
}

}  // namespace tofsmith

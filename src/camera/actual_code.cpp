// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "camera/shared/actual_code.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/shared/periodic.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

Waveform scaled(const Waveform& waveform, double factor) {
  return waveform.is_binary() ? Waveform::binary(waveform.on_intervals(), factor * waveform.level())
                              : waveform.scaled(0.0, factor);
}

void apply(const Playback& playback, int taps, ActualCode& actual) {
  const ActualCode said = actual;
  for (std::size_t e = 0; e < playback.order.size(); ++e) {
    const auto from = static_cast<std::size_t>(playback.order[e]), side = std::size_t(taps);
    actual.modulation[e] = said.modulation[from];
    for (std::size_t t = 0; t < side; ++t)
      actual.demodulation[e * side + t] = said.demodulation[from * side + t];
  }
  if (!playback.inverted) return;
  for (std::size_t i = 0; i < actual.demodulation.size(); ++i)
    if (taps == 1)
      actual.demodulation[i] = actual.demodulation[i].complement();
    else if (i % 2 == 1)
      std::swap(actual.demodulation[i - 1], actual.demodulation[i]);
}

/// Returns the error if the generator outputs no pulse of modulation e, whose output is `points`.
std::optional<BrokenRule> lost_pulse(const CodeSet& code, int e, const Waveform& points,
                                     const Generator& generator, double frequency_hz) {
  const Waveform& nominal = code.modulation(e);
  if (points.mean() > 0.0 || nominal.mean() == 0.0) return std::nullopt;
  // One point must be no longer than the mean pulse.
  const double pulses = std::max(1.0, 0.5 * nominal.edges());
  const double needed = std::ceil(pulses / nominal.duty() * (1.0 - 1e-9));
  return broken(
      fmt::format("code {} modulation {} duty", code.name(), e), nominal.duty(),
      fmt::format("has no pulse that light.generator can output: its points are 1/{} of a period; "
                  "expected {:.0f} points or more, {:.4g} MHz",
                  generator.points_per_period(frequency_hz), needed, 1e-6 * needed * frequency_hz));
}

}  // namespace

double average_power_scale(const Waveform& modulation) {
  return 1.0 / std::max(1.0, modulation.mean());
}

Waveform at_average_power(const Waveform& modulation) {
  const double scale = average_power_scale(modulation);
  return scale < 1.0 ? scaled(modulation, scale) : modulation;
}

bool taps_share_a_generator(const CodeSet& code, const Camera& camera) {
  return code.taps() == 2 && !camera.sensor.drain;
}

std::optional<BrokenRule> pulse_not_generated(const CodeSet& code, const Camera& camera) {
  if (!camera.light.generator) return std::nullopt;
  const Generator& generator = *camera.light.generator;
  const double frequency_hz = camera.fundamental_frequency_hz;
  for (int e = 0; e < code.exposures(); ++e)
    if (auto lost = lost_pulse(code, e, generated(code.modulation(e), generator, frequency_hz),
                               generator, frequency_hz))
      return lost;
  return std::nullopt;
}

ActualCode actual_code(const CodeSet& code, const Camera& camera) {
  const double frequency_hz = camera.fundamental_frequency_hz;
  ActualCode actual;
  for (int e = 0; e < code.exposures(); ++e) {
    const Waveform& nominal = code.modulation(e);
    if (!camera.light.generator) {
      actual.modulation.push_back(nominal);
      continue;
    }
    const Waveform points = generated(nominal, *camera.light.generator, frequency_hz);
    require(lost_pulse(code, e, points, *camera.light.generator, frequency_hz));
    actual.modulation.push_back(at_average_power(points));
  }
  for (int i = 0; i < code.measurements(); ++i) {
    if (!camera.sensor.generator)
      actual.demodulation.push_back(code.demodulation(i));
    else if (taps_share_a_generator(code, camera) && i % 2 == 1)
      actual.demodulation.push_back(actual.demodulation.back().complement());
    else
      actual.demodulation.push_back(
          generated(code.demodulation(i), *camera.sensor.generator, frequency_hz));
  }
  if (camera.playback) apply(*camera.playback, code.taps(), actual);
  return actual;
}

Eigen::VectorXd arm_output(const Waveform& waveform, const ImpulseResponse& response,
                           double fundamental_frequency_hz, int points) {
  require(points >= 2, "points", points, "must be >= 2");
  if (response.kind == ImpulseResponse::Kind::none) return waveform.cell_averages(points);
  const PeriodicTransform transform(points);
  Eigen::VectorXcd spectrum = waveform.harmonics(transform.coefficients() - 1);
  for (Eigen::Index n = 0; n < spectrum.size(); ++n)
    spectrum[n] *= static_cast<double>(points) *
                   response.transfer(static_cast<double>(n) * fundamental_frequency_hz);
  Eigen::VectorXd samples;
  transform.inverse(spectrum, samples);
  return samples;
}

}  // namespace tofsmith

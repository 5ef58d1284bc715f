// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/camera/played_code.hpp"

#include <fmt/format.h>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

Waveform scaled(const Waveform& waveform, double factor) {
  return waveform.is_binary() ? Waveform::binary(waveform.on_intervals(), factor * waveform.level())
                              : Waveform::sampled(factor * waveform.samples());
}

Waveform within_average_power(const Waveform& modulation) {
  const double mean = modulation.mean();
  return mean > 1.0 ? scaled(modulation, 1.0 / mean) : modulation;
}

}  // namespace

bool taps_share_a_generator(const CodeSet& code, const Camera& camera) {
  return code.taps() == 2 && !camera.sensor.drain;
}

PlayedCode played_code(const CodeSet& code, const Camera& camera) {
  const double frequency_hz = camera.fundamental_frequency_hz;
  PlayedCode played;
  for (int e = 0; e < code.exposures(); ++e) {
    const Waveform& told = code.modulation(e);
    if (!camera.light.generator) {
      played.modulation.push_back(told);
      continue;
    }
    const Waveform points = generated(told, *camera.light.generator, frequency_hz);
    require(points.mean() > 0.0 || told.mean() == 0.0,
            fmt::format("code {} modulation {} duty", code.name(), e), told.duty(),
            fmt::format("has no pulse that light.generator can play: its points are 1/{} of a "
                        "period",
                        camera.light.generator->points_per_period(frequency_hz)));
    played.modulation.push_back(within_average_power(points));
  }
  for (int i = 0; i < code.measurements(); ++i) {
    if (!camera.sensor.generator)
      played.demodulation.push_back(code.demodulation(i));
    else if (taps_share_a_generator(code, camera) && i % 2 == 1)
      played.demodulation.push_back(played.demodulation.back().complement());
    else
      played.demodulation.push_back(
          generated(code.demodulation(i), *camera.sensor.generator, frequency_hz));
  }
  return played;
}

}  // namespace tofsmith

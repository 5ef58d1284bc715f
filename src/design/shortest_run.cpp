// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/shortest_run.hpp"

namespace tofsmith {

double shortest_run_periods(const Camera& camera) {
  return camera.sensor.shortest_pulse_s.value_or(0.0) * camera.fundamental_frequency_hz;
}

bool keeps_shortest_run(const Waveform& waveform, double shortest_run) {
  if (!waveform.is_binary()) return true;
  const std::vector<OnInterval>& on = waveform.on_intervals();
  for (std::size_t i = 0; i < on.size(); ++i) {
    const double next = i + 1 < on.size() ? on[i + 1].rise : on[0].rise + 1.0;
    const double gap = next - on[i].fall;
    constexpr double rounding = 1e-9;
    if (on[i].fall - on[i].rise < shortest_run - rounding) return false;
    if (gap > rounding && gap < shortest_run - rounding) return false;
  }
  return true;
}

bool keeps_shortest_run(const CodeSet& code, const Camera& camera) {
  const double shortest_run = shortest_run_periods(camera);
  for (int i = 0; i < code.measurements(); ++i)
    if (!keeps_shortest_run(code.modulation_of(i), shortest_run) ||
        !keeps_shortest_run(code.demodulation(i), shortest_run))
      return false;
  return true;
}

}  // namespace tofsmith

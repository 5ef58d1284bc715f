// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "code/shared/ramp.hpp"

#include <algorithm>

namespace tofsmith {

namespace {
// A ramp requires a pulse that is short compared with the period.
constexpr double shortest_duty = 1.0 / 60.0;

Waveform rising_ramp(int samples) {
  Eigen::VectorXd ramp(samples);
  for (int n = 0; n < samples; ++n) ramp[n] = (n + 0.5) / samples;
  return Waveform::sampled(std::move(ramp));
}

CodeSet with_background(const char* name, Waveform first, Waveform second,
                        const FamilyOptions& options) {
  const Waveform pulse = rectangular_pulse(std::max(1.0 / options.peak_factor, shortest_duty));
  const Waveform light_off = Waveform::constant(0.0);
  return CodeSet::create(name, options.samples, 1, {pulse, pulse, light_off},
                         {std::move(first), std::move(second), Waveform::constant(1.0)});
}
}  // namespace

CodeSet single_ramp_code(const FamilyOptions& options) {
  options.validate();
  return with_background("single-ramp-k3", rising_ramp(options.samples), Waveform::constant(1.0),
                         options);
}

CodeSet double_ramp_code(const FamilyOptions& options) {
  options.validate();
  const Waveform ramp = rising_ramp(options.samples);
  return with_background("double-ramp-k3", ramp, ramp.complement(), options);
}

}  // namespace tofsmith

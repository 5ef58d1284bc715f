// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "code/shared/on_intervals.hpp"

#include <algorithm>

#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {

constexpr double rounding = 1e-12;

bool overlap(const OnInterval& first, const OnInterval& second) {
  return second.rise <= first.fall + rounding;
}

/// Merges the interval with the last ones that it overlaps.
void append(OnInterval next, std::vector<OnInterval>& on) {
  for (; !on.empty() && overlap(on.back(), next); on.pop_back())
    next = {std::min(on.back().rise, next.rise), std::max(on.back().fall, next.fall)};
  on.push_back(next);
}

}  // namespace

std::vector<OnInterval> within_period(std::vector<OnInterval> on) {
  for (OnInterval& interval : on) {
    if (interval.rise >= 0.0 && interval.rise < 1.0) continue;
    const double length = interval.fall - interval.rise;
    interval.rise = wrap(interval.rise, 1.0);
    interval.fall = interval.rise + length;
  }
  std::sort(on.begin(), on.end(),
            [](const OnInterval& a, const OnInterval& b) { return a.rise < b.rise; });
  for (std::size_t i = 0; i < on.size(); ++i) {
    const bool last = i + 1 == on.size();
    const double next_rise = last ? on[0].rise + 1.0 : on[i + 1].rise;
    if (on[i].fall > next_rise && on[i].fall < next_rise + rounding) on[i].fall = next_rise;
  }
  std::erase_if(on, [](const OnInterval& interval) { return !(interval.rise < interval.fall); });
  return on;
}

std::vector<OnInterval> stretched(const std::vector<OnInterval>& on, double factor) {
  std::vector<OnInterval> longer;
  for (const OnInterval& interval : on) {
    const double centre = 0.5 * (interval.rise + interval.fall);
    const double half = 0.5 * factor * (interval.fall - interval.rise);
    append({centre - half, centre + half}, longer);
  }
  // The last interval may overlap the first ones of the next period.
  while (longer.size() > 1) {
    const OnInterval first{longer.front().rise + 1.0, longer.front().fall + 1.0};
    if (!overlap(longer.back(), first)) break;
    longer.erase(longer.begin());
    append(first, longer);
  }
  if (longer.front().fall - longer.front().rise >= 1.0 - rounding) return {{0.0, 1.0}};
  return within_period(std::move(longer));
}

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

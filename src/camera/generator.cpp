// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/camera/generator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

// Switching times that a grid was meant to hold are off it by rounding only [points].
constexpr double rounding = 1e-9;
constexpr double most_points = 1 << 20;  // far more than any code's detail

/// First point of a pulse and the first behind it.
struct Pulse {
  double begin, end;
};

/// The pulses that are left, sorted, with a gap between any two.
std::vector<Pulse> pulses_on_points(const std::vector<OnInterval>& on, double points) {
  std::vector<Pulse> pulses;
  for (const OnInterval& interval : on) {
    Pulse pulse{nearest_point(interval.rise, points), nearest_point(interval.fall, points)};
    if (pulse.begin == pulse.end) continue;  // the middle of no point lies within
    if (pulse.begin == points) pulse = {0.0, pulse.end - points};
    pulses.push_back(pulse);
  }
  const auto earlier = [](const Pulse& a, const Pulse& b) { return a.begin < b.begin; };
  std::sort(pulses.begin(), pulses.end(), earlier);
  std::vector<Pulse> apart;
  for (const Pulse& pulse : pulses) {
    if (!apart.empty() && apart.back().end == pulse.begin)
      apart.back().end = pulse.end;
    else
      apart.push_back(pulse);
  }
  if (apart.size() > 1 && apart.back().end == apart.front().begin + points) {
    apart.back().end = apart.front().end + points;
    apart.erase(apart.begin());
  }
  return apart;
}

Waveform on_points(const Waveform& waveform, int points) {
  std::vector<OnInterval> on;
  for (const Pulse& pulse : pulses_on_points(waveform.on_intervals(), points)) {
    if (pulse.end - pulse.begin == points) return Waveform::constant(waveform.level());
    on.push_back({pulse.begin / points, pulse.end / points});
  }
  return Waveform::binary(std::move(on), waveform.level());
}

}  // namespace

int Generator::points_per_period(double fundamental_frequency_hz) const {
  return static_cast<int>(std::floor(sample_rate_hz / fundamental_frequency_hz * (1 + 1e-12)));
}

void Generator::validate(std::string_view field, double fundamental_frequency_hz) const {
  const std::string prefix = std::string(field) + ".";
  require(std::isfinite(sample_rate_hz) && sample_rate_hz > 0.0, prefix + "sample_rate_hz",
          sample_rate_hz, "must be finite and > 0");
  require(amplitude_bits >= 1 && amplitude_bits <= 24, prefix + "amplitude_bits", amplitude_bits,
          "must be in [1, 24]");
  const double points = sample_rate_hz / fundamental_frequency_hz * (1 + 1e-12);
  require(points >= 2.0 && points <= most_points, prefix + "sample_rate_hz", sample_rate_hz,
          fmt::format("must give 2 .. {:.0f} points per period at fundamental_frequency_hz = {}",
                      most_points, fundamental_frequency_hz));
}

double nearest_point(double switching_time_periods, double points_per_period) {
  // The first point whose middle is not before the switching time.
  return std::ceil(switching_time_periods * points_per_period - 0.5 - rounding);
}

Waveform generated(const Waveform& waveform, const Generator& generator,
                   double fundamental_frequency_hz) {
  generator.validate("generator", fundamental_frequency_hz);
  require(waveform.minimum() >= -1e-9, "waveform minimum", waveform.minimum(),
          "must be >= 0: a generator's levels run from 0 to the peak");
  const int points = generator.points_per_period(fundamental_frequency_hz);
  if (waveform.is_binary()) return on_points(waveform, points);

  const double peak = waveform.peak();
  const double step = peak / (std::exp2(generator.amplitude_bits) - 1.0);
  const Eigen::VectorXd& told = waveform.samples();
  Eigen::VectorXd played(points);
  for (int j = 0; j < points; ++j) {
    const double middle = (j + 0.5) / points * static_cast<double>(told.size());
    const double value = told[static_cast<Eigen::Index>(middle + rounding)];
    played[j] = peak > 0.0 ? std::min(peak, std::max(0.0, std::round(value / step) * step)) : 0.0;
  }
  return Waveform::sampled(std::move(played));
}

}  // namespace tofsmith

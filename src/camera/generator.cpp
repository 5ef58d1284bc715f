// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/camera/camera.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "camera/shared/actual_code.hpp"
#include "tofsmith/camera/generator_report.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

// Rounding error of switching times that lie on a grid [points].
constexpr double rounding = 1e-9;
constexpr double max_points = 1 << 20;  // more than the detail of any code

/// First point, and first point after the pulse.
struct Pulse {
  double begin, end;
};

/// Pulses that do not vanish, sorted, with adjacent pulses merged.
std::vector<Pulse> pulses_on_points(const std::vector<OnInterval>& on, double points) {
  std::vector<Pulse> pulses;
  for (const OnInterval& interval : on) {
    Pulse pulse{nearest_point(interval.rise, points), nearest_point(interval.fall, points)};
    if (pulse.begin == pulse.end) continue;  // contains no middle of a point
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

Eigen::VectorXd rounded_amplitudes(Eigen::VectorXd values, double peak, int bits) {
  const double step = peak / (std::exp2(bits) - 1.0);
  for (double& value : values)
    value = peak > 0.0 ? std::min(peak, std::max(0.0, std::round(value / step) * step)) : 0.0;
  return values;
}

double max_points_per_period(double sample_rate_hz, double frequency_hz) {
  return sample_rate_hz / frequency_hz * (1 + 1e-12);
}

/// Steps of an edge grid per period, an integer for valid generators.
double grid_steps(double edge_grid_s, double frequency_hz) {
  return std::round(1.0 / (edge_grid_s * frequency_hz));
}

void validate_edge_grid(const std::string& field, double edge_grid_s, double frequency_hz) {
  const double steps = 1.0 / (edge_grid_s * frequency_hz);
  require(steps >= 2.0 - 1e-6 && steps <= max_points && std::abs(steps - std::round(steps)) <= 1e-6,
          field, edge_grid_s,
          fmt::format("must divide the period of fundamental_frequency_hz = {} into 2 to {:.0f} "
                      "integer steps{}",
                      frequency_hz, max_points,
                      steps >= 2.0 && steps <= max_points
                          ? fmt::format(" (it gives {:.6g}; {:.9g} s would give {:.0f})", steps,
                                        1.0 / (std::round(steps) * frequency_hz), std::round(steps))
                          : ""));
}

}  // namespace

int Generator::points_per_period(double fundamental_frequency_hz) const {
  const double most = max_points_per_period(sample_rate_hz, fundamental_frequency_hz);
  return table_points && *table_points <= most ? *table_points : static_cast<int>(std::floor(most));
}

int Generator::points_in_table(double fundamental_frequency_hz) const {
  return table_points.value_or(points_per_period(fundamental_frequency_hz));
}

void Generator::validate(std::string_view field, double fundamental_frequency_hz) const {
  const std::string prefix = std::string(field) + ".";
  check_ranges(*this, prefix);
  const double points = max_points_per_period(sample_rate_hz, fundamental_frequency_hz);
  require(points >= 2.0 && (table_points || points <= max_points), prefix + "sample_rate_hz",
          sample_rate_hz,
          fmt::format("must give 2 to {:.0f} points per period at fundamental_frequency_hz = {}",
                      max_points, fundamental_frequency_hz));
  if (edge_grid_s)
    validate_edge_grid(prefix + "edge_grid_s", *edge_grid_s, fundamental_frequency_hz);
}

double nearest_point(double switching_time_periods, double points_per_period) {
  // First point whose middle is at or after the switching time.
  return std::ceil(switching_time_periods * points_per_period - 0.5 - rounding);
}

double generated_switching_time(double switching_time_periods, const Generator& generator,
                                double fundamental_frequency_hz) {
  const auto moved_to = [&](double steps) {
    switching_time_periods = nearest_point(switching_time_periods, steps) / steps;
  };
  if (generator.edge_grid_s) moved_to(grid_steps(*generator.edge_grid_s, fundamental_frequency_hz));
  const int table = generator.points_in_table(fundamental_frequency_hz),
            actual_points = generator.points_per_period(fundamental_frequency_hz);
  moved_to(table);
  if (actual_points != table) moved_to(actual_points);
  return switching_time_periods;
}

bool plays_alike_rotated(const Camera& camera, int samples, int rotation_bin) {
  if (!camera.light.generator) return true;
  constexpr double tolerance_bin = 1.0 / 16;
  const Generator& generator = *camera.light.generator;
  const double f0_hz = camera.fundamental_frequency_hz;
  const auto whole = [&](double points) {
    const double moved = points * rotation_bin / samples;
    return std::abs(moved - std::round(moved)) * samples / points <= tolerance_bin;
  };
  return (!generator.edge_grid_s || whole(grid_steps(*generator.edge_grid_s, f0_hz))) &&
         whole(generator.points_in_table(f0_hz)) && whole(generator.points_per_period(f0_hz));
}

Waveform generator_table(const Waveform& waveform, const Generator& generator,
                         double fundamental_frequency_hz) {
  generator.validate("generator", fundamental_frequency_hz);
  require(waveform.minimum() >= -1e-9, "waveform minimum", waveform.minimum(),
          "must be >= 0: the levels of a generator range from 0 to the peak");
  const int points = generator.points_in_table(fundamental_frequency_hz);
  if (!waveform.is_binary())
    return Waveform::sampled(rounded_amplitudes(waveform.values_at_middles(points), waveform.peak(),
                                                generator.amplitude_bits));
  if (!generator.edge_grid_s) return on_points(waveform, points);
  const double steps = grid_steps(*generator.edge_grid_s, fundamental_frequency_hz);
  return on_points(on_points(waveform, static_cast<int>(steps)), points);
}

Waveform generated(const Waveform& waveform, const Generator& generator,
                   double fundamental_frequency_hz) {
  Waveform table = generator_table(waveform, generator, fundamental_frequency_hz);
  const int actual_points = generator.points_per_period(fundamental_frequency_hz);
  if (actual_points == generator.points_in_table(fundamental_frequency_hz)) return table;
  return table.is_binary() ? on_points(table, actual_points)
                           : Waveform::sampled(table.values_at_middles(actual_points));
}

namespace {

class Steps {
 public:
  explicit Steps(const Waveform& waveform) : function_(waveform.steps()) {}
  double end() const {
    return next_ + 1 < function_.breakpoints.size() ? function_.breakpoints[next_ + 1] : 1.0;
  }
  double value() const { return function_.values[next_]; }
  void advance_to(double position) {
    while (next_ + 1 < function_.breakpoints.size() && end() <= position) ++next_;
  }

 private:
  StepFunction function_;
  std::size_t next_ = 0;
};

double rms_difference(const Waveform& a, const Waveform& b) {
  Steps steps_a(a), steps_b(b);
  double sum = 0.0;
  for (double position = 0.0; position < 1.0;) {
    const double end = std::min(steps_a.end(), steps_b.end());
    const double difference = steps_a.value() - steps_b.value();
    sum += difference * difference * (end - position);
    position = end;
    steps_a.advance_to(position);
    steps_b.advance_to(position);
  }
  return std::sqrt(sum);
}

double largest_edge_move_periods(const Waveform& nominal, const Generator& generator,
                                 double frequency_hz) {
  double largest = 0.0;
  for (const OnInterval& on : nominal.on_intervals())
    for (const double edge : {on.rise, on.fall})
      largest = std::max(largest,
                         std::abs(generated_switching_time(edge, generator, frequency_hz) - edge));
  return largest;
}

GeneratorReport compare(Arm arm, int index, const Waveform& nominal, const Waveform& actual,
                        const Generator& generator, double frequency_hz) {
  GeneratorReport report{.arm = arm, .index = index};
  report.points_per_period = generator.points_per_period(frequency_hz);
  report.clock_hz = report.points_per_period * frequency_hz;
  report.duty_nominal = nominal.duty();
  report.duty_actual = actual.duty();
  report.mean_nominal = nominal.mean();
  report.mean_actual = actual.mean();
  report.peak_nominal = nominal.peak();
  report.peak_actual = actual.peak();
  report.edges_nominal = nominal.edges();
  report.edges_actual = actual.edges();
  if (nominal.is_binary())
    report.largest_edge_move_s =
        largest_edge_move_periods(nominal, generator, frequency_hz) / frequency_hz;
  report.rms_difference = rms_difference(nominal, actual);
  return report;
}

}  // namespace

std::vector<GeneratorReport> generator_report(const CodeSet& code, const Camera& camera) {
  camera.validate();
  require_fits(code, camera);
  const ActualCode actual = actual_code(code, camera);
  const double frequency_hz = camera.fundamental_frequency_hz;
  std::vector<GeneratorReport> reports;
  for (int e = 0; camera.light.generator && e < code.exposures(); ++e)
    reports.push_back(compare(Arm::light, e, code.modulation(e),
                              actual.modulation[static_cast<std::size_t>(e)],
                              *camera.light.generator, frequency_hz));
  const int step = taps_share_a_generator(code, camera) ? 2 : 1;
  for (int i = 0; camera.sensor.generator && i < code.measurements(); i += step)
    reports.push_back(compare(Arm::sensor, i, code.demodulation(i),
                              actual.demodulation[static_cast<std::size_t>(i)],
                              *camera.sensor.generator, frequency_hz));
  return reports;
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/camera/generator_report.hpp"

#include <algorithm>
#include <cmath>

#include "camera/shared/actual_code.hpp"

namespace tofsmith {

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

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "paper/prototype_bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "camera/shared/prototype.hpp"
#include "report/shared/level_text.hpp"
#include "tofsmith/camera/generator_report.hpp"

namespace tofsmith {

namespace {

constexpr double bench_ambient_e_per_s = 1e3;

// Ten times the power of Table 1's first line as we have it: behind O.D. 3, 1 mW leaves no code
// anything to measure at 1 m and beyond.
const PrototypeSetting& setting() {
  static const PrototypeSetting value{.name = "prototype-10mw", .average_source_power_mw = 10.0};
  return value;
}

std::vector<std::string> actual_row(const CodeSet& code, const Camera& camera) {
  double edge_move_s = 0.0, duty_change = 0.0;
  int points = 0;
  for (const GeneratorReport& report : generator_report(code, camera)) {
    points = report.points_per_period;
    edge_move_s = std::max(edge_move_s, report.largest_edge_move_s.value_or(0.0));
    duty_change = std::max(duty_change, std::abs(report.duty_actual - report.duty_nominal));
  }
  return {code.name(),
          fmt::format("{}", code.exposures()),
          fmt::format("{:.2f}", code.peak()),
          fmt::format("{}", points),
          fmt::format("{:.2f}", 1e9 * edge_move_s),
          fmt::format("{:.2f}", 100 * duty_change)};
}

}  // namespace

const std::vector<double>& PrototypeBench::optical_densities() {
  static const std::vector<double> densities = {1.0, 2.0, 3.0};
  return densities;
}

OperatingPoint PrototypeBench::light(double optical_density) {
  return attenuated(
      {setting().signal_at_od0_e_per_s * setting().average_source_power_mw, bench_ambient_e_per_s},
      optical_density);
}

Section PrototypeBench::section(const std::string& scan) const {
  Table actual{.id = "actual",
               .caption =
                   "What the generators make of each code: peak over average power, points per "
                   "period, and how far edges and duties move at most.",
               .columns = {{"code"},
                           {"exposures", true},
                           {"peak", true},
                           {"points", true},
                           {"edge move (ns)", true},
                           {"duty change (%)", true}}};
  for (const CodeSet& code : codes) actual.rows.push_back(actual_row(code, camera));
  return {"The scan",
          {Paragraph{scan},
           KeyValueList{
               {{"fundamental frequency", "5 MHz: a range of 30 m"},
                {"source", fmt::format("p = {:g}, {:g} mW on average; S = {} e/s without filter "
                                       "from albedo 1 at 1 m",
                                       camera.light.peak_factor, setting().average_source_power_mw,
                                       level_text(light(0.0).signal_e_per_s))},
                {"behind O.D. 1, 2, 3",
                 fmt::format("S = {}, {}, {} e/s", level_text(light(1.0).signal_e_per_s),
                             level_text(light(2.0).signal_e_per_s),
                             level_text(light(3.0).signal_e_per_s))},
                {"ambient light", fmt::format("A = {} e/s", level_text(bench_ambient_e_per_s))},
                {"generators", "500 MS/s, 14 bits, 150 MHz, one on each arm"},
                {"exposure", "300 ms per estimate in all; read noise 20 e per measurement"}}},
           std::move(actual)}};
}

PrototypeBench prototype_bench(const ReproduceContext& context, const Progress& progress) {
  PrototypeBench bench{.camera = prototype_camera(setting()), .codes = {}};
  // Coarse runs scan the same codes: a poor design would be judged, not the redesign.
  ReproduceOptions options = context.options;
  options.fast = false;
  const ProgressParts parts(progress, 2);
  for (const int exposures : {4, 5})
    bench.codes.push_back(
        context.shelf.redesigned(exposures, bench.camera, options, parts[bench.codes.size()]));
  for (const char* name : {"sinusoid-k4", "multifrequency-k5"})
    bench.codes.push_back(build_family(name, bench.camera));
  return bench;
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <cstdlib>
#include <ctime>
#include "tofsmith/design/chip_search.hpp"
using namespace tofsmith;
int main(int argc, char** argv) {
  const int taps = std::atoi(argv[1]), chips = std::atoi(argv[2]), exposures = std::atoi(argv[3]);
  const int only = argc > 4 ? std::atoi(argv[4]) : -1;
  const OperatingPoint points[] = {{1.7e7, 0}, {1.7e7, 8e7}, {1.1e6, 0}};
  for (int p = 0; p < 3; ++p) {
    if (only >= 0 && only != p) continue;
    Camera camera = at_point(built_in_camera("exclusive-3tap-9chip"), points[p]);
    camera.sensor.taps = taps;
    camera.sensor.shortest_pulse_s = 1 / (camera.fundamental_frequency_hz * chips);
    ChipSearchOptions o;
    o.exposures = exposures;
    if (argc > 5) o.finalists = std::atoi(argv[5]);
    if (argc > 6) o.margin_sigma = std::atof(argv[6]);
    const auto c0 = std::clock();
    const auto r = search_chip_codes(camera, o, {});
    const auto& c = r.log.counts;
    fmt::print("point {} {:.2f} s wall {:.2f} s cpu raw {:.0f} sym {:.0f} ex {} turn {} bound {} metric {} prmetric {} amb {} margin {} kept {}\n", p, r.log.seconds, double(std::clock() - c0) / CLOCKS_PER_SEC, c.raw, c.after_symmetry, c.examined, c.pruned_by_turning, c.pruned_by_bound, c.metric_evaluations, c.pruned_by_metric, c.ambiguous, c.below_margin, c.kept);
    fmt::print("  {}\n", r.proof);
    for (const auto& f : r.finalists) fmt::print("  {:.4f} mm margin {:.2f} {}\n", 1e3 * f.rms_m, f.margin_sigma, f.code.text());
  }
}

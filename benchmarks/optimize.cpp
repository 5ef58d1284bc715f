// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Direct optimization compared with targets: geometric mean depth error over the paper's 25 light
// levels (f0 = 15 MHz, T = 0.3 s, read noise 20 e), or the gain over Hamiltonian K = 4 at one
// level, by independent trials at N = 240; and processor time.
//   benchmark_optimize [--only NAME] [--seed S] [--exposures E] [--history]

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <ctime>
#include <string_view>

#include "asked_figures.hpp"
#include "tofsmith/design/design.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace {

using namespace tofsmith;

struct Row {
  const char* name;
  double peak_factor, band_multiple;  // 0: no limit, but a shortest pulse of 0.5 ns
  DepthErrorKind error;
  int exposures, taps;
  double asked;                    // maximum [mm], or minimum gain over Hamiltonian K = 4
  double signal = 0, ambient = 0;  // e/s: one light level; 0: the paper's grid
};

constexpr auto linear = DepthErrorKind::linear, circular = DepthErrorKind::circular;
const Row rows[] = {
    {"p10-10f0-linear", 10, 10, linear, 5, 1, 97},
    {"p10-10f0-circular", 10, 10, circular, 5, 1, 57},
    {"p15-10f0-linear", 15, 10, linear, 5, 1, 94},
    {"p15-10f0-circular", 15, 10, circular, 5, 1, 55.7},
    {"p5-5f0-linear", 5, 5, linear, 5, 1, 158},
    {"p5-5f0-circular", 5, 5, circular, 3, 1, 90.5},
    {"p10-20f0-circular", 10, 20, circular, 6, 1, 42},
    {"p15-none-linear", 15, 0, linear, 5, 1, 54},
    {"p2-none-linear", 2, 0, linear, 6, 1, 90},
    {"two-bucket-linear", 10, 10, linear, 4, 2, 61},
    {"two-bucket-circular", 10, 10, circular, 4, 2, 36.3},
    {"four-taps-linear", 10, 10, linear, 2, 4, 37},
    {"four-taps-circular", 10, 10, circular, 2, 4, 20.4},
    {"mid-light", 10, 10, circular, 5, 1, 1.45, 1e4, 1e4},
    {"high-light", 10, 10, circular, 6, 1, 1.75, 1e5, 1e4},
};

Camera camera_of(const Row& row) {
  Camera camera = built_in_camera(row.band_multiple > 0 ? "paper-10f0" : "paper-30x");
  camera.name = row.name;
  camera.light.peak_factor = row.peak_factor;
  camera.light.impulse_response.f_max_hz = camera.sensor.impulse_response.f_max_hz =
      row.band_multiple * camera.fundamental_frequency_hz;
  if (row.band_multiple == 0) camera.sensor.shortest_pulse_s = 0.5e-9;
  camera.sensor.taps = row.taps;
  camera.operating.error = row.error;
  if (row.signal > 0) {
    camera.operating.signal_e_per_s = {row.signal};
    camera.operating.ambient_e_per_s = {row.ambient};
  }
  return camera;
}

std::vector<CodeSet> baselines_for(const Camera& camera) {
  std::vector<CodeSet> codes;
  if (camera.sensor.taps > 2) return codes;
  for (const char* name :
       {"hamiltonian-k3", "hamiltonian-k4", "hamiltonian-k5", "sinusoid-k4",
        "pulsed-multifrequency-k4", "pulsed-multifrequency-k5", "pulsed-multifrequency-k5-q5"})
    codes.push_back(build_family(name, camera));
  return codes;
}

double seconds_of_processor() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Error by trials that were not used in the design [m].
Estimate judged(const CodeSet& code, const Camera& camera) {
  EvaluateOptions options;
  options.seed = 987654321;
  options.trials = 40000;
  return evaluate(code, camera, options).of(camera.operating.error).geometric_mean_m;
}

void run(const Row& row, std::uint64_t seed, int exposures, bool history,
         benchmarks::AskedFigures& figures) {
  const Camera camera = camera_of(row);
  OptimizeOptions options;
  options.seed = seed;
  const double begin = seconds_of_processor();
  const std::vector<CodeSet> baselines = baselines_for(camera);
  std::vector<Candidate> candidates =
      optimize(camera, exposures > 0 ? exposures : row.exposures, options, baselines);
  for (const CodeSet& code : baselines) candidates.push_back({.code = code, .method = "family"});
  DesignOptions judging;
  judging.trials = 4000;
  const DesignResult found = judge(camera, std::move(candidates), judging);
  const double seconds = seconds_of_processor() - begin;
  const Candidate& best = found.winner();
  const Estimate error_m = judged(best.code, camera);
  fmt::print("{:<22} {:7.2f} +- {:4.2f} mm (said {:7.2f}) {:5.1f} s  {:6} steps  {}\n", row.name,
             1e3 * error_m.value, 1e3 * error_m.standard_error,
             1e3 * ranking_error_m(best, camera, judging), seconds, best.iterations, best.message);
  for (const Candidate& candidate : found.candidates)
    fmt::print("    {:<28} {:7.2f}\n", candidate.code.name(),
               1e3 * ranking_error_m(candidate, camera, judging));
  if (history && best.search)
    for (const SearchStep& step : best.search->steps)
      fmt::print("    {:5.0f} {:7.2f}\n", step.work, 1e3 * step.error_m);
  if (row.signal > 0) {
    const Estimate hamiltonian_m = judged(build_family("hamiltonian-k4", camera), camera);
    figures.at_least(fmt::format("{}: times better than Hamiltonian K=4", row.name),
                     hamiltonian_m.value / error_m.value, row.asked);
  } else {
    figures.at_most(fmt::format("{}: depth error [mm]", row.name), 1e3 * error_m.value, row.asked);
  }
  figures.at_most(fmt::format("{}: processor time [s]", row.name), seconds, 10.0);
}

}  // namespace

int main(int argc, char** argv) {
  std::string_view only;
  std::uint64_t seed = 1;
  int exposures = 0;
  bool history = false;
  for (int i = 1; i < argc; ++i) {
    const std::string_view option = argv[i];
    if (option == "--history") history = true;
    if (i + 1 >= argc) continue;
    if (option == "--only") only = argv[i + 1];
    if (option == "--seed") seed = std::strtoull(argv[i + 1], nullptr, 10);
    if (option == "--exposures") exposures = std::atoi(argv[i + 1]);
  }
  benchmarks::AskedFigures figures;
  for (const Row& row : rows)
    if (only.empty() || only == row.name) run(row, seed, exposures, history, figures);
  figures.print();
  return 0;
}

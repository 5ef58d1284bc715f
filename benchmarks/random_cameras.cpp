// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Compares designed codes with the best baseline for random cameras. The winner of each design and
// the baseline are evaluated with new trials that the design did not use.
//
//   benchmark_random_cameras [CAMERAS] [SEED]
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/shared/random.hpp"
#include "random_cameras.hpp"
#include "tofsmith/design/design.hpp"

namespace {

using namespace tofsmith;

/// A camera with parameters of commercial cameras, in contrast to random_camera().
Camera random_usual_camera(std::uint64_t seed, std::uint64_t index) {
  RandomStream random(seed, index);
  Camera camera = built_in_camera("paper-10f0");
  camera.name = fmt::format("random-{}", index + 1);
  camera.samples = 120;
  camera.fundamental_frequency_hz = log_between(random, 5e6, 60e6);
  camera.light.peak_factor = log_between(random, 2.0, 30.0);
  const double f0 = camera.fundamental_frequency_hz;
  for (ImpulseResponse* response :
       {&camera.light.impulse_response, &camera.sensor.impulse_response})
    response->f_max_hz = f0 * log_between(random, 4.0, 25.0);
  if (one_in(random, 4)) {
    camera.light.impulse_response = camera.sensor.impulse_response = {};
    camera.sensor.shortest_pulse_s = log_between(random, 0.008, 0.05) / f0;
  }
  if (one_in(random, 3)) camera.sensor.taps = 2;
  if (camera.sensor.taps == 2) camera.sensor.modulation_contrast = between(random, 0.6, 1.0);
  camera.light.binary = !one_in(random, 4);
  camera.sensor.binary = !one_in(random, 4);
  camera.sensor.read_noise_e = log_between(random, 2.0, 60.0);
  camera.exposure_s.total_s = log_between(random, 0.01, 0.5);
  camera.operating.signal_e_per_s.clear();
  camera.operating.ambient_e_per_s.clear();
  const double least = log_between(random, 1e3, 1e5);
  for (const double times : {1.0, 4.0, 16.0})
    camera.operating.signal_e_per_s.push_back(least * times);
  for (const double times : {0.1, 3.0}) camera.operating.ambient_e_per_s.push_back(least * times);
  camera.operating.error = one_in(random, 2) ? DepthErrorKind::linear : DepthErrorKind::circular;
  return camera;
}

}  // namespace

int main(int argc, char** argv) {
  const int cameras = argc > 1 ? std::atoi(argv[1]) : 20;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  int worse = 0;
  double log_gain = 0.0;
  fmt::print("winner of `design` beside the best baseline, mm, fresh trials\n");
  for (int i = 0; i < cameras; ++i) {
    const Camera camera = random_usual_camera(seed, static_cast<std::uint64_t>(i));
    const DepthErrorKind kind = camera.operating.error;
    DesignOptions options;
    options.trials = 10000;
    options.factorize.random_starts = 4;
    options.optimize.starts = 6;
    options.optimize.hops = 6;
    options.optimize.refinement_steps = 300;
    const DesignResult result = design(camera, options);
    const std::vector<const Candidate*> order = by_geometric_mean_error(result, kind);
    const auto found =
        std::ranges::find_if(order, [](const Candidate* c) { return !c->is_designed(); });
    if (found == order.end()) {
      fmt::print("{:10} {} has no baseline\n", camera.name, result.winner().code.name());
      continue;
    }
    const Candidate* baseline = *found;
    const EvaluateOptions fresh{.trials = 40000, .seed = seed + 1000};
    const Estimate mine = evaluate(result.winner().code, camera, fresh).of(kind).geometric_mean_m;
    const Estimate its = evaluate(baseline->code, camera, fresh).of(kind).geometric_mean_m;
    const double gain = its.value / mine.value;
    const double error =
        gain * std::hypot(mine.standard_error / mine.value, its.standard_error / its.value);
    const bool is_worse = gain < 1.0 - 3.0 * error;
    worse += is_worse;
    log_gain += std::log(gain);
    fmt::print("{:10} {:8} taps {} {:14} {:8.2f}  {:26} {:8.2f}  {:.3f} +- {:.3f} {}\n",
               camera.name, kind == DepthErrorKind::linear ? "linear" : "circular",
               camera.sensor.taps, result.winner().code.name(), 1e3 * mine.value,
               baseline->code.name(), 1e3 * its.value, gain, error, is_worse ? "WORSE" : "");
    std::fflush(stdout);
  }
  fmt::print("mean gain {:.3f}; worse by more than 3 standard errors: {} (asked: 0)\n",
             std::exp(log_gain / cameras), worse);
  return worse == 0 ? 0 : 1;
}

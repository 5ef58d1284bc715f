// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Designs codes for your camera. The search is shortened: omit `optimize` for a full search.
#include <cstdio>

#include "tofsmith/design/design.hpp"
#include "tofsmith/io/code_file.hpp"

int main() {
  using namespace tofsmith;
  const ImpulseResponse lowpass{.kind = ImpulseResponse::Kind::lowpass, .cutoff_hz = 100e6};
  Camera camera;
  camera.name = "mine";
  camera.fundamental_frequency_hz = 20e6;
  camera.exposure_s.total_s = 0.1;
  camera.samples = 120;
  camera.light.peak_factor = 6;
  camera.light.impulse_response = lowpass;
  camera.sensor.impulse_response = lowpass;
  camera.sensor.read_noise_e = 10;
  camera.operating.signal_e_per_s = {1e4, 1e5};
  camera.operating.ambient_e_per_s = {1e4};

  DesignOptions options{.method = DesignMethod::optimize, .exposures = {3}, .trials = 1000};
  options.optimize.starts = 2;
  options.optimize.steps_per_start = 40;
  options.optimize.hops = 0;
  options.optimize.refinement_steps = 40;
  options.optimize.polish_steps = 20;
  options.optimize.pool_trials = 1000;
  const DesignResult result = design(camera, options);
  for (const Candidate* candidate : by_geometric_mean_error(result, camera.operating.error))
    std::printf("%s: %.1f mm (%s)\n", candidate->code.name().c_str(),
                1e3 * ranking_error_m(*candidate, camera, options), candidate->method.c_str());
  write_code("mine.code.json", result.winner().code, OutputPolicy::overwrite);
}

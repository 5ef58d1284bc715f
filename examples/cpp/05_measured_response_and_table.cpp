// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Uses a measured impulse response instead of a model, and a measured table instead of a code. Both
// measurements are simulated here. Read your own with read_impulse_response() and
// read_measured_table().
#include <cmath>
#include <cstdio>
#include <numbers>

#include "tofsmith/decode/decoder.hpp"
#include "tofsmith/decode/decoding_table.hpp"
#include "tofsmith/simulate/depth_error.hpp"

int main() {
  using namespace tofsmith;
  // Impulse response of the light: rises immediately and rings for 8 ns.
  ImpulseResponse measured{.kind = ImpulseResponse::Kind::file, .time_step_s = 0.25e-9};
  for (int i = 0; i < 48; ++i) {
    const double time_s = i * measured.time_step_s;
    measured.samples.push_back(std::exp(-time_s / 1.5e-9) *
                               (1 + 0.3 * std::cos(2 * std::numbers::pi * time_s / 2e-9)));
  }
  Camera camera = built_in_camera("paper-10f0");
  camera.light.impulse_response = measured;
  const CodeSet code = build_family("square-k4", camera);
  const double error_m = evaluate(code, camera, {.trials = 1000}).circular.geometric_mean_m.value;
  std::printf("square-k4 behind the measured response: %.1f mm\n", 1e3 * error_m);

  // A delay sweep of 200 steps over the whole range, with small random errors.
  const ForwardModel truth(code, camera);
  MeasuredTable table;
  table.correlation = truth.correlation_table(200);
  for (int n = 0; n < 200; ++n)
    for (int k = 0; k < 4; ++k) table.correlation(n, k) += 1e-4 * std::sin(1.7 * n * n + k);
  const Decoder decoder(make_decoding_table(table, camera));

  double farthest_m = 0.0;
  for (int i = 0; i < 50; ++i) {
    const double depth_m = 1 + 8 * i / 49.0;
    const Return light{.signal_e_per_s = 1e5, .depth_bin = depth_m / camera.bin_m()};
    const Eigen::VectorXf raw = truth.expected_electrons({&light, 1}, 1e4).cast<float>();
    double found_bin = 0.0;  // of the table's 200
    decoder.decode_depth_bins(raw.data(), 1, &found_bin);
    farthest_m = std::max(farthest_m, std::abs(found_bin * camera.range_m() / 200 - depth_m));
  }
  std::printf("decoded by the measured table: off by %.1f mm at most\n", 1e3 * farthest_m);
}

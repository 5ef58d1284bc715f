// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Computes waveforms that approximate given correlation functions.
#include <cmath>
#include <cstdio>

#include "tofsmith/design/design.hpp"

int main() {
  using namespace tofsmith;
  Camera camera = built_in_camera("paper-10f0");
  camera.samples = 120;
  Eigen::MatrixXd triangle(120, 3);  // (N, K), three of them
  for (int n = 0; n < 120; ++n)
    for (int k = 0; k < 3; ++k)
      triangle(n, k) = std::abs(2 * std::fmod(n / 120.0 + k / 3.0, 1.0) - 1);

  DesignOptions options{.method = DesignMethod::factorize, .trials = 1000};
  options.target = targets_from_table("target", triangle, camera.samples, true);
  options.factorize.random_starts = 3;
  options.factorize.max_iterations = 4;
  options.factorize.refined = 4;
  const DesignResult result = design(camera, options);
  for (const Candidate* candidate : by_geometric_mean_error(result, camera.operating.error)) {
    std::printf("%s: %.1f mm; %s\n", candidate->code.name().c_str(),
                1e3 * ranking_error_m(*candidate, camera, options), candidate->message.c_str());
    for (const MeasurementReport& report : candidate->per_measurement)
      std::printf("  rms distance from the target %.2g, %d edges\n", report.residual_rms,
                  report.edges);
  }
}

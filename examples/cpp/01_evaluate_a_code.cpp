// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Computes the depth error of a standard code on a built-in camera and its lower bound.
#include <algorithm>
#include <cstdio>

#include "tofsmith/simulate/depth_error.hpp"

int main() {
  using namespace tofsmith;
  const Camera camera = built_in_camera("paper-10f0");
  for (const char* name : {"sinusoid-k4", "hamiltonian-k4"}) {
    const CodeSet code = build_family(name, camera);
    const DepthErrorReport report = evaluate(code, camera, {.trials = 1000});
    const Estimate error_m = report.linear.geometric_mean_m;
    std::printf("%s: %.1f ± %.1f mm\n", name, 1e3 * error_m.value, 1e3 * error_m.standard_error);
    const PointDepthError& brightest = *std::max_element(
        report.points.begin(), report.points.end(), [](const auto& a, const auto& b) {
          return a.point.signal_e_per_s < b.point.signal_e_per_s;
        });
    std::printf("  at S = %.3g e/s: %.1f mm, no unbiased estimator below %.1f mm\n",
                brightest.point.signal_e_per_s, 1e3 * brightest.circular_mde_m.value,
                1e3 * brightest.cramer_rao_mae_m);
  }
}

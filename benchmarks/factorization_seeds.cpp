// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Reliability of random starts for the K = 3 Hamiltonian code: 50 seeds per peak, without
// structured starts and naive pair. Also the effect of feeding the projection back into the
// iteration, as in the paper, for K = 4.

#include <fmt/format.h>

#include <cmath>

#include "tofsmith/code/families.hpp"
#include "tofsmith/design/factorize.hpp"

namespace {

using namespace tofsmith;

constexpr int seeds = 50;

Factorization run(int order, int measurement, double peak_factor, FactorizeOptions options,
                  int seed) {
  Camera camera = built_in_camera("paper-30x");
  camera.light.peak_factor = peak_factor;
  options.structured_starts = options.keep_naive = false;
  options.seed = static_cast<std::uint64_t>(seed);
  const TargetSet targets =
      targets_of(make_family(fmt::format("hamiltonian-k{}", order), {.samples = 240}));
  return factorize(targets.measurements[static_cast<std::size_t>(measurement - 1)], camera,
                   options);
}

bool near(double a, double b, double tolerance) { return std::abs(a - b) < tolerance; }

}  // namespace

int main() {
  bool all_good = true;
  fmt::print("K = 3, random starts only, {} seeds each\n", seeds);
  for (const double peak : {6.0, 15.0, 30.0}) {
    int found = 0;
    double worst = 0.0;
    for (int seed = 1; seed <= seeds; ++seed) {
      const PairCandidate best = run(3, 1, peak, {}, seed).best();
      worst = std::max(worst, best.residual_rms);
      found += best.residual_rms < 1e-6 && near(best.pair.modulation.duty(), 1.0 / 6.0, 1e-9) &&
               near(best.pair.modulation.peak(), 6.0, 1e-6) &&
               near(best.pair.demodulation.mean(), 0.5, 1e-9);
    }
    all_good = all_good && found >= 45;
    fmt::print(
        "  p = {:2}: residual < 1e-6, duty 1/6, peak 6, demodulation duty 1/2 in {} of {} "
        "(worst residual {:.2g})\n",
        peak, found, seeds, worst);
  }
  int squares = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const PairCandidate best = run(3, 1, 2.0, {}, seed).best();
    squares += near(best.pair.modulation.duty(), 0.5, 5e-3) &&
               near(best.pair.demodulation.duty(), 0.5, 5e-3) && best.pair.modulation.edges() == 2;
  }
  all_good = all_good && squares >= 45;
  fmt::print("  p =  2: square with square in {} of {}\n", squares, seeds);

  fmt::print("K = 4 code 3, p = 30, one random start each, {} seeds\n", seeds);
  for (const bool feedback : {true, false}) {
    FactorizeOptions options;
    options.random_starts = 1;
    options.total_variation_weights = {3e-4};
    options.refine_edges = false;
    options.feed_back_projection = feedback;
    options.max_iterations = 50;
    int exact = 0;
    for (int seed = 1; seed <= seeds; ++seed) exact += run(4, 3, 30.0, options, seed).exact();
    fmt::print("  {} the projection: zero error in {} of {}\n",
               feedback ? "feeding back" : "keeping beside", exact, seeds);
  }
  return all_good ? 0 : 1;
}

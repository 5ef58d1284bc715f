// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/factorize/alternation.hpp"

#include <algorithm>
#include <cmath>

#include "core/shared/periodic.hpp"
#include "design/circulant_tv/least_squares_term.hpp"

namespace tofsmith {

namespace {

constexpr double smallest_rms = 1e-4;  // keeps the majorizer's weight positive

Eigen::VectorXd fit(CirculantTvSolver& solver, const CirculantTvProblem& problem,
                    const Eigen::VectorXd& current) {
  if (problem.total_variation_weight == 0.0) return least_squares_within_bounds(problem, current);
  const CirculantTvResult result = solver.solve(problem);
  if (result.is_usable()) return result.x;
  const CirculantTvResult careful = solve_circulant_tv(problem);
  return careful.is_usable() ? careful.x : current;
}

}  // namespace

AlternationResult alternate(const PairModel& model, SampledPair start,
                            double total_variation_weight, const FactorizeOptions& options,
                            CirculantTvSolver& solver) {
  const double samples = model.samples();
  SampledPair x = std::move(start);
  AlternationResult result{x, x, model.residual_rms(x.modulation, x.demodulation), {}};
  result.playable_residual_rms = std::numeric_limits<double>::infinity();
  double rms = model.residual_rms(x.modulation, x.demodulation);
  double last_objective = std::numeric_limits<double>::infinity();
  int without_gain = 0;

  for (int iteration = 1; iteration <= options.max_iterations; ++iteration) {
    x.demodulation = fit(
        solver,
        {.kernel = model.demodulation_kernel(x.modulation),
         .target = model.target_samples(),
         .total_variation_weight = total_variation_weight * samples * std::max(rms, smallest_rms),
         .upper_bound = 1.0},
        x.demodulation);
    rms = model.residual_rms(x.modulation, x.demodulation);
    x.modulation = fit(solver,
                       {.kernel = model.modulation_kernel(x.demodulation),
                        .target = model.reversed_target_samples(),
                        .total_variation_weight = total_variation_weight / model.peak_factor() *
                                                  samples * std::max(rms, smallest_rms),
                        .upper_bound = model.peak_factor(),
                        .budget = samples},
                       x.modulation);
    rms = model.residual_rms(x.modulation, x.demodulation);
    const double objective =
        rms +
        total_variation_weight * (circular_total_variation(x.demodulation) +
                                  circular_total_variation(x.modulation) / model.peak_factor());

    const BinaryProjection projection = project_to_binary(model, x);
    result.history.push_back({objective, rms, projection.residual_rms});
    ++without_gain;
    if (projection.residual_rms < result.playable_residual_rms - 1e-12) {
      result.playable = projection.pair;
      result.playable_residual_rms = projection.residual_rms;
      without_gain = 0;
    }
    result.relaxed = x;
    if (options.feed_back_projection) {
      x = projection.pair;
      rms = projection.residual_rms;
      if (without_gain >= 3) break;
    } else if (std::abs(last_objective - objective) <
               options.objective_tolerance * std::max(objective, 1e-12)) {
      break;
    }
    if (result.playable_residual_rms < 1e-9) break;
    last_objective = objective;
  }
  return result;
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/circulant_tv/circulant_tv_admm.hpp"
#include "tofsmith/design/circulant_tv.hpp"

namespace tofsmith {
namespace {

constexpr int fallback_steps = 3000;

}  // namespace

CirculantTvResult solve_circulant_tv(const CirculantTvProblem& problem,
                                     const CirculantTvOptions& options,
                                     const std::optional<Eigen::VectorXd>& warm_start) {
  problem.validate();
  CirculantTvSolver solver(problem.samples());
  CirculantTvResult best =
      warm_start ? solver.solve(problem, options, *warm_start) : solver.solve(problem, options);
  if (best.termination == Termination::converged) return best;

  CirculantTvAdmmOptions admm_options;
  admm_options.max_iterations = fallback_steps;
  admm_options.certificate_tolerance = options.certificate_tolerance;
  const CirculantTvResult split = solve_circulant_tv_by_admm(problem, admm_options, best.x);
  if (split.certificate < best.certificate) best = split;
  if (best.termination == Termination::converged) return best;

  CirculantTvResult polished = solver.solve(problem, options, split.x);
  polished.method = CirculantTvMethod::active_set_after_admm;
  return polished.certificate < best.certificate ? polished : best;
}

}  // namespace tofsmith

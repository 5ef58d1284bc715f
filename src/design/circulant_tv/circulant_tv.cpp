// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/design/circulant_tv.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/shared/enum_words.hpp"
#include "core/shared/periodic.hpp"
#include "design/circulant_tv/circulant_tv_admm.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

void require_finite(const Eigen::VectorXd& values, const char* field) {
  if (values.allFinite()) return;
  for (Eigen::Index n = 0; n < values.size(); ++n)
    require(std::isfinite(values[n]), fmt::format("CirculantTvProblem::{}[{}]", field, n),
            values[n], "must be finite");
}

constexpr EnumWords<CirculantTvMethod, 3> tv_method_words("CirculantTvMethod", "method",
                                                          "active_set", "admm",
                                                          "active_set_after_admm");

}  // namespace

double CirculantTvProblem::objective(const Eigen::VectorXd& x) const {
  return 0.5 * (circular_convolution(kernel, x) - target).squaredNorm() +
         total_variation_weight * circular_total_variation(x);
}

void CirculantTvProblem::validate() const {
  require(kernel.size() >= 1, "CirculantTvProblem::kernel.size()", kernel.size(), "must be >= 1");
  require(target.size() == kernel.size(), "CirculantTvProblem::target.size()", target.size(),
          fmt::format("must equal kernel.size() = {}", kernel.size()));
  require_finite(kernel, "kernel");
  require_finite(target, "target");
  require(std::isfinite(total_variation_weight) && total_variation_weight > 0,
          "CirculantTvProblem::total_variation_weight", total_variation_weight,
          "must be finite and > 0");
  require(std::isfinite(upper_bound) && upper_bound > 0, "CirculantTvProblem::upper_bound",
          upper_bound, "must be finite and > 0");
  if (budget)
    require(std::isfinite(*budget) && *budget >= 0, "CirculantTvProblem::budget", *budget,
            "must be finite and >= 0");
}

void CirculantTvOptions::validate() const {
  require(max_iterations >= 1, "CirculantTvOptions::max_iterations", max_iterations,
          "must be >= 1");
  require(std::isfinite(certificate_tolerance) && certificate_tolerance > 0,
          "CirculantTvOptions::certificate_tolerance", certificate_tolerance,
          "must be finite and > 0");
}

std::string_view name_of(CirculantTvMethod method) { return tv_method_words.of(method); }

bool CirculantTvResult::is_usable() const {
  return termination == Termination::converged || certificate <= 1e-4;
}

std::string CirculantTvResult::brief() const {
  return fmt::format("{} by {}: objective {:.10g}, certificate {:.2g}, {} iterations, {} pieces",
                     name_of(termination), name_of(method), objective, certificate, iterations,
                     pieces);
}

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

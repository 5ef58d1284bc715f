// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <string>

#include "design/circulant_tv/box_budget_projection.hpp"
#include "design/circulant_tv/face_minimizer.hpp"
#include "design/circulant_tv/least_squares_term.hpp"
#include "design/circulant_tv/optimality_scan.hpp"
#include "design/circulant_tv/piecewise_constant.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/design/circulant_tv.hpp"

namespace tofsmith {
namespace {

constexpr double worthwhile_share = 0.15;
// Rounds without progress: first make one move at a time, then stop.
constexpr int rounds_before_caution = 4;
constexpr int rounds_before_stall = 24;

}  // namespace

struct CirculantTvSolver::Workspace {
  explicit Workspace(int samples)
      : term(samples), x(samples), face(term), problem_samples(samples) {}
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  LeastSquaresTerm term;
  PiecewiseConstant x;
  BudgetState budget;
  SignalLimits limits;
  FaceMinimizer face;
  OptimalityScan scan;
  Eigen::VectorXd sums;  // prefix sums of the gradient, from sums_origin
  int sums_origin = 0;
  Eigen::VectorXd priced_sums;
  bool by_transform = false;  // FFT gradient, without accumulated error
  double squares = 0;         // least-squares term, if by_transform
  int problem_samples;

  void prepare(const CirculantTvProblem& problem, const CirculantTvOptions& options);
  CirculantTvResult run(const CirculantTvOptions& options);
  void update_gradient();
  void update_scan();
  void update_slopes();
  // A dual path may be violated at both ends of an interval.
  double violation() const { return 2 * scan.violation; }
  void make_moves(bool one_at_a_time);
  CirculantTvResult report(Termination termination, int iterations) const;
};

CirculantTvSolver::CirculantTvSolver(int samples) {
  require(samples >= 1, "samples", samples, "must be >= 1");
  workspace_ = std::make_unique<Workspace>(samples);
}
CirculantTvSolver::~CirculantTvSolver() = default;
CirculantTvSolver::CirculantTvSolver(CirculantTvSolver&&) noexcept = default;
CirculantTvSolver& CirculantTvSolver::operator=(CirculantTvSolver&&) noexcept = default;

int CirculantTvSolver::samples() const { return workspace_->problem_samples; }

CirculantTvResult CirculantTvSolver::solve(const CirculantTvProblem& problem,
                                           const CirculantTvOptions& options) {
  workspace_->prepare(problem, options);
  const double fair_share = workspace_->limits.budget / problem.samples();
  workspace_->x.make_constant(0.5 * std::min(problem.upper_bound, fair_share));
  return workspace_->run(options);
}

CirculantTvResult CirculantTvSolver::solve(const CirculantTvProblem& problem,
                                           const CirculantTvOptions& options,
                                           const Eigen::VectorXd& warm_start) {
  workspace_->prepare(problem, options);
  require(warm_start.size() == samples(), "warm_start.size()", warm_start.size(),
          "must equal the solver's samples, " + std::to_string(samples()));
  require(warm_start.allFinite(), "warm_start", "NaN or infinity", "must be finite");
  Eigen::VectorXd start = warm_start;
  project_on_box_and_budget(start, problem.upper_bound, problem.budget);
  workspace_->x.take_pieces_of(start, problem.upper_bound);
  workspace_->budget.active = workspace_->x.sum() >= workspace_->limits.budget * (1 - 1e-12);
  return workspace_->run(options);
}

void CirculantTvSolver::Workspace::prepare(const CirculantTvProblem& problem,
                                           const CirculantTvOptions& options) {
  problem.validate();
  options.validate();
  require(problem.samples() == problem_samples, "CirculantTvProblem::kernel.size()",
          problem.samples(), "must equal the solver's samples, " + std::to_string(problem_samples));
  term.set(problem.kernel, problem.target);
  limits = {problem.total_variation_weight, problem.upper_bound,
            problem.budget.value_or(std::numeric_limits<double>::infinity())};
  budget = {};
  face.reset_count();
  by_transform = false;
}

CirculantTvResult CirculantTvSolver::Workspace::run(const CirculantTvOptions& options) {
  int idle_rounds = 0;
  double total_decrease = 0;
  update_gradient();
  for (int iteration = 1; iteration <= options.max_iterations; ++iteration) {
    const double decrease = face.minimize(x, budget, limits);
    update_gradient();
    update_scan();
    if (violation() <= options.certificate_tolerance && !by_transform) {
      by_transform = true;
      update_gradient();
      update_scan();
    }
    if (violation() <= options.certificate_tolerance)
      return report(Termination::converged, iteration);

    total_decrease += decrease;
    idle_rounds = decrease > 1e-15 * total_decrease ? 0 : idle_rounds + 1;
    if (idle_rounds >= rounds_before_stall) return report(Termination::stalled, iteration);
    if (idle_rounds >= rounds_before_caution && !by_transform) {
      by_transform = true;
      update_gradient();
      update_scan();
    }
    make_moves(idle_rounds >= rounds_before_caution);
  }
  by_transform = true;
  update_gradient();
  face.minimize(x, budget, limits);
  update_gradient();
  update_scan();
  return report(Termination::iteration_limit, options.max_iterations);
}

void CirculantTvSolver::Workspace::update_gradient() {
  if (by_transform)
    squares = term.prefix_gradient_by_transform(x, sums);
  else
    term.prefix_gradient(x, sums);
  sums_origin = x[0].start;
  update_slopes();
}

void CirculantTvSolver::Workspace::update_slopes() {
  for (int j = 0; j < x.size(); ++j) {
    int first = x[j].start - sums_origin;
    if (first < 0) first += problem_samples;
    const int end = first + x[j].length;
    x[j].slope = end <= problem_samples
                     ? sums[end] - sums[first]
                     : sums[problem_samples] - sums[first] + sums[end - problem_samples] - sums[0];
  }
}

void CirculantTvSolver::Workspace::update_scan() {
  priced_sums = sums;
  if (budget.multiplier != 0)
    for (int k = 0; k <= problem_samples; ++k) priced_sums[k] += budget.multiplier * k;
  scan_for_moves(x, priced_sums, limits.total_variation_weight, scan);
}

void CirculantTvSolver::Workspace::make_moves(bool one_at_a_time) {
  double best = 0;
  for (const IntervalMove& move : scan.moves) best = std::min(best, move.slope);
  const double min_slope = (one_at_a_time ? 1.0 : worthwhile_share) * best;
  // Descending, so that splits keep the remaining indices.
  for (auto move = scan.moves.rbegin(); move != scan.moves.rend(); ++move)
    if (move->slope <= min_slope) x.split(move->piece, move->first, move->last, move->direction);
  update_slopes();
}

CirculantTvResult CirculantTvSolver::Workspace::report(Termination termination,
                                                       int iterations) const {
  CirculantTvResult result;
  result.termination = termination;
  x.write_to(result.x);
  result.objective = squares + limits.total_variation_weight * x.total_variation();
  result.certificate = violation();
  result.budget_multiplier = budget.multiplier;
  result.iterations = iterations;
  result.newton_steps = face.newton_steps();
  result.pieces = x.distinct();
  return result;
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/design/circulant_tv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/shared/periodic.hpp"
#include "design/circulant_tv/circulant_tv_admm.hpp"
#include "design/circulant_tv/face_minimizer.hpp"
#include "design/circulant_tv/least_squares_term.hpp"
#include "design/circulant_tv/proximal_operators.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

void require_finite(const Eigen::VectorXd& values, const char* field) {
  if (values.allFinite()) return;
  for (Eigen::Index n = 0; n < values.size(); ++n)
    require(std::isfinite(values[n]), fmt::format("CirculantTvProblem::{}[{}]", field, n),
            values[n], "must be finite");
}

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

bool CirculantTvResult::is_usable() const {
  return termination == Termination::converged || certificate <= 1e-4;
}

CirculantTvResult solve_circulant_tv(const CirculantTvProblem& problem,
                                     const CirculantTvOptions& options) {
  problem.validate();
  CirculantTvSolver solver(problem.samples());
  CirculantTvResult best = solver.solve(problem, options);
  if (best.termination == Termination::converged) return best;

  const CirculantTvAdmmOptions admm_options{.max_iterations = 3000,
                                            .certificate_tolerance = options.certificate_tolerance};
  const CirculantTvResult split = solve_circulant_tv_by_admm(problem, admm_options, best.x);
  if (split.certificate < best.certificate) best = split;
  if (best.termination == Termination::converged) return best;

  CirculantTvResult polished = solver.solve(problem, options, split.x);
  polished.method = CirculantTvMethod::active_set_after_admm;
  return polished.certificate < best.certificate ? polished : best;
}

/// Raises (+1) or lowers (-1) the samples [first, last], counted from the start of a piece.
struct IntervalMove {
  int piece = 0, first = 0, last = 0, direction = 0;
  double slope = 0;  ///< of the objective per unit of height
};

struct OptimalityScan {
  double violation = 0;             ///< -(smallest slope) / weight, or 0
  std::vector<IntervalMove> moves;  ///< best descent of each piece that splits it
};

namespace {

// Finds the interval with the smallest slope; sums[0..length] are the prefix sums of the piece.
IntervalMove best_move(const PiecewiseConstant& x, int j, const double* sums, double weight,
                       int direction) {
  const Piece& piece = x[j];
  const double sign = direction;
  // Total variation changes by +weight at a new edge, and by the sign of an existing one.
  const double left_edge = sign * piece.rise * weight;
  const double right_edge = -sign * x[x.next(j)].rise * weight;
  IntervalMove best{j, 0, 0, direction, 0};
  double min_entry = left_edge - sign * sums[0];  // slope of the best left end up to k
  int entry = 0;
  double least = weight * 4;
  const int last = piece.length - 1;
  for (int k = 0; k < last; ++k) {
    const double slope = sign * sums[k + 1] + min_entry;
    if (slope < least) {
      least = slope;
      best.first = entry;
      best.last = k;
    }
    const double next_entry = weight - sign * sums[k + 1];
    if (next_entry < min_entry) {
      min_entry = next_entry;
      entry = k + 1;
    }
  }
  best.slope = least + weight;
  const double to_the_end = sign * sums[piece.length] + min_entry + right_edge;
  if (to_the_end < best.slope) {
    best.slope = to_the_end;
    best.first = entry;
    best.last = last;
  }
  return best;
}

// The complement of an interval across the origin does not cross it.
IntervalMove best_move_on_ring(const PiecewiseConstant& x, const double* sums, double weight,
                               int direction) {
  const int samples = x.samples();
  const double sign = direction;
  const double total = sign * sums[samples] - sign * sums[0];
  IntervalMove best{0, 0, samples - 1, direction, total};
  int highest = 0, lowest = 0;
  for (int k = 1; k <= samples; ++k) {
    const double sum = sign * sums[k];
    const double inside = sum - sign * sums[highest] + 2 * weight;
    if (inside < best.slope && k - highest < samples) best = {0, highest, k - 1, direction, inside};
    const double outside = total - (sum - sign * sums[lowest]) + 2 * weight;
    if (outside < best.slope && k - lowest < samples)
      best = {0, k % samples, lowest - 1 + (k < samples ? samples : 0), direction, outside};
    if (sum > sign * sums[highest]) highest = k;
    if (sum < sign * sums[lowest]) lowest = k;
  }
  return best;
}

bool can_move(const Piece& piece, int direction) {
  return direction > 0 ? piece.state != PieceState::at_upper : piece.state != PieceState::at_lower;
}

/// Searches all intervals of all pieces for descent directions, in one pass over the prefix sums
/// per direction (Kadane). For given jumps, finding none proves optimality.
/// @param sums  prefix sums of the gradient of the smooth term from piece 0 (N + 1)
/// @param weight  total-variation weight
void scan_for_moves(const PiecewiseConstant& x, const Eigen::VectorXd& sums, double weight,
                    OptimalityScan& scan) {
  scan.violation = 0;
  scan.moves.clear();
  int offset = 0;
  for (int j = 0; j < x.size(); ++j) {
    IntervalMove best;
    for (const int direction : {1, -1}) {
      if (!can_move(x[j], direction)) continue;
      const IntervalMove move = x.size() > 1
                                    ? best_move(x, j, sums.data() + offset, weight, direction)
                                    : best_move_on_ring(x, sums.data(), weight, direction);
      scan.violation = std::max(scan.violation, -move.slope / weight);
      const bool whole = move.last - move.first + 1 == x[j].length;
      if (whole && x[j].state == PieceState::free) continue;
      if (move.slope < best.slope) best = move;
    }
    if (best.slope < 0) scan.moves.push_back(best);
    offset += x[j].length;
  }
}

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
  workspace_ = make_hidden<Workspace>(samples);
}

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

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>

#include "tofsmith/core/hidden.hpp"
#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Convex subproblem of code design for one waveform x of N samples, with the other one fixed:
///   minimize   1/2 |A x - b|^2 + w TV(x)
///   subject to 0 <= x <= upper_bound,  sum x <= budget (optional)
/// A is circulant, (A x)[i] = sum_j kernel[i - j] x[j], and TV(x) = sum_n |x[n + 1] - x[n]|, modulo
/// N.
struct CirculantTvProblem {
  Eigen::VectorXd kernel;             ///< first column of A (N)
  Eigen::VectorXd target;             ///< b (N)
  double total_variation_weight = 0;  ///< w > 0: the method relies on solutions with few jumps
  double upper_bound = 1;             ///< of a sample, > 0
  std::optional<double> budget;       ///< maximum of sum x, >= 0

  int samples() const { return static_cast<int>(kernel.size()); }
  double objective(const Eigen::VectorXd& x) const;
  /// @throws InvalidArgument
  void validate() const;
};

struct CirculantTvOptions {
  int max_iterations = 2000;            ///< scans for violated intervals, >= 1
  double certificate_tolerance = 1e-7;  ///< converged at or below it, > 0

  /// @throws InvalidArgument
  void validate() const;
};

enum class CirculantTvMethod {
  active_set,
  admm,                   ///< alternating directions
  active_set_after_admm,  ///< started from ADMM's pieces
};

struct CirculantTvResult {
  Termination termination = Termination::not_run;
  CirculantTvMethod method = CirculantTvMethod::active_set;
  Eigen::VectorXd x;  ///< feasible (N)
  double objective = std::numeric_limits<double>::infinity();
  /// Largest violation of the optimality conditions, in units of w: twice the gain per unit of
  /// height from moving any interval (active set), or the violation of the dual path (ADMM).
  double certificate = std::numeric_limits<double>::infinity();
  double budget_multiplier = 0;  ///< >= 0; 0 if the budget is inactive
  int iterations = 0;            ///< scans (active set) or splitting steps (ADMM)
  int newton_steps = 0;          ///< linear systems of the active set
  int pieces = 0;                ///< of x

  /// True if converged or the certificate is at most 1e-4.
  bool is_usable() const;
};

/// Structured active-set method.
///
/// A Newton step moves the constant pieces of x to their optimum and stops where neighbours merge,
/// a piece reaches a bound or the budget is spent. Entries of the reduced Hessian cost O(1), by the
/// doubly integrated autocorrelation of the kernel. x is optimal, or is split at the intervals that
/// violate optimality most. The last scan uses an FFT gradient.
///
/// Keeps buffers for one length, and transforms of one kernel. Use one object per thread.
class CirculantTvSolver {
 public:
  /// @throws InvalidArgument unless samples >= 1
  explicit CirculantTvSolver(int samples);

  int samples() const;

  /// @throws InvalidArgument if problem or options are invalid or of other length
  CirculantTvResult solve(const CirculantTvProblem& problem,
                          const CirculantTvOptions& options = {});
  /// Solves from `warm_start` (N), made feasible first; best with few jumps.
  CirculantTvResult solve(const CirculantTvProblem& problem, const CirculantTvOptions& options,
                          const Eigen::VectorXd& warm_start);

 private:
  struct Workspace;
  Hidden<Workspace> workspace_;
};

/// Solves by the active set; if that stalls, by ADMM and by the active set from ADMM's pieces.
/// Returns the result with the smallest certificate.
/// @throws InvalidArgument for invalid arguments
CirculantTvResult solve_circulant_tv(const CirculantTvProblem& problem,
                                     const CirculantTvOptions& options = {});

}  // namespace tofsmith

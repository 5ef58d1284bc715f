// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Convex subproblem of code design: one waveform x of N samples, with the other waveform fixed.
///   minimize   1/2 |A x - b|^2 + w TV(x)
///   subject to 0 <= x <= upper_bound,  sum x <= budget (optional)
/// A is circulant, (A x)[i] = sum_j kernel[i - j] x[j], and TV(x) = sum_n |x[n + 1] - x[n]|, both
/// with indices modulo N.
struct CirculantTvProblem {
  Eigen::VectorXd kernel;             ///< first column of A (N), finite
  Eigen::VectorXd target;             ///< b (N), finite
  double total_variation_weight = 0;  ///< w, finite and > 0
  double upper_bound = 1;             ///< maximum of a sample, finite and > 0
  std::optional<double> budget;       ///< maximum of sum x, finite and >= 0; none: no limit

  int samples() const { return static_cast<int>(kernel.size()); }
  /// Returns the value of the objective at x (N).
  double objective(const Eigen::VectorXd& x) const;
  /// @throws std::invalid_argument naming field, value and rule. The weight must be positive
  ///   because the method relies on solutions with few jumps.
  void validate() const;
};

struct CirculantTvOptions {
  int max_iterations = 2000;            ///< scans for violated intervals, >= 1
  double certificate_tolerance = 1e-7;  ///< converged when the certificate is at most this, > 0

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};

/// Method that found a solution.
enum class CirculantTvMethod {
  active_set,             ///< structured active set
  admm,                   ///< alternating direction method of multipliers
  active_set_after_admm,  ///< active set started from the pieces found by ADMM
};
std::string_view name_of(CirculantTvMethod method);

struct CirculantTvResult {
  Termination termination = Termination::not_run;
  CirculantTvMethod method = CirculantTvMethod::active_set;
  Eigen::VectorXd x;  ///< feasible (N)
  double objective = std::numeric_limits<double>::infinity();
  /// Largest violation of the optimality conditions, in units of w. Active set: twice the gain, per
  /// unit of height, from raising or lowering any interval of x. ADMM: the smallest violation by
  /// a dual path.
  double certificate = std::numeric_limits<double>::infinity();
  double budget_multiplier = 0;  ///< Lagrange multiplier of the budget, >= 0; 0 if inactive
  int iterations = 0;            ///< scans (active set) or splitting steps (ADMM)
  int newton_steps = 0;          ///< small linear systems solved by the active set
  int pieces = 0;                ///< constant pieces of x

  /// Returns true if the method converged or the certificate is at most 1e-4.
  bool is_usable() const;
  /// Returns one line such as "converged by active_set: objective 1.25, certificate 2e-10, ...".
  std::string brief() const;
};

/// Structured active-set method for CirculantTvProblem.
///
/// x is represented by J constant pieces. A Newton step moves to the optimum of the free pieces and
/// stops where neighbours merge, a piece reaches a bound or the budget is spent. The entries of the
/// reduced Hessian cost O(1) each, from the doubly integrated autocorrelation of the kernel. A scan
/// over all intervals then finds those whose increase or decrease violates optimality most. x is
/// split there, or is optimal if there are none. The last scan computes the gradient by FFT.
///
/// Fixed to one length. Buffers are kept between solves, and transforms of the kernel as long as
/// the kernel stays the same. Use an object from one thread at a time.
class CirculantTvSolver {
 public:
  /// @throws std::invalid_argument unless samples >= 1
  explicit CirculantTvSolver(int samples);
  ~CirculantTvSolver();
  CirculantTvSolver(CirculantTvSolver&&) noexcept;
  CirculantTvSolver& operator=(CirculantTvSolver&&) noexcept;

  int samples() const;

  /// Solves from a constant start.
  /// @throws std::invalid_argument if the problem or the options are invalid or the length differs
  CirculantTvResult solve(const CirculantTvProblem& problem,
                          const CirculantTvOptions& options = {});
  /// Solves from `warm_start` (N, finite), which is made feasible first and should have few jumps.
  CirculantTvResult solve(const CirculantTvProblem& problem, const CirculantTvOptions& options,
                          const Eigen::VectorXd& warm_start);

 private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

/// Solves by the active set. If that stalls, runs ADMM and restarts the active set from ADMM's
/// pieces. Returns the result with the smallest certificate.
/// @param warm_start  initial x (N, finite), or empty
/// @throws std::invalid_argument if problem, options or start are invalid
CirculantTvResult solve_circulant_tv(const CirculantTvProblem& problem,
                                     const CirculantTvOptions& options = {},
                                     const std::optional<Eigen::VectorXd>& warm_start = {});

}  // namespace tofsmith

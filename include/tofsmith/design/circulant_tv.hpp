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

/// The convex sub-problem of code design: one waveform x of N samples, the other one fixed.
///   minimize   1/2 |A x - b|^2 + w TV(x)
///   subject to 0 <= x <= upper_bound,  sum x <= budget (if there is one)
/// A is circulant, (A x)[i] = sum_j kernel[i - j] x[j], and TV(x) = sum_n |x[n + 1] - x[n]|, both
/// with indices modulo N.
struct CirculantTvProblem {
  Eigen::VectorXd kernel;             ///< first column of A (N), finite
  Eigen::VectorXd target;             ///< b (N), finite
  double total_variation_weight = 0;  ///< w, finite and > 0
  double upper_bound = 1;             ///< largest value of a sample, finite and > 0
  std::optional<double> budget;       ///< largest sum of x, finite and >= 0; none: no limit

  int samples() const { return static_cast<int>(kernel.size()); }
  /// Value of the objective at x (N).
  double objective(const Eigen::VectorXd& x) const;
  /// @throws std::invalid_argument naming field, value and rule. A weight of zero is refused: the
  /// method lives on the few jumps that a positive weight leaves.
  void validate() const;
};

struct CirculantTvOptions {
  int max_iterations = 2000;            ///< scans for violated intervals, >= 1
  double certificate_tolerance = 1e-7;  ///< converged when the certificate is at most this, > 0

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};

/// Who found a solution.
enum class CirculantTvMethod {
  active_set,             ///< the structured active set
  admm,                   ///< alternating directions
  active_set_after_admm,  ///< the active set, started from the pieces ADMM found
};
std::string_view name_of(CirculantTvMethod method);

struct CirculantTvResult {
  Termination termination = Termination::not_run;
  CirculantTvMethod method = CirculantTvMethod::active_set;
  Eigen::VectorXd x;  ///< feasible (N)
  double objective = std::numeric_limits<double>::infinity();
  /// Largest violation of the optimality conditions, in units of w: twice what raising or lowering
  /// any interval of x would gain, per unit of height (active set), or the dual path's (ADMM).
  double certificate = std::numeric_limits<double>::infinity();
  double budget_multiplier = 0;  ///< price of the budget, >= 0; 0 where it does not bind
  int iterations = 0;            ///< scans (active set) or splitting steps (ADMM)
  int newton_steps = 0;          ///< small linear systems solved by the active set
  int pieces = 0;                ///< constant pieces of x

  /// Good enough to go on with: converged, or the certificate is at most 1e-4.
  bool is_usable() const;
  /// One line, such as "converged by active_set: objective 1.25, certificate 2e-10, ..".
  std::string brief() const;
};

/// Structured active set for the problem above.
///
/// x is held as J constant pieces. A Newton step moves to the best values of the free pieces and
/// stops where neighbours merge, a piece reaches a bound or the budget is spent; the entries of the
/// reduced Hessian are O(1), from the doubly integrated autocorrelation of the kernel. Then all
/// intervals are searched for the ones whose raise or drop violates optimality most; x is split
/// there, or is optimal. The last search uses a gradient by Fourier transform.
///
/// Built for one length; keeps its buffers between solves and the kernel's transforms between
/// solves with the same kernel. An object serves one thread at a time.
class CirculantTvSolver {
 public:
  /// @throws std::invalid_argument unless samples >= 1
  explicit CirculantTvSolver(int samples);
  ~CirculantTvSolver();
  CirculantTvSolver(CirculantTvSolver&&) noexcept;
  CirculantTvSolver& operator=(CirculantTvSolver&&) noexcept;

  int samples() const;

  /// Solves from a constant start.
  /// @throws std::invalid_argument if the problem or the options are not valid or of other length
  CirculantTvResult solve(const CirculantTvProblem& problem,
                          const CirculantTvOptions& options = {});
  /// Solves from `warm_start` (N, finite), made feasible first; good when it has few jumps.
  CirculantTvResult solve(const CirculantTvProblem& problem, const CirculantTvOptions& options,
                          const Eigen::VectorXd& warm_start);

 private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

/// Solves by the active set; where that stalls, by ADMM and the active set from ADMM's pieces. The
/// result of the smallest certificate wins and says who found it.
/// @param warm_start  where to start (N, finite), or empty
/// @throws std::invalid_argument if problem, options or start are not valid
CirculantTvResult solve_circulant_tv(const CirculantTvProblem& problem,
                                     const CirculantTvOptions& options = {},
                                     const std::optional<Eigen::VectorXd>& warm_start = {});

}  // namespace tofsmith

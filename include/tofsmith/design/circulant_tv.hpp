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

/// Convex subproblem of code design for one waveform x of N samples, with the other one fixed:
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
  double objective(const Eigen::VectorXd& x) const;
  /// @throws std::invalid_argument naming field, value and rule; a weight of zero is invalid
  ///   because the method relies on solutions with few jumps
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
  admm,                   ///< alternating directions
  active_set_after_admm,  ///< active set, started from ADMM's pieces
};
std::string_view name_of(CirculantTvMethod method);

struct CirculantTvResult {
  Termination termination = Termination::not_run;
  CirculantTvMethod method = CirculantTvMethod::active_set;
  Eigen::VectorXd x;  ///< feasible (N)
  double objective = std::numeric_limits<double>::infinity();
  /// Largest violation of the optimality conditions, in units of w. Active set: twice the gain per
  /// unit of height from raising or lowering any interval. ADMM: violation of the dual path.
  double certificate = std::numeric_limits<double>::infinity();
  double budget_multiplier = 0;  ///< Lagrange multiplier, >= 0; 0 if the budget is inactive
  int iterations = 0;            ///< scans (active set) or splitting steps (ADMM)
  int newton_steps = 0;          ///< linear systems solved by the active set
  int pieces = 0;                ///< of x

  /// True if converged or the certificate is at most 1e-4.
  bool is_usable() const;
  /// Returns one line such as "converged by active_set: objective 1.25, certificate 2e-10, ...".
  std::string brief() const;
};

/// Structured active-set method.
///
/// x consists of J constant pieces. A Newton step moves to the optimum of the free pieces and stops
/// where neighbours merge, a piece reaches a bound or the budget is spent. Entries of the reduced
/// Hessian cost O(1), by the doubly integrated autocorrelation of the kernel. Then all intervals
/// are scanned for the largest violations of optimality: x is split there, or is optimal. The last
/// scan uses an FFT gradient.
///
/// Built for one length. Keeps buffers, and transforms as long as the kernel stays the same. Use
/// one object per thread.
class CirculantTvSolver {
 public:
  /// @throws std::invalid_argument unless samples >= 1
  explicit CirculantTvSolver(int samples);
  ~CirculantTvSolver();
  CirculantTvSolver(CirculantTvSolver&&) noexcept;
  CirculantTvSolver& operator=(CirculantTvSolver&&) noexcept;

  int samples() const;

  /// Solves from a constant start.
  /// @throws std::invalid_argument if problem or options are invalid or of other length
  CirculantTvResult solve(const CirculantTvProblem& problem,
                          const CirculantTvOptions& options = {});
  /// Solves from `warm_start` (N, finite), made feasible first; best with few jumps.
  CirculantTvResult solve(const CirculantTvProblem& problem, const CirculantTvOptions& options,
                          const Eigen::VectorXd& warm_start);

 private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

/// Solves by the active set; if that stalls, by ADMM and by the active set from ADMM's pieces.
/// Returns the result with the smallest certificate.
/// @param warm_start  initial x (N, finite), or empty
/// @throws std::invalid_argument if problem, options or start are invalid
CirculantTvResult solve_circulant_tv(const CirculantTvProblem& problem,
                                     const CirculantTvOptions& options = {},
                                     const std::optional<Eigen::VectorXd>& warm_start = {});

}  // namespace tofsmith

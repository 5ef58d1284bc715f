// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/circulant_tv/circulant_tv_admm.hpp"

#include <algorithm>
#include <cmath>

#include "design/circulant_tv/box_budget_projection.hpp"
#include "design/circulant_tv/circulant_tv_certificate.hpp"
#include "design/circulant_tv/least_squares_term.hpp"
#include "design/circulant_tv/piecewise_constant.hpp"
#include "design/circulant_tv/total_variation_prox.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

constexpr double over_relaxation = 1.7;
constexpr int steps_per_check = 10;
// Ratio of the residuals that doubles or halves the penalty; convergence requires a final value.
constexpr double imbalance = 5;
constexpr int steps_per_adaptation = 50;
constexpr int last_adaptation = 2000;

class Splitting {
 public:
  Splitting(const CirculantTvProblem& problem, const Eigen::VectorXd& start)
      : problem_(problem), operator_(problem.samples()), z_(start), u_(start * 0.0) {
    operator_.set_kernel(problem.kernel);
    operator_.transform().forward(problem.target, pull_);
    pull_ = pull_.cwiseProduct(operator_.spectrum().conjugate()).eval();
    curvature_ = operator_.spectrum().cwiseAbs2();
    penalty_ = std::max(0.02 * curvature_.maxCoeff(), 1e-300);
  }

  void step() {
    // x = argmin 1/2 |A x - b|^2 + penalty/2 |x - z + u|^2
    operator_.transform().forward(z_ - u_, half_);
    half_ = ((pull_ + penalty_ * half_).array() / (curvature_.array() + penalty_)).matrix().eval();
    operator_.transform().inverse(half_, x_);
    // z = argmin w TV(z) + penalty/2 |x + u - z|^2 on the box and the budget
    z_before_ = z_;
    shifted_ = over_relaxation * x_ + (1 - over_relaxation) * z_ + u_;
    prox_.circular(shifted_, problem_.total_variation_weight / penalty_, ring_dual_, z_);
    price_ = project_on_box_and_budget(z_, problem_.upper_bound, problem_.budget);
    u_ = shifted_ - z_;
  }

  double primal_residual() const { return rms(x_ - z_); }
  double dual_residual() const { return rms(z_ - z_before_); }
  void rescale_penalty(double factor) {
    penalty_ *= factor;
    u_ /= factor;
    ring_dual_ /= factor;
  }
  const Eigen::VectorXd& z() const { return z_; }

 private:
  double rms(const Eigen::VectorXd& v) const {
    return v.norm() / (std::sqrt(static_cast<double>(v.size())) * problem_.upper_bound);
  }

  const CirculantTvProblem& problem_;
  CirculantOperator operator_;
  TotalVariationProx prox_;
  double penalty_ = 0, ring_dual_ = 0, price_ = 0;
  Eigen::VectorXd x_, z_, u_, z_before_, shifted_, curvature_;
  Eigen::VectorXcd pull_, half_;  // pull_: spectrum of A^T b
};

}  // namespace

void CirculantTvAdmmOptions::validate() const {
  require(max_iterations >= 1, "CirculantTvAdmmOptions::max_iterations", max_iterations,
          "must be >= 1");
  require(std::isfinite(tolerance) && tolerance > 0, "CirculantTvAdmmOptions::tolerance", tolerance,
          "must be finite and > 0");
  require(std::isfinite(certificate_tolerance) && certificate_tolerance > 0,
          "CirculantTvAdmmOptions::certificate_tolerance", certificate_tolerance,
          "must be finite and > 0");
}

CirculantTvResult solve_circulant_tv_by_admm(const CirculantTvProblem& problem,
                                             const CirculantTvAdmmOptions& options,
                                             const std::optional<Eigen::VectorXd>& warm_start) {
  problem.validate();
  options.validate();
  Eigen::VectorXd start = Eigen::VectorXd::Constant(problem.samples(), 0.5 * problem.upper_bound);
  if (warm_start) {
    require(warm_start->size() == problem.samples(), "warm_start.size()", warm_start->size(),
            "must equal the problem's samples, " + std::to_string(problem.samples()));
    require(warm_start->allFinite(), "warm_start", "NaN or infinity", "must be finite");
    start = *warm_start;
  }
  project_on_box_and_budget(start, problem.upper_bound, problem.budget);

  CirculantTvResult result;
  result.method = CirculantTvMethod::admm;
  result.termination = Termination::iteration_limit;
  Splitting splitting(problem, start);
  for (result.iterations = 1; result.iterations <= options.max_iterations; ++result.iterations) {
    splitting.step();
    if (result.iterations % steps_per_check != 0) continue;
    const double primal = splitting.primal_residual(), dual = splitting.dual_residual();
    if (primal < options.tolerance && dual < options.tolerance) {
      result.termination = Termination::stalled;
      break;
    }
    if (result.iterations % steps_per_adaptation == 0 && result.iterations <= last_adaptation) {
      if (primal > imbalance * dual) splitting.rescale_penalty(2);
      if (dual > imbalance * primal) splitting.rescale_penalty(0.5);
    }
  }
  result.iterations = std::min(result.iterations, options.max_iterations);

  result.x = splitting.z();
  result.objective = problem.objective(result.x);
  const OptimalityCertificate judged = certificate(problem, result.x);
  result.certificate = judged.worst();
  result.budget_multiplier = judged.budget_multiplier;
  if (result.certificate <= options.certificate_tolerance)
    result.termination = Termination::converged;
  PiecewiseConstant pieces(problem.samples());
  pieces.take_pieces_of(result.x, problem.upper_bound);
  result.pieces = pieces.size();
  return result;
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "calibrate/parametric_response.hpp"

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/shared/decompositions.hpp"

namespace tofsmith {
namespace {

using Kind = ImpulseResponse::Kind;
using Matrix4 = Eigen::Matrix4d;
using Vector4 = Eigen::Vector4d;  // position [s], log of the scale [s], height, background

using std::numbers::pi;

/// Integral of the response of unit scale up to x.
double step_response(Kind kind, double x) {
  switch (kind) {
    case Kind::hann:
      if (x <= -0.5) return 0.0;
      if (x >= 0.5) return 1.0;
      return x + 0.5 + std::sin(2 * pi * x) / (2 * pi);
    case Kind::gaussian:
      return 0.5 * std::erfc(-x / std::numbers::sqrt2);
    default:
      return x <= 0.0 ? 0.0 : -std::expm1(-x);
  }
}

/// Width times f_max of a Hann window, whose transfer is 1/2 at 1 / width.
double hann_width_times_f_max() {
  const ImpulseResponse window{.kind = Kind::hann, .f_max_hz = 1.0};
  double low_hz = 0.0, high_hz = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double middle_hz = 0.5 * (low_hz + high_hz);
    (window.transfer(middle_hz).real() > 0.5 ? low_hz : high_hz) = middle_hz;
  }
  return 1.0 / low_hz;
}

/// Scale per full width at half maximum.
double scale_per_width(Kind kind) {
  if (kind == Kind::hann) return 2.0;
  if (kind == Kind::gaussian) return 1.0 / (2 * std::sqrt(2 * std::numbers::ln2));
  return 1.0 / std::numbers::ln2;
}

/// @param scale_s  window width, standard deviation, or time constant
ImpulseResponse response_of(Kind kind, double scale_s) {
  ImpulseResponse response{.kind = kind};
  if (kind == Kind::hann)
    response.f_max_hz = hann_width_times_f_max() / scale_s;
  else if (kind == Kind::gaussian)
    response.cutoff_hz = std::sqrt(std::numbers::ln2) / (2 * pi * scale_s);
  else
    response.cutoff_hz = 1.0 / (2 * pi * scale_s);
  return response;
}

class Fit {
 public:
  Fit(Kind kind, const ResponseFitProblem& problem) : kind_(kind), problem_(problem) {}

  /// Height and background follow by linear least squares.
  void start(double place_s, double scale_s) {
    const Eigen::VectorXd shape = shape_of(place_s, std::log(scale_s));
    Eigen::MatrixXd columns(shape.size(), 2);
    columns << shape, Eigen::VectorXd::Ones(shape.size());
    const Eigen::MatrixXd weighted = problem_.weights.asDiagonal() * columns;
    const Eigen::Vector2d linear =
        solve_symmetric(columns.transpose() * weighted, weighted.transpose() * problem_.values);
    parameters_ << place_s, std::log(scale_s), linear[0], linear[1];
    cost_ = cost_of(residual_of(parameters_));
  }

  void run() {
    double damping = 1e-3;
    for (int iteration = 0; iteration < 200 && damping < 1e12; ++iteration) {
      const Eigen::MatrixXd jacobian = jacobian_at(parameters_);
      const Eigen::MatrixXd weighted = problem_.weights.asDiagonal() * jacobian;
      const Matrix4 hessian = jacobian.transpose() * weighted;
      const Vector4 slope = weighted.transpose() * residual_of(parameters_);
      Matrix4 damped = hessian;
      damped.diagonal() *= 1.0 + damping;
      const Vector4 step = solve_symmetric(damped, slope);
      const Vector4 next = parameters_ + step;
      const double cost = step.allFinite() ? cost_of(residual_of(next)) : INFINITY;
      if (!(cost < cost_)) {
        damping *= 8;
        continue;
      }
      const bool done = cost_ - cost < 1e-12 * cost_;
      parameters_ = next;
      cost_ = cost;
      damping = std::max(1e-12, damping / 8);
      if (done) break;
    }
  }

  double cost() const { return cost_; }

  ParametricResponse result() const {
    ParametricResponse result;
    const double scale_s = std::exp(parameters_[1]);
    result.response = response_of(kind_, scale_s);
    const Eigen::VectorXd residual = residual_of(parameters_);
    const auto count = static_cast<double>(residual.size());
    const Eigen::MatrixXd jacobian = jacobian_at(parameters_);
    const Matrix4 hessian = jacobian.transpose() * problem_.weights.asDiagonal() * jacobian;
    // Unit diagonal, because parameters in seconds are small.
    const Vector4 unit = hessian.diagonal().cwiseSqrt().cwiseInverse();
    const Matrix4 scaled = unit.asDiagonal() * hessian * unit.asDiagonal();
    const double variance =
        scaled.fullPivLu().inverse()(1, 1) * unit[1] * unit[1] * cost_ / std::max(1.0, count - 4.0);
    const double relative_error = std::sqrt(std::max(0.0, variance));
    const double parameter_hz =
        kind_ == Kind::hann ? result.response.f_max_hz : result.response.cutoff_hz;
    result.parameter_hz = {parameter_hz, parameter_hz * relative_error};
    const double cutoff_hz = bandwidth_hz(result.response);
    result.bandwidth_hz = {cutoff_hz, cutoff_hz * relative_error};
    result.residual_rms = std::sqrt(residual.squaredNorm() / count);
    result.fit = problem_.values - residual;
    return result;
  }

 private:
  Eigen::VectorXd shape_of(double place_s, double log_scale) const {
    const double scale_s = std::exp(log_scale), step_s = problem_.time_step_s;
    Eigen::VectorXd shape(problem_.values.size());
    const bool is_step = problem_.excitation == Excitation::step;
    for (Eigen::Index i = 0; i < shape.size(); ++i) {
      const double t = static_cast<double>(i) * step_s - place_s;
      shape[i] = is_step ? step_response(kind_, t / scale_s)
                         : (step_response(kind_, (t + 0.5 * step_s) / scale_s) -
                            step_response(kind_, (t - 0.5 * step_s) / scale_s)) *
                               scale_s / step_s;
    }
    return shape;
  }

  Eigen::VectorXd residual_of(const Vector4& p) const {
    return problem_.values - p[2] * shape_of(p[0], p[1]) -
           Eigen::VectorXd::Constant(problem_.values.size(), p[3]);
  }

  double cost_of(const Eigen::VectorXd& residual) const {
    return (problem_.weights.array() * residual.array().square()).sum();
  }

  /// Central differences for position and log scale.
  Eigen::MatrixXd jacobian_at(const Vector4& p) const {
    constexpr double relative = 1e-4;
    const double move_s = relative * std::exp(p[1]);
    Eigen::MatrixXd jacobian(problem_.values.size(), 4);
    jacobian.col(0) =
        p[2] / (2 * move_s) * (shape_of(p[0] + move_s, p[1]) - shape_of(p[0] - move_s, p[1]));
    jacobian.col(1) =
        p[2] / (2 * relative) * (shape_of(p[0], p[1] + relative) - shape_of(p[0], p[1] - relative));
    jacobian.col(2) = shape_of(p[0], p[1]);
    jacobian.col(3).setOnes();
    return jacobian;
  }

  Kind kind_;
  const ResponseFitProblem& problem_;
  Vector4 parameters_ = Vector4::Zero();
  double cost_ = INFINITY;
};

}  // namespace

ParametricResponse fit_parametric_response(Kind kind, const ResponseFitProblem& problem) {
  std::optional<Fit> best;
  for (const double factor : {0.5, 1.0, 2.0}) {
    const double scale_s = factor * scale_per_width(kind) * problem.width_s;
    // Unlike the others, the low-pass response starts at its peak.
    const double lead_s = kind != Kind::lowpass                    ? 0.0
                          : problem.excitation == Excitation::step ? std::numbers::ln2 * scale_s
                                                                   : 0.0;
    Fit fit(kind, problem);
    fit.start(problem.place_s - lead_s, scale_s);
    fit.run();
    if (!best || fit.cost() < best->cost()) best.emplace(fit);
  }
  return best->result();
}

}  // namespace tofsmith

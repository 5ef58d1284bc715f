// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "calibrate/parametric_response.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/shared/decompositions.hpp"
#include "core/shared/periodic.hpp"

namespace tofsmith {

namespace {

using std::numbers::pi;

/// Sum of h[i] exp(-2 pi j f t_i), with t from the first value.
std::complex<double> transform_at(const ResponseWindow& window, double frequency_hz) {
  const std::complex<double> turn = std::polar(1.0, -2 * pi * frequency_hz * window.time_step_s);
  std::complex<double> sum = 0.0;
  for (Eigen::Index i = window.values.size() - 1; i >= 0; --i) sum = sum * turn + window.values[i];
  return sum;
}

/// Transfer of a difference, which averages the derivative over one step.
double differencing(const ResponseWindow& window, double frequency_hz) {
  const double x = pi * frequency_hz * window.time_step_s;
  return !window.differentiated || x == 0.0 ? 1.0 : std::sin(x) / x;
}

double gain_at(const ResponseWindow& window, double frequency_hz) {
  return std::abs(transform_at(window, frequency_hz)) / window.values.sum() /
         differencing(window, frequency_hz);
}

/// Standard deviation of gain_at() by first-order propagation.
double gain_error_at(const ResponseWindow& window, double frequency_hz) {
  const Eigen::Index count = window.values.size();
  const std::complex<double> value = transform_at(window, frequency_hz);
  const double total = window.values.sum(), gain = std::abs(value) / total;
  Eigen::VectorXd slope(count);  // derivative of the gain by each value
  for (Eigen::Index i = 0; i < count; ++i) {
    const double phase = -2 * pi * frequency_hz * window.time_step_s * static_cast<double>(i);
    slope[i] =
        ((std::conj(value) * std::polar(1.0, phase)).real() / std::abs(value) - gain) / total;
  }
  double variance = 0.0;
  if (!window.differentiated) {
    variance = (slope.array().square() * window.variance.array()).sum() +
               std::pow(slope.sum(), 2) * window.background_variance;
  } else {
    for (Eigen::Index i = 0; i + 1 < count; ++i)
      variance += std::pow(slope[i] - slope[i + 1], 2) * window.variance[i];
  }
  return std::sqrt(variance) / differencing(window, frequency_hz);
}

/// Noise power in coefficient k of M.
double noise_power(const ResponseWindow& window, int k, int coefficients) {
  const double white = window.variance.sum();
  if (!window.differentiated) return white;
  return 4 * std::pow(std::sin(pi * k / coefficients), 2) * white;
}

double smoothed_power(const Eigen::VectorXcd& spectrum, Eigen::Index k, Eigen::Index reach) {
  const Eigen::Index first = std::max<Eigen::Index>(0, k - reach);
  const Eigen::Index last = std::min(spectrum.size() - 1, k + reach);
  return spectrum.segment(first, last - first + 1).cwiseAbs2().mean();
}

}  // namespace

Estimate measured_bandwidth_hz(const ResponseWindow& window) {
  const double half_rate_hz = 0.5 / window.time_step_s;
  const auto length = static_cast<double>(window.values.size());
  const double step_hz = half_rate_hz / std::max(64.0, 4 * length);
  double low_hz = 0.0, high_hz = step_hz;
  const double level = std::numbers::sqrt2 / 2;
  while (gain_at(window, high_hz) > level) {
    low_hz = high_hz;
    high_hz += step_hz;
    if (high_hz > half_rate_hz) return {NAN, NAN};
  }
  for (int i = 0; i < 60; ++i) {
    const double middle_hz = 0.5 * (low_hz + high_hz);
    (gain_at(window, middle_hz) > level ? low_hz : high_hz) = middle_hz;
  }
  const double found_hz = low_hz, move_hz = 0.01 * found_hz;
  const double slope =
      (gain_at(window, found_hz + move_hz) - gain_at(window, found_hz - move_hz)) / (2 * move_hz);
  return {found_hz, gain_error_at(window, found_hz) / std::abs(slope)};
}

DenoisedResponse denoised_response(const ResponseWindow& window, double time_step_s,
                                   double margin_s) {
  const Eigen::Index length = window.values.size();
  const auto margin = static_cast<Eigen::Index>(std::ceil(margin_s / window.time_step_s));
  const auto coefficients =
      static_cast<int>(std::bit_ceil(static_cast<unsigned>(2 * length + 2 * margin)));
  Eigen::VectorXd padded = Eigen::VectorXd::Zero(coefficients);
  padded.segment(margin, length) = window.values;
  Eigen::VectorXcd spectrum;
  PeriodicTransform(coefficients).forward(padded, spectrum);

  // Wiener filter: 1 - noise / power; 0 where noise dominates.
  const Eigen::Index reach = coefficients / length;
  Eigen::Index kept = 1;
  double left = 0.0;
  Eigen::VectorXcd filtered = spectrum;
  for (; kept < spectrum.size(); ++kept) {
    const double noise = noise_power(window, static_cast<int>(kept), coefficients);
    const double power = smoothed_power(spectrum, kept, reach);
    if (power < 2 * noise) break;
    const double pass = 1.0 - noise / power;
    const double frequency_hz = static_cast<double>(kept) / (coefficients * window.time_step_s);
    filtered[kept] *= pass / differencing(window, frequency_hz);
    left += 2 * pass * pass * noise;
  }
  // A sharp cut-off would cause ringing.
  const Eigen::Index fading = kept / 3;
  for (Eigen::Index k = kept - fading; k < kept; ++k)
    filtered[k] *= std::pow(
        std::cos(0.5 * pi * static_cast<double>(k - kept + fading) / static_cast<double>(fading)),
        2);
  filtered.conservativeResize(kept);

  const double period_s = coefficients * window.time_step_s;
  const auto value_at = [&](double t_s) {
    const std::complex<double> turn = std::polar(1.0, 2 * pi * t_s / period_s);
    std::complex<double> sum = 0.0;
    for (Eigen::Index k = kept - 1; k >= 1; --k) sum = (sum + filtered[k]) * turn;
    return (filtered[0].real() + 2 * sum.real()) / coefficients;
  };
  const auto count = static_cast<Eigen::Index>(
      std::ceil(static_cast<double>(length + 2 * margin) * window.time_step_s / time_step_s));
  Eigen::VectorXd samples(count);
  double moment_s = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    const double t_s = static_cast<double>(i) * time_step_s;
    samples[i] = value_at(t_s);
    moment_s += t_s * samples[i];
  }
  const double centre_s = moment_s / samples.sum();
  // Make the centre a sampling point.
  const double offset_s = centre_s - time_step_s * std::floor(centre_s / time_step_s);
  const double first_s = offset_s - time_step_s * std::ceil(offset_s / time_step_s);
  for (Eigen::Index i = 0; i < count; ++i)
    samples[i] = value_at(first_s + static_cast<double>(i) * time_step_s);
  const double highest = samples.maxCoeff();
  samples /= samples.sum();

  DenoisedResponse result;
  result.response.kind = ImpulseResponse::Kind::file;
  result.response.samples.assign(samples.begin(), samples.end());
  result.response.time_step_s = time_step_s;
  result.response_centre_s = centre_s - first_s;
  result.centre_s = window.start_time_s - static_cast<double>(margin) * window.time_step_s +
                    centre_s + (window.differentiated ? 0.5 * window.time_step_s : 0.0);
  result.noise_rms =
      std::sqrt(left / (static_cast<double>(coefficients) * static_cast<double>(length))) / highest;
  return result;
}

namespace {

using Kind = ImpulseResponse::Kind;
using Matrix4 = Eigen::Matrix4d;
using Vector4 = Eigen::Vector4d;  // position [s], log of the scale [s], height, background

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

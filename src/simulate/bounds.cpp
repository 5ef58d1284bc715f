// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/bounds.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "tofsmith/core/error.hpp"
#include "tofsmith/core/periodic.hpp"

namespace tofsmith {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
const double mae_per_sigma = std::sqrt(2.0 / std::numbers::pi);

/// Mean over albedo uniform in (0, 1) of min(mae(albedo), largest). Nodes crowd towards albedo 0,
/// where the error grows.
template <typename Mae>
double mean_over_albedo(double largest, Mae&& mae) {
  constexpr int nodes = 24;
  double sum = 0.0;
  for (int i = 0; i < nodes; ++i) {
    const double x = (i + 0.5) / nodes;  // albedo = x^2, d albedo = 2 x dx
    sum += 2.0 * x * std::min(largest, mae(x * x));
  }
  // The midpoint rule integrates 2 x exactly: a constant error stays what it is.
  return sum / nodes;
}

OperatingPoint dimmed(const OperatingPoint& point, double albedo) {
  return {albedo * point.signal_e_per_s, point.ambient_e_per_s};
}

/// Values at the middle of every second cell of a table of twice as many points, and the slope over
/// the cell around them.
void middles_and_slopes(const Eigen::MatrixXd& fine, Eigen::MatrixXd& middle,
                        Eigen::MatrixXd& slope) {
  const Eigen::Index cells = fine.rows() / 2;
  middle.resize(cells, fine.cols());
  slope.resize(cells, fine.cols());
  for (Eigen::Index j = 0; j < cells; ++j) {
    middle.row(j) = fine.row(2 * j + 1);
    slope.row(j) = (fine.row((2 * j + 2) % fine.rows()) - fine.row(2 * j)) * double(cells);
  }
}

/// What is left of `vector` across `direction` (unit length or zero).
template <typename Vector, typename Direction>
void take_out(Vector& vector, const Direction& direction) {
  vector -= vector.dot(direction) * direction;
}

/// Scales to unit length, or to zero what rounding alone made.
template <typename Vector>
void normalize_or_drop(Vector& vector, double original_norm) {
  const double norm = vector.norm();
  if (norm > 1e-10 * original_norm && norm > 0.0)
    vector /= norm;
  else
    vector.setZero();
}

/// Largest kappa (1 - kappa) / (b kappa + c) a tap can reach. The duties of an exposure's taps add
/// to at most 1, or to exactly 1 if charge cannot be thrown away; the expression is concave in
/// kappa, so equal duties are best.
double largest_gated(double b, double c, int taps, bool may_be_shorter) {
  if (may_be_shorter && c == 0.0) return 1.0 / b;  // the limit of ever shorter gates
  const double best = c / (std::sqrt(c * c + b * c) + c);
  const double kappa = may_be_shorter ? std::min(best, 1.0 / taps) : 1.0 / taps;
  return kappa * (1.0 - kappa) / (b * kappa + c);
}

}  // namespace

CramerRaoBound::CramerRaoBound(const ForwardModel& model, const Camera& camera,
                               NoiseInformation information)
    : range_m_(camera.range_m()),
      information_(information),
      constant_variance_e2_(model.constant_variance_e2()) {
  constexpr int cells_per_bin = 4;
  const Eigen::MatrixXd tap_table =
      model.tap_correlation_table(2 * cells_per_bin * model.samples()) *
      model.tap_exposure_s().asDiagonal();
  const Eigen::MatrixXd& readout = model.readout();
  const Eigen::MatrixXd sums = readout.cwiseAbs();
  middles_and_slopes(tap_table * readout.transpose(), signal_, signal_slope_);
  middles_and_slopes(tap_table * sums.transpose(), shot_signal_, shot_signal_slope_);
  const Eigen::VectorXd tap_ambient = model.tap_exposure_s().cwiseProduct(model.tap_ambient_gain());
  ambient_ = model.exposure_s().cwiseProduct(unknown_ambient_gain(model, camera));
  shot_ambient_ = sums * tap_ambient;
  // What differences of buckets leave of ambient light is rounding, not a direction to take out.
  ambient_ = (ambient_.array().abs() > 1e-9 * shot_ambient_.array()).select(ambient_, 0.0);
  constant_variance_e2_ += sums * (camera.sensor.dark_current_e_per_s * model.tap_exposure_s());
}

Eigen::VectorXd CramerRaoBound::sigma_m(const OperatingPoint& point) const {
  const Eigen::Index K = ambient_.size();
  const bool with_variance = information_ == NoiseInformation::mean_and_variance;
  const Eigen::Index rows = with_variance ? 2 * K : K;
  // Columns of the whitened Jacobian; the Fisher matrix is their Gram matrix.
  Eigen::VectorXd by_depth(rows), by_signal(rows), by_ambient(rows);
  Eigen::VectorXd sigma(signal_.rows());
  for (Eigen::Index j = 0; j < sigma.size(); ++j) {
    for (Eigen::Index i = 0; i < K; ++i) {
      constexpr double least_e2 = 1e-9;  // a measurement without any light or noise tells nothing
      const double variance = std::max(least_e2, point.signal_e_per_s * shot_signal_(j, i) +
                                                     point.ambient_e_per_s * shot_ambient_[i] +
                                                     constant_variance_e2_[i]);
      const double weight = 1.0 / std::sqrt(variance);
      by_depth[i] = weight * point.signal_e_per_s * signal_slope_(j, i);
      by_signal[i] = weight * signal_(j, i);
      by_ambient[i] = weight * ambient_[i];
      if (!with_variance) continue;
      const double variance_weight = std::numbers::sqrt2 / 2.0 / variance;
      by_depth[K + i] = variance_weight * point.signal_e_per_s * shot_signal_slope_(j, i);
      by_signal[K + i] = variance_weight * shot_signal_(j, i);
      by_ambient[K + i] = variance_weight * shot_ambient_[i];
    }
    // [F^-1]_zz = 1 / |part of the depth column across the other two|^2: well defined even where
    // ambient or signal cannot be told apart, and the matrix has no inverse.
    const double depth_norm = by_depth.norm();
    normalize_or_drop(by_ambient, by_ambient.norm());
    const double signal_norm = by_signal.norm();
    take_out(by_signal, by_ambient);
    normalize_or_drop(by_signal, signal_norm);
    take_out(by_depth, by_ambient);
    take_out(by_depth, by_signal);
    const double left = by_depth.norm();
    sigma[j] = left > 1e-10 * depth_norm ? range_m_ / left : infinity;
  }
  return sigma;
}

double CramerRaoBound::mae_m(const OperatingPoint& point) const {
  return mae_per_sigma * sigma_m(point).mean();
}

double CramerRaoBound::mae_uniform_albedo_m(const OperatingPoint& point) const {
  return mean_over_albedo(0.25 * range_m_,
                          [&](double albedo) { return mae_m(dimmed(point, albedo)); });
}

ReceiverBound::ReceiverBound(const Camera& camera, int exposures)
    : range_m_(camera.range_m()),
      taps_(camera.sensor.taps),
      drain_(camera.sensor.drain),
      dark_e_per_s_(camera.sensor.dark_current_e_per_s),
      constant_variance_e2_(camera.sensor.read_noise_e * camera.sensor.read_noise_e) {
  camera.validate();
  require(exposures >= 1, "exposures", exposures, "must be >= 1");
  require(camera.exposure_s.each_s.empty() ||
              camera.exposure_s.each_s.size() == static_cast<std::size_t>(exposures),
          "exposures", exposures, "must equal the number of exposure_s of the camera");
  for (int e = 0; e < exposures; ++e) exposure_s_.push_back(camera.exposure_s.of(e, exposures));
  const double step_e = camera.sensor.gain_e_per_dn.value_or(0.0);
  constant_variance_e2_ += step_e * step_e / 12.0;
  if (!camera.band_limited()) return;

  // The harmonics the forward model keeps.
  const int highest = std::max(2048, 8 * camera.samples);
  const Eigen::VectorXcd transfer = camera.transfer(highest);
  const double p = camera.light.peak_factor;
  const double largest_modulation =
      p / std::numbers::pi * std::sin(std::numbers::pi * std::min(1.0 / p, 0.5));
  Eigen::VectorXcd spectrum = Eigen::VectorXcd::Zero(2 * highest + 1);
  Eigen::VectorXcd slope_spectrum = spectrum;
  const int points = 4 * highest;
  for (int n = 0; n <= highest; ++n) {
    const double turn = 2.0 * std::numbers::pi * n;
    largest_slope_power_ = std::max(largest_slope_power_,
                                    std::pow(turn * largest_modulation * std::abs(transfer[n]), 2));
    spectrum[n] = transfer[n] * double(points);
    slope_spectrum[n] = std::complex<double>(0.0, turn) * spectrum[n];
  }
  const PeriodicTransform transform(points);
  transform.inverse(spectrum, response_);
  transform.inverse(slope_spectrum, response_slope_);
}

double ReceiverBound::tap_information(const OperatingPoint& point) const {
  if (response_.size() == 0) return infinity;
  double information = 0.0;
  for (const double time_s : exposure_s_) {
    const double b = time_s * point.ambient_e_per_s;
    const double c = constant_variance_e2_ + time_s * dark_e_per_s_;
    if (b + c == 0.0) return infinity;
    information += taps_ * std::pow(point.signal_e_per_s * time_s, 2) * largest_slope_power_ *
                   largest_gated(b, c, taps_, taps_ == 1 || drain_);
  }
  return information;
}

double ReceiverBound::photon_information(const OperatingPoint& point) const {
  if (response_.size() == 0) return infinity;
  const double S = point.signal_e_per_s;
  double information = 0.0;
  for (const double time_s : exposure_s_) {
    const double other = time_s * (point.ambient_e_per_s + dark_e_per_s_) + constant_variance_e2_;
    double sum = 0.0;
    for (Eigen::Index j = 0; j < response_.size(); ++j) {
      constexpr double rounding = 1e-12;  // of the response, where it is 0
      const double variance = time_s * S * std::max(response_[j], rounding) + other;
      sum += std::pow(S * time_s * response_slope_[j], 2) / variance;
    }
    information += sum / static_cast<double>(response_.size());
  }
  return information;
}

double ReceiverBound::mae_m(const OperatingPoint& point) const {
  const double information = std::min(tap_information(point), photon_information(point));
  return range_m_ * mae_per_sigma / std::sqrt(information);
}

double ReceiverBound::mae_uniform_albedo_m(const OperatingPoint& point) const {
  return mean_over_albedo(0.25 * range_m_,
                          [&](double albedo) { return mae_m(dimmed(point, albedo)); });
}

}  // namespace tofsmith

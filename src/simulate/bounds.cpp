// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/bounds.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "camera/shared/depth_prior.hpp"
#include "simulate/shared/depth_information.hpp"
#include "simulate/ziv_zakai.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {

/// Removes harmonics that are rounding errors in the response's second derivative, but keeps enough
/// of them to sample results.
Eigen::VectorXcd without_rounding(const Eigen::VectorXcd& transfer) {
  constexpr Eigen::Index least_kept = 256;
  constexpr double rounding = 1e-7;  // relative to the largest
  const Eigen::ArrayXd curvature =
      Eigen::ArrayXd::LinSpaced(transfer.size(), 0.0, static_cast<double>(transfer.size() - 1))
          .square() *
      transfer.array().abs();
  const double least = rounding * curvature.maxCoeff();
  Eigen::Index kept = transfer.size();
  while (kept > least_kept + 1 && curvature[kept - 1] <= least) --kept;
  return transfer.head(kept);
}

/// Mean over albedo uniform in (0, 1) of min(mae, a quarter of the range). Nodes are denser near
/// albedo 0, where the error grows.
template <typename Bound>
double mean_over_albedo(const Bound& bound, double range_m, const OperatingPoint& point) {
  constexpr int nodes = 48;
  double sum = 0.0;
  for (int i = 0; i < nodes; ++i) {
    const double x = (i + 0.5) / nodes;  // albedo = x^2, d albedo = 2 x dx
    const OperatingPoint dimmed{x * x * point.signal_e_per_s, point.ambient_e_per_s};
    sum += 2.0 * x * std::min(0.25 * range_m, bound.mae_m(dimmed));
  }
  return sum / nodes;
}

double deviation_of_depth_m(const Eigen::VectorXd& by_depth, const Eigen::VectorXd& by_signal,
                            const Eigen::VectorXd& by_ambient, double range_m) {
  return DepthPart<Eigen::VectorXd>(by_depth, by_signal, by_ambient).deviation_m(range_m);
}

}  // namespace

DirectTofBound::DirectTofBound(const Camera& camera)
    : range_m_(camera.range_m()),
      exposure_s_(camera.exposure_s.sum_s() * (1.0 + 0.5 * std::abs(camera.sensor.tap_mismatch))),
      peak_factor_(camera.light.peak_factor),
      max_density_(DepthPrior(camera).max_density()) {
  camera.validate();
  if (!camera.light_is_band_limited()) return;
  transfer_ = camera.light_transfer(harmonics_kept(camera.samples));
  photons_.emplace(without_rounding(transfer_),
                   camera.light.impulse_response.kind == ImpulseResponse::Kind::file);
}

double DirectTofBound::photon_information(const OperatingPoint& point) const {
  if (!photons_) return infinity;
  return photons_->largest(exposure_s_ * point.signal_e_per_s, exposure_s_ * point.ambient_e_per_s,
                           peak_factor_);
}

double DirectTofBound::information_of(const Waveform& modulation,
                                      const OperatingPoint& point) const {
  if (!photons_) return infinity;
  const int highest = static_cast<int>(transfer_.size()) - 1;
  Eigen::VectorXd light, slope;
  sample_with_slope(modulation.harmonics(highest).cwiseProduct(transfer_), light, slope);
  return information_of_shape(light, slope, exposure_s_ * point.signal_e_per_s,
                              exposure_s_ * point.ambient_e_per_s);
}

double DirectTofBound::mae_m(const OperatingPoint& point) const {
  return mae_of_information_m(photon_information(point), range_m_, max_density_);
}

double DirectTofBound::mae_uniform_albedo_m(const OperatingPoint& point) const {
  return mean_over_albedo(*this, range_m_, point);
}

namespace {

int cells_of(const ForwardModel& model, std::optional<int> per_bin) {
  if (!per_bin) per_bin = default_cells_per_bin(model);
  require(*per_bin >= 1, "cells_per_bin", *per_bin, "must be >= 1");
  return *per_bin * model.samples();
}

}  // namespace

CramerRaoBound::CramerRaoBound(const ForwardModel& model, const Camera& camera,
                               NoiseInformation information, std::optional<int> per_bin)
    : range_m_(camera.range_m()),
      information_(information),
      constant_variance_e2_(model.constant_variance_e2()) {
  const int cells = cells_of(model, per_bin);
  masses_ = DepthPrior(camera).masses(cells);
  const int points = 2 * cells;
  if (model.has_rows()) {
    middles_and_slopes(model.correlation_table(points) * model.exposure_s().asDiagonal(), signal_,
                       signal_slope_);
    covariance_ = row_covariance(model, points);
    const Eigen::MatrixXd fine = covariance_->signal;
    middles_and_slopes(fine, covariance_->signal, covariance_slope_);
    ambient_ = model.exposure_s().cwiseProduct(unknown_ambient_gain(model, camera));
    return;
  }
  const Eigen::MatrixXd tap_table =
      model.tap_correlation_table(points) * model.tap_exposure_s().asDiagonal();
  const Eigen::MatrixXd& readout = model.readout();
  const Eigen::MatrixXd sums = readout.cwiseAbs();
  middles_and_slopes(tap_table * readout.transpose(), signal_, signal_slope_);
  middles_and_slopes(tap_table * sums.transpose(), shot_signal_, shot_signal_slope_);
  const Eigen::VectorXd tap_ambient = model.tap_exposure_s().cwiseProduct(model.tap_ambient_gain());
  ambient_ = model.exposure_s().cwiseProduct(unknown_ambient_gain(model, camera));
  shot_ambient_ = sums * tap_ambient;
  // Ambient light cancels in differences of buckets up to rounding.
  ambient_ = (ambient_.array().abs() > 1e-9 * shot_ambient_.array()).select(ambient_, 0.0);
  constant_variance_e2_ += sums * (model.tap_dark_e_per_s() * model.tap_exposure_s());
}

HistogramBound::HistogramBound(const ForwardModel& model, const Camera& camera)
    : range_m_(camera.range_m()) {
  const int samples = model.samples(), step = 2 * cells_per_bin;
  const Eigen::VectorXd bin = model.time_bin_table(step * samples) * model.tap_exposure_s()[0];
  Eigen::MatrixXd middle, slope;
  middles_and_slopes(bin, middle, slope);
  // Bin n sees a depth as bin 0 sees it n bins nearer, so bin 0 at all depths represents all bins.
  light_.resize(samples, cells_per_bin);
  slope_.resize(samples, cells_per_bin);
  for (int j = 0; j < samples * cells_per_bin; ++j) {
    light_(j / cells_per_bin, j % cells_per_bin) = middle(j, 0);
    slope_(j / cells_per_bin, j % cells_per_bin) = slope(j, 0);
  }
  const Eigen::VectorXd masses = DepthPrior(camera).masses(middle.rows());
  if (masses.size() > 0) masses_ = masses.reshaped(cells_per_bin, samples).rowwise().sum();
  dark_e_ = model.expected_tap_electrons({}, 0.0)[0];
  ambient_e_ = model.expected_tap_electrons({}, 1.0)[0] - dark_e_;
}

double HistogramBound::mae_m(const OperatingPoint& point) const {
  constexpr double min_e = 1e-9;
  Eigen::VectorXd sigma_m(light_.cols());
  for (Eigen::Index j = 0; j < light_.cols(); ++j) {
    const Eigen::ArrayXd weight = (point.signal_e_per_s * light_.col(j).array() +
                                   point.ambient_e_per_s * ambient_e_ + dark_e_)
                                      .max(min_e)
                                      .rsqrt();
    sigma_m[j] =
        deviation_of_depth_m(point.signal_e_per_s * slope_.col(j).array() * weight,
                             light_.col(j).array() * weight, ambient_e_ * weight, range_m_);
  }
  return mae_per_sigma() * mean_over_depths(sigma_m, masses_);
}

double HistogramBound::mae_uniform_albedo_m(const OperatingPoint& point) const {
  return mean_over_albedo(*this, range_m_, point);
}

/// Uses L^-1 of the covariance L L^T of the rows.
Eigen::Matrix<double, Eigen::Dynamic, 3> CramerRaoBound::whitened_jacobian_of_rows(
    Eigen::Index depth, const OperatingPoint& point) const {
  const Eigen::Index K = ambient_.size();
  Eigen::MatrixXd covariance = covariance_->at(depth, point.signal_e_per_s, point.ambient_e_per_s);
  // Rows may be linearly dependent; directions without noise then also have mean 0.
  constexpr double rounding = 1e-12;
  covariance.diagonal().array() += std::max(min_e2, rounding * covariance.diagonal().maxCoeff());
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
  const auto lower = factor.matrixL();
  Eigen::Matrix<double, Eigen::Dynamic, 3> by(K, 3);
  by << point.signal_e_per_s * signal_slope_.row(depth).transpose(), signal_.row(depth).transpose(),
      ambient_;
  lower.solveInPlace(by);
  if (information_ != NoiseInformation::mean_and_variance) return by;
  const RowCovariance slopes{covariance_slope_, covariance_->ambient,
                             Eigen::VectorXd::Zero(covariance_->floor.size())};
  const RowCovariance values{covariance_->signal, covariance_->ambient, slopes.floor};
  std::array changes{slopes.at(depth, point.signal_e_per_s, 0.0), values.at(depth, 1.0, 0.0),
                     values.at(depth, 0.0, 1.0)};
  by.conservativeResize(K + K * K, 3);
  for (int c = 0; c < 3; ++c) {
    Eigen::MatrixXd& change = changes[static_cast<std::size_t>(c)];
    lower.solveInPlace(change);
    change.transposeInPlace();
    lower.solveInPlace(change);
    by.col(c).tail(K * K) = std::numbers::sqrt2 / 2.0 * change.reshaped();
  }
  return by;
}

/// The Fisher matrix is the Gram matrix of the columns for depth, signal and ambient light.
Eigen::Matrix<double, Eigen::Dynamic, 3> CramerRaoBound::whitened_jacobian(
    Eigen::Index depth, const OperatingPoint& point) const {
  if (covariance_) return whitened_jacobian_of_rows(depth, point);
  const Eigen::Index K = ambient_.size();
  const bool with_variance = information_ == NoiseInformation::mean_and_variance;
  Eigen::Matrix<double, Eigen::Dynamic, 3> by(with_variance ? 2 * K : K, 3);
  for (Eigen::Index i = 0; i < K; ++i) {
    const double variance =
        std::max(min_e2, point.signal_e_per_s * shot_signal_(depth, i) +
                             point.ambient_e_per_s * shot_ambient_[i] + constant_variance_e2_[i]);
    const double weight = 1.0 / std::sqrt(variance);
    by(i, 0) = weight * point.signal_e_per_s * signal_slope_(depth, i);
    by(i, 1) = weight * signal_(depth, i);
    by(i, 2) = weight * ambient_[i];
    if (!with_variance) continue;
    const double variance_weight = std::numbers::sqrt2 / 2.0 / variance;
    by(K + i, 0) = variance_weight * point.signal_e_per_s * shot_signal_slope_(depth, i);
    by(K + i, 1) = variance_weight * shot_signal_(depth, i);
    by(K + i, 2) = variance_weight * shot_ambient_[i];
  }
  return by;
}

Eigen::VectorXd CramerRaoBound::sigma_m(const OperatingPoint& point) const {
  Eigen::VectorXd sigma(signal_.rows());
  for (Eigen::Index j = 0; j < sigma.size(); ++j) {
    const Eigen::Matrix<double, Eigen::Dynamic, 3> by = whitened_jacobian(j, point);
    sigma[j] = deviation_of_depth_m(by.col(0), by.col(1), by.col(2), range_m_);
  }
  return sigma;
}

double CramerRaoBound::mae_m(const OperatingPoint& point) const {
  return mae_per_sigma() * mean_over_depths(sigma_m(point), masses_);
}

double CramerRaoBound::mae_uniform_albedo_m(const OperatingPoint& point) const {
  return mean_over_albedo(*this, range_m_, point);
}

namespace {

/// Largest kappa (1 - kappa) / (b kappa + c) of a tap. Duties of an exposure add to at most 1, or
/// to exactly 1 without a drain; the expression is concave in kappa, so equal duties are best.
double largest_gated(double b, double c, int taps, bool may_be_shorter) {
  if (may_be_shorter && c == 0.0) return 1.0 / b;  // limit of gates of vanishing length
  const double best = c / (std::sqrt(c * c + b * c) + c);
  const double kappa = may_be_shorter ? std::min(best, 1.0 / taps) : 1.0 / taps;
  return kappa * (1.0 - kappa) / (b * kappa + c);
}

/// Computes the quantity once for consecutive exposures of equal length.
template <typename OfExposure>
double sum_over(const std::vector<double>& exposure_s, OfExposure&& of_exposure) {
  double sum = 0.0, last_s = 0.0, last = 0.0;
  for (const double time_s : exposure_s) {
    if (time_s != last_s) last = of_exposure(time_s);
    last_s = time_s;
    sum += last;
  }
  return sum;
}

}  // namespace

ReceiverBound::ReceiverBound(const Camera& camera, int exposures)
    : range_m_(camera.range_m()),
      taps_(in_buckets(camera).sensor.taps),
      has_rows_(camera.sensor.readout == Readout::rows),
      drain_(in_buckets(camera).sensor.drain),
      read_outs_(camera.sensor.subtracts() ? 2 : 1),
      peak_factor_(camera.light.peak_factor),
      sensitivity_(1.0 + 0.5 * std::abs(camera.sensor.tap_mismatch)),
      dark_e_per_s_(in_buckets(camera).sensor.dark_current_e_per_s),
      constant_variance_e2_(has_rows_ ? 0.0 : constant_variance_e2_of(in_buckets(camera).sensor)),
      max_density_(DepthPrior(camera).max_density()) {
  camera.validate();
  require(exposures >= 1, "exposures", exposures, "must be >= 1");
  require(camera.exposure_s.each_s.empty() ||
              camera.exposure_s.each_s.size() == static_cast<std::size_t>(exposures),
          "exposures", exposures, "must equal the number of exposure_s of the camera");
  for (int e = 0; e < exposures; ++e) exposure_s_.push_back(camera.exposure_s.of(e, exposures));
  if (!camera.band_limited()) return;
  using Kind = ImpulseResponse::Kind;
  const bool may_ring = camera.light.impulse_response.kind == Kind::file ||
                        camera.sensor.impulse_response.kind == Kind::file;
  const Eigen::VectorXcd transfer =
      without_rounding(camera.transfer(harmonics_kept(camera.samples)));
  photons_.emplace(transfer, may_ring);
  // Analog weights of a mixer can weight photons by arrival time.
  const bool weighs = camera.sensor.is_signed() && !camera.sensor.binary;
  if (!has_rows_ && !may_ring && !weighs) gates_.emplace(transfer);
  transfer_power_ = transfer.tail(transfer.size() - 1).cwiseAbs2();
}

/// Largest sum over exposures and taps of T_e^2 S^2 |M|^2 (mean of d^2 - kappa^2) / variance, to be
/// multiplied by |H|^2 of one harmonic.
double ReceiverBound::gathered(const OperatingPoint& point) const {
  const double p = peak_factor_;
  const double largest_harmonic =
      p / std::numbers::pi * std::sin(std::numbers::pi * std::min(1.0 / p, 0.5));
  const double signal = sensitivity_ * point.signal_e_per_s;
  const double ambient =
      sensitivity_ * point.ambient_e_per_s - signal * photons_->undershoot(peak_factor_);
  double sum = 0.0;
  for (const double time_s : exposure_s_) {
    // A response that rings may reduce ambient light, at most at a duty of 1.
    const double b = time_s * std::max(ambient, 0.0);
    const double c = constant_variance_e2_ + time_s * (dark_e_per_s_ + std::min(ambient, 0.0));
    if (c < 0.0 || b + c == 0.0) return infinity;
    sum += taps_ * std::pow(signal * time_s * largest_harmonic, 2) *
           largest_gated(b, c, taps_, taps_ == 1 || drain_);
  }
  return sum;
}

double ReceiverBound::tap_information(const OperatingPoint& point) const {
  if (!photons_ || has_rows_) return infinity;
  // Limits the mean over all depths, not each depth.
  return max_density_ * photons_->largest_slope_power() * gathered(point);
}

double ReceiverBound::recorded_information(const OperatingPoint& point, bool by_gates) const {
  if (!photons_) return infinity;
  return sum_over(exposure_s_, [&](double time_s) {
    const double signal_e = time_s * sensitivity_ * point.signal_e_per_s;
    const double ambient_e = time_s * sensitivity_ * point.ambient_e_per_s;
    const double c = time_s * dark_e_per_s_ + constant_variance_e2_;
    const double recorded = photons_->largest(signal_e, ambient_e + read_outs_ * c, peak_factor_);
    if (!by_gates || !gates_) return recorded;
    return std::min(recorded, taps_ * gates_->at_any_depth(signal_e, ambient_e, c));
  });
}

double ReceiverBound::photon_information(const OperatingPoint& point) const {
  return recorded_information(point, true);
}

double ReceiverBound::gate_information(const OperatingPoint& point) const {
  if (!gates_) return infinity;
  return max_density_ * taps_ * sum_over(exposure_s_, [&](double time_s) {
           return gates_->mean_over_depths(time_s * sensitivity_ * point.signal_e_per_s,
                                           time_s * sensitivity_ * point.ambient_e_per_s,
                                           time_s * dark_e_per_s_ + constant_variance_e2_);
         });
}

double ReceiverBound::information(const OperatingPoint& point) const {
  return std::min({tap_information(point), recorded_information(point, max_density_ > 1.0),
                   gate_information(point)});
}

double ReceiverBound::mae_m(const OperatingPoint& point) const {
  const double most = information(point);
  const double each = photons_ && !has_rows_ ? gathered(point) : infinity;
  if (max_density_ > 1.0 || each == infinity)
    return mae_of_information_m(most, range_m_, max_density_);
  return range_m_ * ziv_zakai_mae(each * transfer_power_, most);
}

double ReceiverBound::mae_uniform_albedo_m(const OperatingPoint& point) const {
  return mean_over_albedo(*this, range_m_, point);
}

}  // namespace tofsmith

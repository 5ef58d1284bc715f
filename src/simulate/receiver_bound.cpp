// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "camera/shared/depth_prior.hpp"
#include "simulate/bound_means.hpp"
#include "simulate/ziv_zakai.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/simulate/bounds.hpp"

namespace tofsmith {
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
  return mean_over_albedo(0.25 * range_m_,
                          [&](double albedo) { return mae_m(dimmed(point, albedo)); });
}

}  // namespace tofsmith

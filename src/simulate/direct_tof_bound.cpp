// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/bounds.hpp"

#include <cmath>
#include <numeric>

#include "simulate/bound_means.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {

double total_exposure_s(const ExposureTime& exposure) {
  if (exposure.each_s.empty()) return exposure.total_s;
  return std::accumulate(exposure.each_s.begin(), exposure.each_s.end(), 0.0);
}

}  // namespace

DirectTofBound::DirectTofBound(const Camera& camera)
    : range_m_(camera.range_m()),
      exposure_s_(total_exposure_s(camera.exposure_s) *
                  (1.0 + 0.5 * std::abs(camera.sensor.tap_mismatch))),
      peak_factor_(camera.light.peak_factor) {
  camera.validate();
  if (!camera.light_is_band_limited()) return;
  transfer_ = camera.light_transfer(harmonics_kept(camera.samples));
  photons_.emplace(transfer_, camera.light.impulse_response.kind == ImpulseResponse::Kind::file);
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
  return range_m_ * mae_per_sigma() / std::sqrt(photon_information(point));
}

double DirectTofBound::mae_uniform_albedo_m(const OperatingPoint& point) const {
  return mean_over_albedo(0.25 * range_m_,
                          [&](double albedo) { return mae_m(dimmed(point, albedo)); });
}

}  // namespace tofsmith

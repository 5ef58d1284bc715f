// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/simulate/photon_information.hpp"

namespace tofsmith {

/// What the light alone allows, for scale: depth from photons recorded one by one by an ideal
/// direct time-of-flight receiver, with the camera's light source, its total exposure time and
/// nothing else of it (no demodulation, no read noise, no dark current). Signal and ambient are
/// known.
///   J <= T integral over the period of (S m')^2 / (S m + A) du
/// No receiver of any kind does better with the same light, so it is never above ReceiverBound.
/// @see docs/bounds.md for derivation and assumptions
class DirectTofBound {
 public:
  /// @throws std::invalid_argument if the camera is invalid
  explicit DirectTofBound(const Camera& camera);

  /// No modulation within the camera's peak and average power carries more [1 / period^2];
  /// infinite where the light has no impulse response.
  double photon_information(const OperatingPoint& point) const;
  /// range sqrt(2 / pi) / sqrt(photon_information) [m].
  double mae_m(const OperatingPoint& point) const;
  /// The same averaged over a signal scaled uniformly in (0, 1), at each albedo held to range / 4.
  double mae_uniform_albedo_m(const OperatingPoint& point) const;

  /// What one modulation carries, exactly [1 / period^2]; infinite without impulse response.
  double information_of(const Waveform& modulation, const OperatingPoint& point) const;

 private:
  double range_m_;
  double exposure_s_;  // of all exposures together, times the sensitivity of the best tap
  double peak_factor_;
  Eigen::VectorXcd transfer_;                 // of the light; empty if it has no limit
  std::optional<PhotonInformation> photons_;  // behind the light's response; none if no limit
};

}  // namespace tofsmith

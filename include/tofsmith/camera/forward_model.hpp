// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/camera/correlation.hpp"

namespace tofsmith {

/// Light that comes back from one depth.
struct Return {
  double signal_e_per_s = 0.0;  ///< S, were the sensor fully open
  double depth_bin = 0.0;       ///< position in [0, N), any real
};

/// What a camera that plays a code measures: expected electrons and their variance.
///   mu_i(z) = T_i (S chi_i(z) + A kappa_i + dark),  variance mu_i + sigma_r^2 (+ step^2 / 12)
/// chi and kappa are those of the waveforms really played (see played_code), behind both arms.
/// @see Gutierrez-Barragan et al., CVPR 2019, Eq. (4); several returns add.
///
/// A *tap value* is what one tap collects (E x taps of them); a *measurement* is what leaves the
/// sensor (the same, or the differences A - B of two-bucket pairs).
class ForwardModel {
 public:
  /// @throws std::invalid_argument if the camera is invalid or the code does not fit it
  ForwardModel(const CodeSet& code, const Camera& camera);

  int measurements() const { return static_cast<int>(readout_.rows()); }
  int tap_values() const { return static_cast<int>(readout_.cols()); }
  int samples() const { return samples_; }

  /// chi_i(z) of every measurement (K) at a real depth.
  Eigen::VectorXd correlation(double depth_bin) const;
  /// chi at depth_bin = j N / points, (points, K). points = N gives one row per bin.
  Eigen::MatrixXd correlation_table(int points) const;
  /// The same for the tap values, (points, E x taps).
  Eigen::MatrixXd tap_correlation_table(int points) const;

  /// kappa_i (K): mean gain seen by ambient light.
  const Eigen::VectorXd& ambient_gain() const { return ambient_gain_; }
  /// kappa of the tap values (E x taps).
  const Eigen::VectorXd& tap_ambient_gain() const { return tap_ambient_gain_; }
  /// T_i [s] of every measurement (K).
  const Eigen::VectorXd& exposure_s() const { return exposure_s_; }
  /// T of the tap values [s].
  const Eigen::VectorXd& tap_exposure_s() const { return tap_exposure_s_; }
  /// Measurements = readout (K, E x taps) times tap values; entries are +1, -1 and 0.
  const Eigen::MatrixXd& readout() const { return readout_; }
  /// Electrons of dark current in every measurement (K).
  Eigen::VectorXd dark_electrons() const;
  /// Variance of every measurement that does not depend on light [e^2] (K): read noise and
  /// quantization.
  Eigen::VectorXd constant_variance_e2() const;

  /// Expected tap values [e].
  Eigen::VectorXd expected_tap_electrons(std::span<const Return> returns,
                                         double ambient_e_per_s) const;
  /// Expected measurements [e] (K).
  Eigen::VectorXd expected_electrons(std::span<const Return> returns, double ambient_e_per_s) const;
  /// Variance of the measurements [e^2] (K), before any clipping.
  Eigen::VectorXd variance_e2(std::span<const Return> returns, double ambient_e_per_s) const;

 private:
  Eigen::VectorXd tap_correlation(double depth_bin) const;

  int samples_ = 0;
  int taps_ = 1;
  double contrast_ = 1.0;
  Eigen::VectorXd sensitivity_;  // of the tap values; 1 but for tap_mismatch
  double dark_current_e_per_s_ = 0.0;
  double tap_constant_variance_e2_ = 0.0;
  std::vector<CorrelationFunction> functions_;  // of the tap values, before taps mix
  Eigen::VectorXd tap_ambient_gain_, ambient_gain_;
  Eigen::VectorXd tap_exposure_s_, exposure_s_;
  Eigen::MatrixXd readout_;
};

/// Harmonics of the correlation function kept for `samples` per period, where an arm is limited.
int harmonics_kept(int samples);

/// What leaves the sensor as sums of tap values, (K, tap values): each by itself, or A - B of every
/// two neighbours.
Eigen::MatrixXd readout_matrix(int tap_values, Readout readout);

/// Variance of one tap value that does not depend on light [e^2]: read noise and quantization.
double constant_variance_e2_of(const Sensor& sensor);

/// kappa (K) as an estimator on this camera has to reckon with it: 0 for all differences of buckets
/// if the brightest operating ambient leaks into none of them by more than 5 % of its noise, as
/// where a generator rounds duties of 1/2. To hold such a leak to be unknown would cost a whole
/// measurement; to ignore it costs next to nothing. Else ambient_gain().
Eigen::VectorXd unknown_ambient_gain(const ForwardModel& model, const Camera& camera);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tofsmith/camera/forward_model.hpp"

namespace tofsmith {

/// Light that trails off behind the direct return, as in haze or translucent things: after a delay
/// u behind it comes ratio / mean exp(-u / mean) of its signal per unit of u.
struct ExponentialTail {
  double mean_delay_m = 0.5;  ///< [m], > 0 and at most the range of the period
  double ratio = 0.3;         ///< signal of all of the tail over that of the direct return, >= 0

  /// @throws std::invalid_argument naming field, value and rule
  void validate(double range_m) const;
};

/// A measured response of a scene to one short pulse: light by distance, as a histogram.
struct Transient {
  std::vector<double> light;  ///< of each bin, >= 0, any unit; a pixel's signal is shared out so
  double bin_m = 0.0;         ///< depth that one bin takes, c / 2 times its time [m], > 0
  double first_m = 0.0;       ///< depth at which bin 0 begins, behind the pixel's depth [m]

  /// Sum of all bins.
  double total() const;
  /// Every bin as a return at its middle, with its share of `signal_e_per_s`; empty bins left out.
  /// @param depth_bin  of the pixel
  std::vector<Return> returns(double depth_bin, double signal_e_per_s, double camera_bin_m) const;

  /// Finite bins that are not negative, with some light, no longer together than the range.
  /// @throws std::invalid_argument naming bin, value and rule
  void validate(double range_m) const;
};

/// What tap values see of unit light that trails off, (points, E x taps): chi averaged over
/// exponential delays, row j for a direct return at depth j N / points (see
/// ForwardModel::tap_correlation_table), exact for chords between rows.
Eigen::MatrixXd tap_tail_table(const ForwardModel& model, const ExponentialTail& tail,
                               double range_m, int points);

/// What tap values see of unit light spread as a transient, (points, E x taps), row j for a pixel
/// at depth j N / points. The histogram is resampled onto the rows: constant within its bins, exact
/// for chords between rows; it wraps at the period, as the light does.
Eigen::MatrixXd tap_transient_table(const ForwardModel& model, const Transient& transient,
                                    double range_m, int points);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/shared/random.hpp"
#include "simulate/fine_correlation.hpp"
#include "simulate/noise.hpp"
#include "tofsmith/camera/forward_model.hpp"

namespace tofsmith {

/// Simulates expected electrons, noise and read-out of one pixel at a time.
class PixelCapture {
 public:
  PixelCapture(const ForwardModel& model, const Camera& camera);

  int measurements() const {
    return rows_ ? static_cast<int>(rows_->rows()) : noise_.measurements(correlation_.tap_values());
  }
  int tap_values() const { return correlation_.tap_values(); }

  /// @param depth_m  wraps at the range; NaN: no return, requires signal_e_per_s = 0
  /// @param work  (tap values), overwritten
  /// @param raw  (measurements), overwritten
  void operator()(double depth_m, double signal_e_per_s, double ambient_e_per_s,
                  RandomStream& random, std::vector<double>& work, float* raw) const;

  /// For several returns: add_light() adds S chi of one return to `light` (tap values), and
  /// expose() exposes the sensor to the sum.
  void add_light(const FineCorrelation& correlation, double depth_m, double signal_e_per_s,
                 std::vector<double>& work, std::vector<double>& light) const;
  void add_light(double depth_m, double signal_e_per_s, std::vector<double>& work,
                 std::vector<double>& light) const {
    add_light(correlation_, depth_m, signal_e_per_s, work, light);
  }
  /// @param light  overwritten
  void expose(double ambient_e_per_s, RandomStream& random, std::vector<double>& light,
              float* raw) const;

 private:
  double range_m_, bin_m_;
  double dark_e_per_s_;
  bool is_signed_;
  FineCorrelation correlation_;
  PixelNoise noise_;
  Eigen::VectorXd exposure_s_, ambient_gain_;  // per tap value
  std::optional<Eigen::MatrixXd> rows_;        // (K, N), for rows
};

}  // namespace tofsmith

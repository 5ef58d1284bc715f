// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "design/optimize/soft_decoder.hpp"
#include "design/optimize/soft_two_return_decoder.hpp"
#include "design/optimize/trial_batch.hpp"

namespace tofsmith {

/// Depth error of a code on a grid, and its gradient by the code's correlation functions: noise is
/// drawn, y_i = mu_i + sigma_i e_i, and decoded by a soft decoder, so that the error is a
/// smooth function. The noise itself depends on the code, and the gradient knows.
///   mu_i = T_i (S chi_i(z) + A kappa_i),  sigma_i^2 = T_i (S shot_i(z) + A shot_kappa_i) +
///   constant
/// A trial may have a second return, S2 chi_i(z2) beside S chi_i(z): the error is that of z, which
/// a batch has decoded as the only return or as the first of two.
/// chi is linear between the bins of the grid.
class DepthErrorLoss {
 public:
  DepthErrorLoss(const SampledCamera& camera, MeasurementTable table, DepthErrorKind kind);

  /// Variance of a measurement [e^2], averaged over depth and measurements.
  double mean_variance_e2(const OperatingPoint& point) const;

  /// Mean error [bin] of the soft decoder, over the trials.
  /// @param sharpness  of its decisions, per unit of log likelihood, over the mean variance [1/e^2]
  double soft_error(const OperatingPoint& point, const TrialBatch& batch, double sharpness);
  /// The same; adds `weight` times the gradient at fixed sharpness.
  double soft_error(const OperatingPoint& point, const TrialBatch& batch, double sharpness,
                    double weight);
  /// Decoded positions [bin], one per trial, of the hard decoder.
  void decode(const OperatingPoint& point, const TrialBatch& batch,
              std::vector<double>& decoded_bin);

  /// What soft_error has added up.
  MeasurementTable gradient() const;

 private:
  /// A return of a trial: chords of the table it lies on.
  struct Place {
    int bin = 0, next = 0;
    double fraction = 0.0;
    double signal_e_per_s = 0.0;

    double between(const Eigen::MatrixXd& values, int i) const {
      return (1.0 - fraction) * values(bin, i) + fraction * values(next, i);
    }
  };
  /// Measurements of one trial: its electrons, and what their gradient needs.
  struct Reading {
    std::vector<Place> places;  ///< direct, and perhaps later
    std::vector<float> electrons;
    std::vector<double> deviation_e;
  };
  Place place_at(double depth_periods, double signal_e_per_s) const;
  void read(const OperatingPoint& point, const TrialBatch& batch, std::size_t trial);
  void pull_back_reading(const OperatingPoint& point, const double* normals, double weight);
  /// What decodes a batch as two returns, made when first needed; null: it is decoded as one.
  SoftTwoReturnDecoder* two_return_decoder(const TrialBatch& batch);
  double sum_errors(const OperatingPoint& point, const TrialBatch& batch, double sharpness,
                    double weight, bool with_gradient);

  const SampledCamera* camera_;
  MeasurementTable table_;
  bool circular_;
  DecodingCurve curve_;
  SoftDecoder decoder_;
  std::optional<SoftTwoReturnDecoder> two_returns_;
  CurveGradient curve_gradient_;
  MeasurementTable reading_gradient_;  // by the table, through the electrons
  Reading reading_;
  std::vector<float> by_electrons_;
};

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/shared/random.hpp"
#include "design/optimize/design_problem.hpp"
#include "design/optimize/soft_decoder.hpp"
#include "design/optimize/soft_two_return_decoder.hpp"
#include "design/optimize/trial_batch.hpp"

namespace tofsmith {

/// Depth error of a code on a grid, and its gradient w.r.t. the correlation functions, including
/// the dependence of the noise on the code. A soft decoder decodes random measurements
///   y_i = mu_i + sigma_i e_i,  mu_i = T_i (S chi_i(z) + A kappa_i),
///   sigma_i^2 = T_i (S shot_i(z) + A shot_kappa_i) + constant.
/// A second return adds S2 chi_i(z2) to S chi_i(z); z is decoded as the only return or as the first
/// of two, depending on the batch. chi is linear between bins.
class DepthErrorLoss {
 public:
  DepthErrorLoss(const SampledCamera& camera, MeasurementTable table, DepthErrorKind kind)
      : DepthErrorLoss(camera, std::move(table), camera.times(), kind) {}
  DepthErrorLoss(const SampledCamera& camera, MeasurementTable table, MeasurementTimes times,
                 DepthErrorKind kind);

  double mean_variance_e2(const OperatingPoint& point) const;

  /// Returns the mean error of the soft decoder [bin].
  /// @param sharpness  of decisions, per log likelihood, divided by the mean variance [1/e^2]
  /// @param weight  if given, adds `weight` times the gradient of the error at fixed sharpness
  double soft_error(const OperatingPoint& point, const TrialBatch& batch, double sharpness,
                    std::optional<double> weight = {});
  /// Decodes each trial by the hard decoder [bin].
  void decode(const OperatingPoint& point, const TrialBatch& batch,
              std::vector<double>& decoded_bin);

  /// Returns the accumulated gradient; also adds to the one w.r.t. the integration times (R),
  /// unless null.
  MeasurementTable gradient(Eigen::VectorXd* by_exposure_s = nullptr) const;

 private:
  struct Place {
    int bin = 0, next = 0;
    double fraction = 0.0;
    double signal_e_per_s = 0.0;
  };
  struct Reading {
    std::vector<Place> places;
    Eigen::ArrayXf electrons;
    Eigen::ArrayXd deviation_e, light_e_per_s, shot_light_e_per_s;
    Eigen::ArrayXd by_mean, by_variance;
  };
  /// Gradients w.r.t. correlation functions and the gain of ambient light.
  struct BinGradients {
    Eigen::ArrayXXd correlation;  ///< (measurements, samples)
    Eigen::ArrayXd ambient_gain;
  };
  bool has_own_shot() const { return shot_of_bin_.size() > 0; }
  Place place_at(double depth_periods, double signal_e_per_s) const;
  void add_light(const Eigen::ArrayXXd& of_bin, Eigen::ArrayXd& light_e_per_s) const;
  void read(const OperatingPoint& point, const TrialBatch& batch, std::size_t trial);
  void pull_back_reading(const OperatingPoint& point, const double* normals, double weight);
  /// Null if the batch is decoded as one return.
  SoftTwoReturnDecoder* two_return_decoder(const TrialBatch& batch);

  const SampledCamera* camera_;
  MeasurementTable table_;
  /// Correlation functions, (measurements, samples); of the shot noise: empty if equal.
  Eigen::ArrayXXd correlation_of_bin_, shot_of_bin_;
  MeasurementTimes times_;
  Eigen::VectorXd dark_variance_e2_per_s_;
  bool circular_;
  DecodingCurve curve_;
  SoftDecoder decoder_;
  std::optional<SoftTwoReturnDecoder> two_returns_;
  CurveGradient curve_gradient_;
  BinGradients by_light_, by_shot_light_;  ///< by_shot_light_ is empty if the light is equal
  Eigen::VectorXd by_exposure_s_;
  Reading reading_;
  std::vector<float> by_electrons_;
};

/// Stochastic gradient w.r.t. the waveforms and shares, from new trials in every call. The
/// objective is the smooth maximum over camera variants of the mean log error over light levels.
class StochasticGradient {
 public:
  /// @param trials  per call, in total
  StochasticGradient(const DesignProblem& problem, int trials, std::uint64_t seed,
                     std::uint64_t work_item);

  /// @param decision_sharpness  per log likelihood
  SampledCode at(const SampledCode& code, double decision_sharpness, RandomStream& random);

 private:
  double mean_log(std::size_t variant) const;
  double weight(std::size_t variant, std::size_t point) const;
  void add(std::size_t variant, std::size_t point, double error);

  const DesignProblem* problem_;
  int trials_;
  NoiseStore noise_;
  std::vector<std::vector<double>> average_error_;  // 0: not yet known
};

}  // namespace tofsmith

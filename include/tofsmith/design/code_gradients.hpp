// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <utility>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/hidden.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

struct PixelLight {
  std::span<const double> depth_bin, signal_e_per_s, ambient_e_per_s;  ///< (P) each
};

/// Gradient of a function of the measurements.
struct PixelGradient {
  MeasurementTable table;                                      ///< w.r.t. the code's table
  Eigen::VectorXd depth_bin, signal_e_per_s, ambient_e_per_s;  ///< (P)
};

/// Gradients to compute; others are zero.
struct WantedGradients {
  bool table = true;
  bool light = true;  ///< signal and ambient
  bool depth = true;
};

/// Gradient of a function of decoded depths.
template <typename Value>
struct DecodedGradient {
  MeasurementTable table;
  std::vector<Value> electrons;  ///< (P, K)
};

/// The soft decoder weights chord j between adjacent bins by
///   exp(S_j / temperature_e2) / sum,  S_j = 1/2 max(<y, p>, 0)^2 / |p|^2 at its best point p,
/// on correlation functions without the ambient component.
struct SoftDecoding {
  std::span<const double> temperature_e2;  ///< (P), > 0; e.g. the variance of y
  bool circular = false;                   ///< depths and errors wrap around
};

/// Differentiable steps from waveforms to depth, each with its adjoint, for learning codes: tables,
/// electrons, soft decoding and the Cramer-Rao bound of waveforms constant within N cells.
/// Waveforms may have any real values. Variances ignore clipping.
/// @note thread-safe; bit-identical for any number of threads
class CodeGradients {
 public:
  /// One row per pixel.
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /// @throws InvalidArgument for an invalid camera, or one with rows, generator, playback,
  ///   temperature or tap_mismatch, which depend on the waveforms
  CodeGradients(const Camera& camera, int samples, int exposures);

  int samples() const;
  int exposures() const;
  int tap_values() const;    ///< exposures x taps
  int measurements() const;  ///< K
  bool has_shot() const;     ///< tables include the light behind differences

  /// Correlation functions of waveforms (N, E) and (N, E x taps) at the bins.
  MeasurementTable measure(const Eigen::MatrixXd& modulation,
                           const Eigen::MatrixXd& demodulation) const;
  /// Gradient w.r.t. {modulation, demodulation} from that w.r.t. the table.
  std::pair<Eigen::MatrixXd, Eigen::MatrixXd> pull_back(const Eigen::MatrixXd& modulation,
                                                        const Eigen::MatrixXd& demodulation,
                                                        const MeasurementTable& by_table) const;

  /// Expected electrons and variance of the measurements (P, K), as ForwardModel.
  void electrons(const MeasurementTable& table, const PixelLight& light, Rows& mean,
                 Rows& variance) const;
  /// @param by_mean, by_variance  gradients w.r.t. both (P, K)
  PixelGradient pull_back_electrons(const MeasurementTable& table, const PixelLight& light,
                                    const Rows& by_mean, const Rows& by_variance,
                                    WantedGradients wanted = {}) const;

  /// Expected depth [bin] (P) from electrons (P, K) without dark current. Circular: the circular
  /// mean around the best match, in [0, N).
  template <typename Value>
  std::vector<double> soft_decode(const MeasurementTable& table, std::span<const Value> electrons,
                                  const SoftDecoding& decoding) const;
  /// Expected |error| [bin] (P).
  template <typename Value>
  std::vector<double> soft_error(const MeasurementTable& table, std::span<const Value> electrons,
                                 const SoftDecoding& decoding,
                                 std::span<const double> true_bin) const;
  /// Gradient of sum weight[p] soft_decode()[p], or of soft_error() if true_bin is not empty. The
  /// gradient w.r.t. a temperature is -<y, gradient w.r.t. y> / (2 temperature), because S is
  /// quadratic in y.
  template <typename Value>
  DecodedGradient<Value> pull_back_decoded(const MeasurementTable& table,
                                           std::span<const Value> electrons,
                                           const SoftDecoding& decoding,
                                           std::span<const double> true_bin,
                                           std::span<const double> weight) const;

  /// CramerRaoBound::sigma_m() of a table at 4 cells per bin (4 N, points).
  Eigen::MatrixXd depth_deviation_m(const MeasurementTable& table,
                                    std::span<const OperatingPoint> points) const;
  /// Gradient of sum by_deviation o depth_deviation_m() (elementwise) w.r.t. the table,
  /// signal_e_per_s and ambient_e_per_s (points). Infinite deviations do not contribute.
  PixelGradient pull_back_depth_deviation(const MeasurementTable& table,
                                          std::span<const OperatingPoint> points,
                                          const Eigen::MatrixXd& by_deviation) const;

  /// Electrons of dark current (K), which decoding subtracts.
  const Eigen::VectorXd& dark_electrons() const;

  struct Steps;

 private:
  Hidden<const Steps> steps_;
};

}  // namespace tofsmith

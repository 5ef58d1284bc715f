// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>

#include "decode/ambient_projection.hpp"
#include "decode/multipath/shared/bounded_quadratic.hpp"
#include "decode/output/pixel_model.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

/// Covariance of rows between bins, linear in light(at bin, at the next bin, ambient). Allocates
/// nothing per pixel.
class CorrelatedNoise {
 public:
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor,
                               max_exposure_rows, max_exposure_rows>;
  using Column = Eigen::Matrix<double, max_exposure_rows, 1>;

  explicit CorrelatedNoise(const RowCovariance& covariance);

  /// A covariance matrix or, after factorize(), the lower triangle L of L L^T.
  struct Factor {
    Matrix values;

    /// Replaces the covariance by L; returns the logarithm of its determinant.
    double factorize(int count);
    void whiten(int count, Column& column) const;
    /// Computes L^-1 matrix L^-T for a symmetric matrix.
    void whiten(int count, Matrix& matrix) const;
  };

  void at(std::int32_t bin, std::int32_t next, const Quadratic::Vector& light,
          double min_variance_e2, double variance_share, Factor& covariance) const;
  /// Returns the derivative with respect to light 0 or 1 (at that bin) or 2.
  Matrix slope(int light, std::int32_t bin, double variance_share) const;

 private:
  int measurements_;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> signal_;  // (N, pairs)
  Eigen::VectorXd ambient_, floor_;
};

struct LikelihoodPixel {
  const double* electrons = nullptr;  ///< without dark electrons (K)
  double min_variance_e2 = 0.0;       ///< lower limit of expected variances
  double variance_share = 1.0;        ///< relative to that of a single measurement
};

/// Most likely light on the chord from `bin` to the next bin. Mean and variance of each measurement
/// are linear in light(at bin, at the next bin, ambient) >= 0.
struct ChordFit {
  std::int32_t bin = 0;
  Quadratic::Vector light{};  ///< at both ends of the chord, and ambient [e/s]
  double cost = 0.0;          ///< sum_i (y_i - mu_i)^2 / v_i + log v_i

  double signal_e_per_s() const { return light[0] + light[1]; }
  Position position() const {
    const double signal = signal_e_per_s();
    return {bin, signal > 0.0 ? light[1] / signal : 0.0};
  }
  bool is_at_bin() const { return light[1] == 0.0; }
  bool is_at_next() const { return light[0] == 0.0 && light[1] > 0.0; }
};

/// Likelihood of depth, signal and ambient light on the chords between bins. For whitened
/// measurements with a remaining covariance C, linear in light, the cost is
///   (y - mu)^T C^-1 (y - mu) + log det C.
class LikelihoodModel {
 public:
  /// @param table  whitened() if the measurements are rows
  LikelihoodModel(const DecodingTable& table, const AmbientProjection& projection);

  /// Returns a pixel with its lower limit of variances: electrons are discrete, so that a dark
  /// measurement in a bright pixel does not imply zero light.
  LikelihoodPixel pixel(const double* electrons, double variance_share = 1.0) const;

  /// Returns -2 log-likelihood, up to a constant.
  double cost(const LikelihoodPixel& pixel, std::int32_t bin, const Quadratic::Vector& light) const;

  /// Minimizes sum_i weight_i (y_i - mu_i)^2 / 2 - weight_i y_i^2 / 2 on a chord.
  BoundedMinimum least_squares(const LikelihoodPixel& pixel, std::int32_t bin,
                               const double* weight) const;
  /// Minimizes the cost on a chord by Fisher scoring, starting from least squares.
  ChordFit fit(const LikelihoodPixel& pixel, std::int32_t bin, const double* weight) const;
  /// Minimizes the cost on both chords at a bin, and on further ones while it decreases.
  ChordFit fit_around(const LikelihoodPixel& pixel, std::int32_t bin, const double* weight) const;
  /// Minimizes the cost on the chords up to three bins from a fit, because one lobe can have
  /// several minima.
  ChordFit fit_near(const LikelihoodPixel& pixel, const ChordFit& found,
                    const double* weight) const;

  /// Returns light and depth of a fit, with standard deviations from the Fisher information.
  PixelEstimate estimate(const LikelihoodPixel& pixel, const ChordFit& fit) const;

 private:
  std::int32_t next(std::int32_t bin) const { return bin + 1 < samples_ ? bin + 1 : 0; }
  std::int32_t previous(std::int32_t bin) const { return bin > 0 ? bin - 1 : samples_ - 1; }
  Quadratic scoring(const LikelihoodPixel& pixel, std::int32_t bin,
                    const Quadratic::Vector& light) const;
  double correlated_cost(const LikelihoodPixel& pixel, std::int32_t bin,
                         const Quadratic::Vector& light) const;
  Quadratic correlated_scoring(const LikelihoodPixel& pixel, std::int32_t bin,
                               const Quadratic::Vector& light) const;

  int samples_, measurements_;
  int unknowns_;  // 2 if ambient light cancels, else 3
  Eigen::VectorXd ambient_;
  RowMajorMatrix gated_;  // x = T o chi (N, K)
  ExpectedNoise noise_;
  std::optional<CorrelatedNoise> correlated_;  // none: independent measurements
};

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "decode/ambient_projection.hpp"
#include "decode/expected_noise.hpp"
#include "decode/search/direction_table.hpp"
#include "decode/search/smooth_curve.hpp"
#include "tofsmith/decode/range_part.hpp"

namespace tofsmith {

/// A depth between bins: `fraction` of the way from bin `bin` to the next one.
struct Position {
  std::int32_t bin = 0;
  double fraction = 0.0;

  /// Of a depth in [0, samples).
  static Position at(double depth_bin) {
    const auto bin = static_cast<std::int32_t>(depth_bin);
    return {bin, depth_bin - bin};
  }
  /// In [0, samples).
  double in_rows(int samples) const {
    const double position = bin + fraction;
    return position < samples ? position : position - samples;
  }
};

/// What a pixel's measurements say once its depth is known.
struct PixelEstimate {
  double signal_e_per_s = 0.0;
  double ambient_e_per_s = 0.0;  ///< NaN where it cannot be seen
  double signal_standard_deviation_e_per_s = 0.0;
  double depth_standard_deviation_row = 0.0;  ///< infinite where depth has no slope
};

/// The curve P x(z) as chords between bins, and the noise on it.
class PixelModel {
 public:
  PixelModel(const DecodingTable& table, const AmbientProjection& projection);

  int measurements() const { return static_cast<int>(projection_.basis.rows()); }
  int rank() const { return projection_.rank(); }

  /// Residual of electrons - dark (K) without ambient light, in the plane (rank); exactly 0
  /// where that is rounding.
  void project(const double* electrons, double* plane) const;

  /// Best point on the chords left and right of the best bin, for a vector in the plane (rank).
  ///   beta_j = <q, p_j>, Q_jk = <p_j, p_k>; u = Q11 b0 - Q01 b1, v = Q00 b1 - Q01 b0,
  ///   t* = v / (u + v) where both are > 0; else no point of the chord beats its better end.
  /// On a smooth curve instead the maximum of the pixel's own correlation (DepthPolynomials).
  Position refine(const double* plane, std::int32_t bin) const;

  /// Returns the highest local maximum of the score <q, p> / |p| within a part of the range; none
  /// if there is no local maximum.
  std::optional<Position> best_within(const double* plane, const RangePart& part) const;

  /// Least squares of electrons - dark (K) on x at the position and on ambient light, without
  /// weights; its deviations from the noise expected there. Also fills the noise, `variance_e2`
  /// (K), of every measurement.
  /// @param variance_share  of the noise of a single measurement
  PixelEstimate estimate(const double* electrons, const double* plane, const Position& position,
                         double* variance_e2, double variance_share = 1.0) const;

  /// Standard deviation of <difference, q> for a vector in the plane (rank).
  double deviation_along(const double* difference, const double* variance_e2) const;

 private:
  /// A point beyond neither end of a chord that beats both ends; score <= 0 if there is none.
  struct ChordPoint {
    double fraction = 0.0;
    double score = 0.0;
  };
  /// <q, slope>, <q, bend> and <q, asymmetry> at a row of a smooth curve.
  struct Rise {
    double g, b, c;
  };
  Rise rise_at(const double* plane, std::int32_t row) const;
  double signal_on_curve(const double* plane, const Position& position) const;
  double score_at(const double* plane, std::int32_t row) const;
  double score_at(const double* plane, const Position& position) const;
  ChordPoint best_inside(std::int32_t bin, double at_bin, double at_next) const;
  std::int32_t next(std::int32_t bin) const { return bin + 1 < samples_ ? bin + 1 : 0; }
  std::int32_t previous(std::int32_t bin) const { return bin > 0 ? bin - 1 : samples_ - 1; }
  double along(const double* plane, std::int32_t bin) const;

  int samples_;
  AmbientProjection projection_;
  std::optional<DepthPolynomials> polynomials_;  // none: depths lie on chords
  RowMajorMatrix basis_;                         // from electrons, row by row
  RowMajorMatrix noise_basis_;                   // from what has the noise
  ExpectedNoise noise_;
  Eigen::VectorXd own_;        // <p_j, p_j>
  Eigen::VectorXd with_next_;  // <p_j, p_{j+1}>
};

}  // namespace tofsmith

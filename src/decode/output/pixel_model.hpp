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

/// A depth between a bin and the next one.
struct Position {
  std::int32_t bin = 0;
  double fraction = 0.0;

  static Position at(double depth_bin) {
    const auto bin = static_cast<std::int32_t>(depth_bin);
    return {bin, depth_bin - bin};
  }
  double in_rows(int samples) const {
    const double position = bin + fraction;
    return position < samples ? position : position - samples;
  }
};

struct PixelEstimate {
  double signal_e_per_s = 0.0;
  double ambient_e_per_s = 0.0;  ///< NaN if it cancels in the measurements
  double signal_standard_deviation_e_per_s = 0.0;
  double depth_standard_deviation_row = 0.0;  ///< infinite if the curve has no slope
};

/// The curve P x(z), and its noise.
class PixelModel {
 public:
  PixelModel(const DecodingTable& table, const AmbientProjection& projection);

  int measurements() const { return static_cast<int>(projection_.basis.rows()); }
  int rank() const { return projection_.rank(); }

  /// Projects electrons - dark (K) into the subspace (rank); exactly 0 for rounding errors.
  void project(const double* electrons, double* plane) const;

  /// Returns the best point on both chords at the best bin, for a vector in the subspace (rank).
  ///   beta_j = <q, p_j>, Q_jk = <p_j, p_k>; u = Q11 b0 - Q01 b1, v = Q00 b1 - Q01 b0,
  ///   t* = v / (u + v) if both are > 0; otherwise the better end of the chord is best.
  /// On a smooth curve, returns the maximum of the pixel's own correlation (DepthPolynomials).
  Position refine(const double* plane, std::int32_t bin) const;

  /// Returns the highest local maximum of <q, p> / |p| within a part of the range, if any.
  std::optional<Position> best_within(const double* plane, const RangePart& part) const;

  /// Fits electrons - dark (K) by x at the position and ambient light with unweighted least
  /// squares, and computes standard deviations. Writes the variances of the measurements to
  /// `variance_e2` (K).
  /// @param variance_share  variance relative to a single measurement
  PixelEstimate estimate(const double* electrons, const double* plane, const Position& position,
                         double* variance_e2, double variance_share = 1.0) const;

  /// Returns the standard deviation of <difference, q>.
  double deviation_along(const double* difference, const double* variance_e2) const;

 private:
  /// Point whose score exceeds that of both ends of a chord; score <= 0 if there is none.
  struct ChordPoint {
    double fraction = 0.0;
    double score = 0.0;
  };
  /// <q, slope>, <q, bend> and <q, asymmetry> at a row.
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
  RowMajorMatrix basis_;                         // for electrons, row by row
  RowMajorMatrix noise_basis_;                   // for measurements with noise of the table
  ExpectedNoise noise_;
  Eigen::VectorXd own_;        // <p_j, p_j>
  Eigen::VectorXd with_next_;  // <p_j, p_{j+1}>
};

}  // namespace tofsmith

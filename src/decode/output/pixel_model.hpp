// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "decode/ambient_projection.hpp"
#include "decode/search/direction_table.hpp"
#include "decode/search/smooth_curve.hpp"
#include "tofsmith/decode/decoder.hpp"
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

struct PixelResidual {
  /// Chi-square per degree of freedom; NaN without degrees of freedom.
  double per_freedom = std::numeric_limits<double>::quiet_NaN();
  bool is_inconsistent = false;
};

/// Tests whether some light at the decoded depth explains the measurements of a pixel.
///
/// Let y be the measurements, D the diagonal matrix of their variances at the estimated light, and
/// B = [a, x(z), x'(z)] the directions of ambient light, signal and depth. For normal noise,
///   chi^2 = min_b (y - B b)^T D^-1 (y - B b)
/// is chi-square distributed with K - rank B degrees of freedom, to first order for any depth
/// estimate within its noise.
///
/// A model error e increases chi by at most |D^-1/2 e| = d, and the quantile of a shifted chi by at
/// most sqrt(q) d^2 / 2. A pixel is therefore inconsistent if
///   chi > sqrt(q) + min(d, sqrt(q) d^2 / 2),  d = m S / sqrt(lambda),
/// with the chi-square quantile q of the false-alarm rate, the tolerated |e| = m S, and the least
/// variance lambda in any direction perpendicular to B. The interpolation error between rows counts
/// as a model error.
class ResidualModel {
 public:
  /// Threshold at a bin; infinite (except `per_freedom`) if no residual is too large.
  struct Limit {
    /// Lower bounds of q lambda: per signal, per ambient light, and without light.
    double of_signal = 0.0, of_ambient = 0.0, of_floor = std::numeric_limits<double>::infinity();
    double error = 0.0;                                             ///< m, per signal
    double root = std::numeric_limits<double>::infinity();          ///< sqrt(q)
    double per_freedom = std::numeric_limits<double>::quiet_NaN();  ///< 1 / degrees of freedom
  };

  ResidualModel(const DecodingTable& table, const AmbientProjection& projection,
                const DecodeOptions& options);

  /// Orthonormal directions W^T u (K, count) that contain only noise. W is the whitening matrix, if
  /// any.
  const Eigen::MatrixXd& off_plane() const { return off_plane_; }
  /// u, for whitened measurements.
  const Eigen::MatrixXd& off_plane_noise() const { return off_plane_noise_; }
  /// Unit vector for whitened measurements (K); 0 if ambient light cancels.
  const Eigen::VectorXd& ambient_direction() const { return ambient_; }
  /// q / 2, maximum over bins; 0 if no pixel can be inconsistent.
  double half_quantile() const { return half_quantile_; }
  const std::vector<Limit>& limits() const { return limits_; }

  /// @param electrons  without dark electrons (K)
  /// @param variance_share  relative to the variance of a single measurement
  PixelResidual residual(const double* electrons, const PixelEstimate& estimate,
                         const Position& position, double variance_share) const;

 private:
  int degrees_of_freedom(bool has_slope) const {
    return free_measurements_ - (ambient_.isZero(0.0) ? 1 : 2) - (has_slope ? 1 : 0);
  }
  /// Curve around a row, whitened and without ambient light (K).
  struct Course {
    Eigen::VectorXd point;
    Eigen::VectorXd slope;   ///< 0 without one
    bool has_slope = false;  ///< on either side
    /// Neither side's slope explains noise across a corner.
    bool is_corner = false;
    double error = 0.0;  ///< of interpolation, perpendicular to point and slope
  };
  Course course_on_chords(std::int32_t row) const;
  /// @param half_way  points half a row after each row (N, rank)
  Course course_on_curve(std::int32_t row, const RowMajorMatrix& half_way) const;
  Limit limit_at(std::int32_t row, const RowMajorMatrix& half_way,
                 const DecodeOptions& options) const;
  using PerMeasurement = std::array<double, max_measurements>;
  /// The directions of signal and depth may include a component along ambient light.
  void find_tangent(const Position& position, PerMeasurement& point, PerMeasurement& slope) const;
  std::int32_t next(std::int32_t bin) const { return bin + 1 < samples_ ? bin + 1 : 0; }
  std::int32_t previous(std::int32_t bin) const { return bin > 0 ? bin - 1 : samples_ - 1; }

  int samples_, measurements_;
  int free_measurements_;      // with noise
  Eigen::MatrixXd whitening_;  // (K, K), or empty
  Eigen::MatrixXd noiseless_;  // without noise, for whitened measurements
  RowMajorMatrix curve_;       // x, whitened (N, K)
  Eigen::VectorXd ambient_;
  std::optional<DepthPolynomials> polynomials_;  // none: positions lie on chords
  RowMajorMatrix plane_curve_;                   // p (N, rank) of smooth curves
  RowMajorMatrix noise_basis_;
  Eigen::MatrixXd off_plane_, off_plane_noise_;
  ExpectedNoise noise_;
  std::array<double, 3> least_noise_;  // per signal, per ambient light, and without light
  std::vector<Limit> limits_;
  double half_quantile_ = 0.0;
};

}  // namespace tofsmith

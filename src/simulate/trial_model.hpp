// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "decode/search/shared/bin_records.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

/// See PixelNoise.
struct TapConversion {
  bool is_poisson = false;
  bool has_adc = false;
  bool is_difference = false;  ///< neighbouring taps are output as A - B
  bool is_signed = false;      ///< mixer: clipped at both signs
  float read_noise_e = 0.0f;
  float full_well_e = 0.0f;  ///< infinite: no limit
  float dn_per_e = 0.0f;
  float black_level_dn = 0.0f;
  float min_dn = 0.0f;
  float max_dn = 0.0f;
};

/// Electrons of a pixel's taps at any depth, in a layout for trials. Tap j has
///   mean     S x_j(z) + A a_j + d_j     [e]
///   variance S x'_j(z) + A a'_j + d'_j + c_j  [e^2]
/// with x = T chi in records of many rows per bin, interpolated linearly. For a code, shot noise
/// equals the mean, and both are limited to >= 0. A table of differences and a mixer have separate
/// shot noise; each number of a mixer counts as a tap here.
class TrialModel {
 public:
  /// Uses at least 16 rows per bin.
  TrialModel(const ForwardModel& model, const Camera& camera);
  /// For the depths of rows only; RowTrials draws the measurements.
  explicit TrialModel(const ForwardModel& model);
  /// Normal noise, chords between the rows of a table.
  explicit TrialModel(const DecodingTable& table);

  int taps() const { return taps_; }
  int measurements() const { return static_cast<int>(raw_per_e_.rows()); }
  int samples() const { return samples_; }
  int rows_per_bin() const { return rows_per_bin_; }
  int rows() const { return samples_ * rows_per_bin_; }
  bool has_own_shot_noise() const { return has_own_shot_noise_; }
  /// x (taps), its change to the next row, and both for x' if it differs from x.
  const RecordTable& records() const { return records_; }
  const TapConversion& conversion() const { return conversion_; }
  /// Returns true if raw numbers are affine in normal electrons, hence any projection is normal.
  bool is_linear() const;

  /// If is_linear(): raw_per_e (K, taps) and raw_at_zero (K).
  const Eigen::MatrixXd& raw_per_e() const { return raw_per_e_; }
  const Eigen::VectorXd& raw_at_zero() const { return raw_at_zero_; }
  /// A a + d (taps).
  Eigen::VectorXd mean_floor_e(double ambient_e_per_s) const;
  /// A a' + d' (taps), without c.
  Eigen::VectorXd shot_floor_e2(double ambient_e_per_s) const;
  /// c (taps).
  const Eigen::VectorXd& constant_variance_e2() const { return constant_variance_e2_; }
  /// T per tap [s].
  const Eigen::VectorXd& exposure_s() const { return exposure_s_; }

 private:
  TrialModel(const ForwardModel& model, const Camera& camera, const Eigen::MatrixXd& sums);
  void fill_records(const Eigen::MatrixXd& mean, const Eigen::MatrixXd& shot);

  int taps_, samples_, rows_per_bin_;
  bool has_own_shot_noise_;
  Eigen::VectorXd exposure_s_, ambient_e_, dark_e_, shot_ambient_e_, shot_dark_e_;
  Eigen::VectorXd constant_variance_e2_;
  Eigen::MatrixXd raw_per_e_;
  Eigen::VectorXd raw_at_zero_;
  TapConversion conversion_;
  RecordTable records_;
};

}  // namespace tofsmith

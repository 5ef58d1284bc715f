// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "tofsmith/camera/forward_model.hpp"

namespace tofsmith {

/// Everything a decoder needs to know of a code on a camera. Measurements are what leaves the
/// sensor (K of them: one per tap, or the differences of two-bucket pairs):
///   expected electrons  mu_i(z) = T_i (S chi_i(z) + A kappa_i) + dark_i
///   electrons           = (raw_i - black_level_i) * gain_e_per_raw_i
///   variance            = T_i (S shot_chi_i(z) + A shot_kappa_i) + shot_dark_i + constant_i
/// The shot terms are those of the light collected; they differ from the expected values where
/// buckets are subtracted. Left empty they are the same. Duties, exposures, gains and offsets may
/// differ from measurement to measurement.
struct DecodingTable {
  Eigen::MatrixXd correlation;     ///< chi, (N, K), row n at depth_bin = n
  Eigen::VectorXd ambient_gain;    ///< kappa (K)
  Eigen::VectorXd exposure_s;      ///< T [s] (K), each > 0
  Eigen::VectorXd dark_electrons;  ///< expected electrons without any light [e] (K)

  Eigen::MatrixXd shot_correlation;      ///< (N, K), or empty: correlation
  Eigen::VectorXd shot_ambient_gain;     ///< (K), or empty: ambient_gain
  Eigen::VectorXd shot_dark_electrons;   ///< [e] (K), or empty: dark_electrons
  Eigen::VectorXd constant_variance_e2;  ///< of read-out and quantization [e^2] (K), each >= 0

  Eigen::VectorXd black_level;            ///< raw number without light (K); 0 where it is electrons
  Eigen::VectorXd gain_e_per_raw;         ///< electrons per raw number (K), each > 0
  std::optional<float> saturation_level;  ///< raw numbers from here on are clipped; none: no limit
  double range_m = 0.0;                   ///< depth of a whole period [m], > 0

  int samples() const { return static_cast<int>(correlation.rows()); }
  int measurements() const { return static_cast<int>(correlation.cols()); }
  /// Depth of one bin [m].
  double bin_m() const { return range_m / samples(); }

  /// Whether depths can be told apart at all: shapes agree, everything is finite, there are 3 to 64
  /// measurements (2 are enough where ambient light cancels), and the correlation without what
  /// ambient light explains has rank >= 2 and at least two different directions.
  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};

/// The table of a code on a camera. Raw numbers are electrons without ADC, else counts; differences
/// of buckets are taken from converted values, so that the black level cancels and saturation does
/// not show in them.
DecodingTable make_decoding_table(const ForwardModel& model, const Camera& camera);

/// The table of a measured correlation (N, K) that comes without a camera: equal duties and
/// exposures, so that the mean over measurements is what ambient light explains. Signal and ambient
/// are then in raw numbers, of which noise is taken as if they were electrons.
DecodingTable make_decoding_table(const Eigen::MatrixXd& correlation, double range_m);

/// Why no depth can be told from what `table` measures, though its numbers are in order: too few
/// measurements or too many, or a correlation that leaves depth, signal and ambient light mixed up.
/// None: depth can be told.
std::optional<std::string> why_not_decodable(const DecodingTable& table);

/// Two depths that look the same in every measurement once ambient light is unknown.
struct AmbiguousDepths {
  int first_bin = 0;   ///< the lower one; the decoder always answers with it
  int second_bin = 0;  ///< the higher one
  double first_m = 0.0;
  double second_m = 0.0;
};

/// Every depth whose direction equals that of a lower depth, paired with the lowest such, by
/// increasing second_bin. Depths without contrast (all measurements alike, as two words of one-tap
/// Gray codes) have no direction and are left out.
std::vector<AmbiguousDepths> ambiguous_depths(const DecodingTable& table);

}  // namespace tofsmith

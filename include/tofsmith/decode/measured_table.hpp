// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string_view>

#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

/// What constant light adds to the measurements of a measured table.
enum class MeasuredAmbient {
  equal,  ///< the same to all, as with equal duties; it cancels in differences of taps
  mean,   ///< as much as the mean of the column over the period: right for any duties, if the
          ///< columns are 0 where no light is
  none,   ///< nothing: the columns are differences already
};

/// "equal", "mean", "none".
std::string_view name_of(MeasuredAmbient ambient);
/// @throws std::invalid_argument for any other word
MeasuredAmbient parse_measured_ambient(std::string_view name);
/// kappa (K) of the columns of a correlation (N, K).
Eigen::VectorXd ambient_gain_of(const Eigen::MatrixXd& correlation, MeasuredAmbient ambient);

/// Correlation functions that a delay sweep measured, with what is known of the measurements. Where
/// a list is empty the camera says it.
struct MeasuredTable {
  /// chi (N, K) up to one common factor, row n at depth_bin = n, the end point left out. Values may
  /// be negative. A constant along ambient_gain changes no depth, only the ambient light found.
  Eigen::MatrixXd correlation;
  int taps = 1;                    ///< columns hold the taps of an exposure side by side
  Eigen::VectorXd ambient_gain;    ///< kappa (K), or empty: equal
  Eigen::VectorXd exposure_s;      ///< T [s] (K), each > 0, or empty: the camera's
  Eigen::VectorXd black_level;     ///< raw number without light (K), or empty: the camera's
  Eigen::VectorXd gain_e_per_raw;  ///< electrons per raw number (K), or empty: the camera's

  int samples() const { return static_cast<int>(correlation.rows()); }
  int columns() const { return static_cast<int>(correlation.cols()); }

  /// Whether the sizes agree. @throws std::invalid_argument naming field, value and rule
  void validate() const;
};

/// The table of measured correlation functions on a camera, which gives range, noise, saturation
/// and read-out: differences of taps where it reads differences. Its samples, waveforms and
/// impulse responses do not count: they are in the measurement.
///
/// Signal is found in multiples of what the table was measured with. Shot noise is that of the
/// expected electrons; for a column that goes below 0, whose light is not known, that of its
/// largest magnitude, as if two buckets had shared so much.
/// @throws std::invalid_argument if table or camera are invalid or do not fit
DecodingTable make_decoding_table(const MeasuredTable& measured, const Camera& camera);

}  // namespace tofsmith

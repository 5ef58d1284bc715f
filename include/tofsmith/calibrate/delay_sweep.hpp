// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tofsmith/calibrate/instrument_table.hpp"
#include "tofsmith/core/array.hpp"
#include "tofsmith/io/measured_table_file.hpp"

namespace tofsmith {

/// What a delay is told in.
enum class DelayUnit { second, metre, bin, period };

/// "s", "m", "bin" or "period"; "ns" and the like through seconds_per_unit().
/// @throws std::invalid_argument for any other word
DelayUnit parse_delay_unit(std::string_view word);

/// Frames of a flat target at known delays, in the order in which they were taken.
struct DelaySweep {
  std::vector<double> delay_periods;  ///< of each frame (F), any real
  RawFrames frames;                   ///< (F, H, W, K) raw numbers; H = W = 1 for a table of means
  std::vector<std::string> notes;

  /// Whether sizes agree and delays run through a whole period without a gap.
  /// @throws std::invalid_argument naming what is missing
  void validate() const;
};

/// What the file of a sweep does not say.
struct DelaySweepOptions {
  std::filesystem::path shifts;  ///< delays of a stack of frames: text of one column, or .npy
  DelayUnit unit = DelayUnit::second;
  double unit_scale = 1.0;                 ///< in `unit` of one number of the file
  double fundamental_frequency_hz = 15e6;  ///< f0: a period is 1/f0, or c/(2 f0) in metres
  int samples = 240;                       ///< N, bins of a period
  DecimalMark decimal = DecimalMark::automatic;
  MeasuredTableOptions table;  ///< how an array (N, K) without delays is read
};

/// Reads a delay sweep:
///   - text: delay and K values per row,
///   - .npy or .npz of shape (F, H, W, K) beside a list of F shifts,
///   - .npy or .npz of shape (N, K): equal steps of one period, see read_measured_table().
/// @throws IoError naming file and place for what does not fit
DelaySweep read_delay_sweep(const std::filesystem::path& path, const DelaySweepOptions& options);

}  // namespace tofsmith

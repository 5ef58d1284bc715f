// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tofsmith/calibrate/instrument_table.hpp"

namespace tofsmith {

/// What an instrument recorded of a response, equally spaced in time.
struct ResponseRecord {
  Eigen::VectorXd values;     ///< in units of the instrument
  double time_step_s = 0.0;   ///< [s], > 0
  double start_time_s = 0.0;  ///< of the first value [s]
  bool counts = false;        ///< values are numbers of photons, whose variance is their mean
  std::vector<std::string> notes;
};

/// What the file of a record does not say.
struct ResponseRecordOptions {
  std::optional<double> time_step_s;  ///< [s], > 0; needed for values without times
  std::optional<double>
      time_unit_s;     ///< [s] of one unit of the time column; none: its name's, or 1
  std::string column;  ///< name or number (from 1) of the values; "": the only one
  DecimalMark decimal = DecimalMark::automatic;
};

/// Reads text (see instrument_table.hpp) with times and values, or values alone, or a NumPy array
/// of one axis. Times that are not equally spaced are resampled onto their median step along
/// straight lines, with a note. Whole numbers from 0 on are taken as counts.
/// @throws IoError naming file and line for times that do not rise, a gap of more than 10 steps, a
///         value that is not finite, several columns of values without a choice, or fewer than 16
ResponseRecord read_response_record(const std::filesystem::path& path,
                                    const ResponseRecordOptions& options = {});

}  // namespace tofsmith

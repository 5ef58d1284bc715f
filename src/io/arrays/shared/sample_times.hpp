// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/io/number_table.hpp"

namespace tofsmith {

/// Properties of a record that its table may lack.
struct SampleTimeOptions {
  std::optional<double> time_step_s;  ///< then no times are read
  std::optional<double> time_unit_s;  ///< of a column of times whose name has no unit
  std::string column;                 ///< name or number of the column of values
};

/// A recorded signal.
struct TimedSamples {
  Eigen::VectorXd values;
  Eigen::VectorXd time_s;  ///< one per value; empty if the table has no times
  std::vector<std::string> notes;
};

/// Finds values and times in a table: a column of times, or values alone or next to a sample
/// counter with the sampling interval in the header.
/// @throws IoError if the column of values is open, or a counter comes without a sampling interval
TimedSamples timed_samples_of(const NumberTable& table, const std::string& file,
                              const SampleTimeOptions& options);

/// Returns whether a column has no unit of time and increases by 1 from row to row.
bool counts_samples(const NumberTable& table, Eigen::Index column);

/// Returns whether the name of a column is "time" or has a unit of time.
bool is_named_time(const NumberTable& table, Eigen::Index column);

}  // namespace tofsmith

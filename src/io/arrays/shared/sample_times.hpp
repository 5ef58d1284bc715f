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

/// Properties that a table may not contain.
struct SampleTimeOptions {
  std::optional<double> time_step_s;  ///< if set, times in the table are ignored
  std::optional<double> time_unit_s;  ///< of a column of times without unit
  std::string column;                 ///< name or number of the column of values
};

struct TimedSamples {
  Eigen::VectorXd values;
  Eigen::VectorXd time_s;  ///< one per value; empty if the table has no times
  std::vector<std::string> notes;
};

/// Finds values and times in a table: a column of times, or values with the sampling interval in
/// the header.
/// @throws IoError if the column of values is ambiguous, or the interval of a counter missing
TimedSamples timed_samples_of(const NumberTable& table, const std::string& file,
                              const SampleTimeOptions& options);

/// Returns true if a column has no unit of time and increases by 1 per row.
bool counts_samples(const NumberTable& table, Eigen::Index column);

bool is_named_time(const NumberTable& table, Eigen::Index column);

}  // namespace tofsmith

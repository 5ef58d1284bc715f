// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/depth_error.hpp"

#include "simulate/trial_errors.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

Estimate table_depth_error_m(const DecodingTable& table, const OperatingPoint& light,
                             std::int64_t trials, std::uint64_t seed) {
  const EvaluateOptions options{.trials = trials, .seed = seed};
  const DepthTrials of_table(table, light, options);
  return sum_errors(of_table, of_table.first_rounds(), 0.0, {}).front().circular(table.bin_m());
}

}  // namespace tofsmith

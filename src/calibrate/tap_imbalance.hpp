// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "tofsmith/core/statistics.hpp"

namespace tofsmith {

/// Sensor::tap_mismatch of each exposure of two taps, whose changes with delay are opposite: that
/// of the second over that of the first is -(1 - m / 2) / (1 + m / 2).
/// @param notes  gets one where taps differ, or where they are not opposite
std::vector<Estimate> tap_imbalance(const Eigen::MatrixXd& table, const Eigen::MatrixXd& error,
                                    std::vector<std::string>& notes);

}  // namespace tofsmith

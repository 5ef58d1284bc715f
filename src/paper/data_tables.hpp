// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "tofsmith/io/npy.hpp"

namespace tofsmith {

/// A table of numbers with named columns, as CSV.
std::string csv_text(const std::vector<std::string>& columns,
                     const std::vector<std::vector<double>>& rows);
/// The same with a name in front of every row, under the column `label`.
std::string csv_text(const std::string& label, const std::vector<std::string>& row_names,
                     const std::vector<std::string>& columns,
                     const std::vector<std::vector<double>>& rows);

/// A matrix (rows, columns) or a vector (n), for an NPZ file.
NpyArray npy_of(const Eigen::MatrixXd& matrix);
NpyArray npy_of(const std::vector<double>& values);

}  // namespace tofsmith

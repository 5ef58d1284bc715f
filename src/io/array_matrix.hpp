// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string_view>

#include "tofsmith/io/npy.hpp"

namespace tofsmith {

/// An array of shape (rows, columns) as a matrix.
/// @param place  what errors call it, such as "code.npz: modfs"
/// @throws IoError if it has another number of axes, an empty one, or a value that is not finite
Eigen::MatrixXd matrix_of(const NpyArray& array, std::string_view place);

/// The matrix as a float64 array of shape (rows, columns).
NpyArray array_of(const Eigen::MatrixXd& matrix);

}  // namespace tofsmith

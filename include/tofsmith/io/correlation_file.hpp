// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>

namespace tofsmith {

/// Reads correlation functions, sampled on one period with the end point left out, as (N, K):
/// text (.csv, .txt) with K columns, a NumPy array (.npy) of shape (N, K) or (N,), or the array
/// `corrfs` of an archive (.npz).
/// @throws IoError naming the place for values that are not finite, or N < 8
Eigen::MatrixXd read_correlation_functions(const std::filesystem::path& path);

}  // namespace tofsmith

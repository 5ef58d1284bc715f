// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>

namespace tofsmith {

/// Fewest samples of a period, as of a camera.
inline constexpr Eigen::Index fewest_samples = 8;

/// The matrix of correlation functions in a file as it stands there: text (.csv, .txt), a NumPy
/// array (.npy), or the array `corrfs` of an archive (.npz).
/// @throws IoError naming the place for another shape or a value that is not finite
Eigen::MatrixXd correlation_matrix_of(const std::filesystem::path& path);

}  // namespace tofsmith

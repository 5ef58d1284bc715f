// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/design/correlation_target.hpp"

namespace tofsmith {

/// Reads correlation functions, sampled on one period with the end point left out, as (N, K):
/// text (.csv, .txt) with K columns, a NumPy array (.npy) of shape (N, K) or (N,), or the array
/// `corrfs` of an archive (.npz).
/// @throws IoError naming the place for values that are not finite, or N < 8
Eigen::MatrixXd read_correlation_functions(const std::filesystem::path& path);

/// Whether a target is named by a file that read_correlation_functions() reads, by its extension.
bool is_correlation_table(const std::string& name_or_path);

/// What `--target` names, as correlation functions to factorize on the camera's samples: a table
/// (is_correlation_table()), else a family or a code file,
/// whose ideal correlation functions are meant (ideal_camera()).
/// @param normalize  of a table: rescale every column to [0, 1]
/// @throws IoError as read_correlation_functions() and load_code(); std::invalid_argument for a
///         code that is to be normalized, or one of several taps
TargetSet load_target(const std::string& name_or_path, const Camera& camera,
                      bool normalize = false);

}  // namespace tofsmith

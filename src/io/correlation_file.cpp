// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/correlation_file.hpp"

#include <fmt/format.h>

#include "io/correlation_matrix.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

Eigen::MatrixXd read_correlation_functions(const std::filesystem::path& path) {
  Eigen::MatrixXd functions = correlation_matrix_of(path);
  if (functions.rows() < fewest_samples)
    throw IoError(path.string(), fmt::format("found {} samples of the period; expected at least {}",
                                             functions.rows(), fewest_samples));
  return functions;
}

}  // namespace tofsmith

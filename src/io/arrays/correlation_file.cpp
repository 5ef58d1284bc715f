// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/measured_table_file.hpp"

#include <fmt/format.h>

#include "io/arrays/shared/array_matrix.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/code_file.hpp"

namespace tofsmith {

Eigen::MatrixXd read_correlation_functions(const std::filesystem::path& path) {
  Eigen::MatrixXd functions = correlation_matrix_of(path);
  if (functions.rows() < fewest_samples)
    throw IoError(path.string(), fmt::format("found {} samples of the period; expected at least {}",
                                             functions.rows(), fewest_samples));
  return functions;
}

bool is_correlation_table(const std::string& name_or_path) {
  const std::string extension = std::filesystem::path(name_or_path).extension().string();
  return extension == ".csv" || extension == ".txt" || extension == ".npy" || extension == ".npz";
}

TargetSet load_target(const std::string& name_or_path, const Camera& camera, bool normalize) {
  const std::filesystem::path path = name_or_path;
  if (is_correlation_table(name_or_path))
    return targets_from_table(path.stem().string(), read_correlation_functions(path),
                              camera.samples, normalize);
  require(!normalize, "normalize", "true",
          "goes with a target that is a table; codes are as they are");
  return targets_of(load_code(name_or_path, ideal_camera(camera)).resampled(camera.samples));
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/correlation_file.hpp"

#include <fmt/format.h>

#include "io/array_matrix.hpp"
#include "io/file_kind.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/csv.hpp"
#include "tofsmith/io/npz.hpp"

namespace tofsmith {
namespace {

constexpr Eigen::Index fewest_samples = 8;  // as of a camera

Eigen::MatrixXd read_matrix(const std::filesystem::path& path) {
  const std::string extension = known_extension(path, {".csv", ".txt", ".npy", ".npz"});
  if (extension == ".npz")
    return matrix_of(NpzReader(path).read("corrfs"), path.string() + ": corrfs");
  if (extension != ".npy") return read_csv(path).values;
  NpyArray array = read_npy(path);
  if (array.axes() == 1) {
    const std::vector<double> column = array.to_doubles();
    array = NpyArray::of<double>({column.size(), 1}, column);
  }
  return matrix_of(array, path.string());
}

}  // namespace

Eigen::MatrixXd read_correlation_functions(const std::filesystem::path& path) {
  Eigen::MatrixXd functions = read_matrix(path);
  if (functions.rows() < fewest_samples)
    throw IoError(path.string(), fmt::format("found {} samples of the period; expected at least {}",
                                             functions.rows(), fewest_samples));
  return functions;
}

}  // namespace tofsmith

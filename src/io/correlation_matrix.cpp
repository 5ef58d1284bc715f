// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/correlation_matrix.hpp"

#include <vector>

#include "io/array_matrix.hpp"
#include "io/file_kind.hpp"
#include "tofsmith/io/csv.hpp"
#include "tofsmith/io/npz.hpp"

namespace tofsmith {

Eigen::MatrixXd correlation_matrix_of(const std::filesystem::path& path) {
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

}  // namespace tofsmith

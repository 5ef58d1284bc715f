// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/array_matrix.hpp"

#include <fmt/format.h>

#include <cmath>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Eigen::MatrixXd matrix_of(const NpyArray& array, std::string_view place) {
  if (array.axes() != 2 || array.size() == 0)
    throw IoError(
        place, fmt::format("found the shape {}; expected (N, K)", describe_shape(array.shape())));
  const std::vector<double> values = array.to_doubles();
  Eigen::MatrixXd matrix =
      Eigen::Map<const RowMajor>(values.data(), static_cast<Eigen::Index>(array.shape()[0]),
                                 static_cast<Eigen::Index>(array.shape()[1]));
  for (Eigen::Index n = 0; n < matrix.rows(); ++n)
    for (Eigen::Index i = 0; i < matrix.cols(); ++i)
      if (!std::isfinite(matrix(n, i)))
        throw IoError(fmt::format("{}[{}, {}]", place, n, i),
                      fmt::format("found {}; expected a finite number", matrix(n, i)));
  return matrix;
}

NpyArray array_of(const Eigen::MatrixXd& matrix) {
  const RowMajor rows = matrix;
  return NpyArray::of<double>(
      {static_cast<std::size_t>(rows.rows()), static_cast<std::size_t>(rows.cols())},
      std::span<const double>(rows.data(), static_cast<std::size_t>(rows.size())));
}

}  // namespace tofsmith

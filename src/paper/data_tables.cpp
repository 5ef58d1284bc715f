// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "paper/data_tables.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tofsmith {

std::string csv_text(const std::vector<std::string>& columns,
                     const std::vector<std::vector<double>>& rows) {
  std::string text = fmt::format("{}\n", fmt::join(columns, ","));
  for (const auto& row : rows) text += fmt::format("{:.9g}\n", fmt::join(row, ","));
  return text;
}

std::string csv_text(const std::string& label, const std::vector<std::string>& row_names,
                     const std::vector<std::string>& columns,
                     const std::vector<std::vector<double>>& rows) {
  std::string text = fmt::format("{},{}\n", label, fmt::join(columns, ","));
  for (std::size_t i = 0; i < rows.size(); ++i)
    text += fmt::format("{},{:.9g}\n", row_names[i], fmt::join(rows[i], ","));
  return text;
}

NpyArray npy_of(const Eigen::MatrixXd& matrix) {
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = matrix;
  return NpyArray::of<double>(
      {static_cast<std::size_t>(rows.rows()), static_cast<std::size_t>(rows.cols())},
      {rows.data(), static_cast<std::size_t>(rows.size())});
}

NpyArray npy_of(const std::vector<double>& values) {
  return NpyArray::of<double>({values.size()}, values);
}

}  // namespace tofsmith

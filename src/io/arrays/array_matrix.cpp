// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/arrays/shared/array_matrix.hpp"

#include <fmt/format.h>
#include <cmath>
#include <vector>

#include "io/arrays/shared/sample_times.hpp"
#include "io/shared/read_file.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/io/number_table.hpp"

namespace tofsmith {
namespace {

/// Omits a first column of sample numbers or times.
Eigen::MatrixXd correlation_columns_of(const std::filesystem::path& path,
                                       std::vector<std::string>& notes) {
  const NumberTable table = read_number_table(path, {.min_columns = 2});
  notes = table.notes;
  const Eigen::Index columns = table.values.cols();
  if (columns < 2 || !(is_named_time(table, 0) || counts_samples(table, 0))) return table.values;
  notes.push_back(fmt::format(
      "{}: its first column is a sample counter and was not read as a measurement", path.string()));
  return table.values.rightCols(columns - 1);
}

}  // namespace

Eigen::Index column_of(int exposure, int tap, int exposures, int taps,
                       std::optional<TapOrder> order) {
  return order == TapOrder::blocked ? tap * exposures + exposure : exposure * taps + tap;
}

int exposures_of(Eigen::Index columns, const TapLayout& layout, std::string_view file) {
  require(layout.taps >= 1, "taps", layout.taps, "must be >= 1");
  if (columns % layout.taps != 0)
    throw IoError(file, fmt::format("found {} columns; expected a multiple of taps = {}", columns,
                                    layout.taps));
  const bool has_order = layout.taps > 1 && columns > layout.taps;
  if (has_order && !layout.order)
    throw IoError(file, fmt::format("does not specify the column order of its {} taps; expected "
                                    "--tap-order blocked or interleaved",
                                    layout.taps));
  return static_cast<int>(columns) / layout.taps;
}

Eigen::MatrixXd correlation_matrix_of(const std::filesystem::path& path,
                                      std::vector<std::string>& notes) {
  if (is_number_table(path)) return correlation_columns_of(path, notes);
  if (known_extension(path, {".csv", ".txt", ".tsv", ".dat", ".npy", ".npz"}) == ".npz")
    return matrix_of(NpzReader(path).read("corrfs"), path.string() + ": corrfs");
  return columns_of(read_npy(path), path.string());
}

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

Eigen::MatrixXd columns_of(NpyArray array, std::string_view place) {
  if (array.axes() == 1) {
    const std::vector<double> column = array.to_doubles();
    array = NpyArray::of<double>({column.size(), 1}, column);
  }
  return matrix_of(array, place);
}

std::vector<double> read_one_axis(const std::filesystem::path& path) {
  const NpyArray array = read_npy(path);
  if (array.axes() != 1)
    throw IoError(path.string(), fmt::format("found an array of shape {}; expected one axis",
                                             describe_shape(array.shape())));
  return array.to_doubles();
}

NpyArray array_of(const Eigen::MatrixXd& matrix) {
  const RowMajor rows = matrix;
  return NpyArray::of<double>(
      {static_cast<std::size_t>(rows.rows()), static_cast<std::size_t>(rows.cols())},
      std::span<const double>(rows.data(), static_cast<std::size_t>(rows.size())));
}

NpyArray array_of(const Image<float>& image) {
  return NpyArray::of<float>(
      {static_cast<std::size_t>(image.height), static_cast<std::size_t>(image.width)},
      image.pixels);
}

}  // namespace tofsmith

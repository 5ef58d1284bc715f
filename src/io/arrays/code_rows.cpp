// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "io/arrays/shared/array_matrix.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {
namespace {

// Relative to the largest value: allows for rounding errors of Fourier transforms.
constexpr double noise_share = 1e-9;
constexpr Eigen::Index max_time_bins = 65536;  // as the samples of cameras

/// Returns the common light of all rows: (N), (N, 1), (1, N) or equal columns.
Eigen::VectorXd light_of(Eigen::MatrixXd light, const std::string& place) {
  if (light.rows() == 1) light.transposeInPlace();
  const double near = noise_share * light.cwiseAbs().maxCoeff();
  for (Eigen::Index n = 0; n < light.rows(); ++n)
    for (Eigen::Index k = 0; k < light.cols(); ++k) {
      const std::string at = fmt::format("{}[{}, {}]", place, n, k);
      if (light(n, k) < -near)
        throw IoError(at, fmt::format("found {}; expected light, >= 0", light(n, k)));
      if (std::abs(light(n, k) - light(n, 0)) > near)
        throw IoError(at, fmt::format("found {}; expected {} as in column 0: all rows of one "
                                      "exposure share the same light",
                                      light(n, k), light(n, 0)));
    }
  const Eigen::VectorXd one = light.col(0).cwiseMax(0.0);
  if (one.isZero(0.0)) throw IoError(place, "found only zeros; expected light");
  return one;
}

/// Returns the weights as (N, K); (K, N) is transposed.
Eigen::MatrixXd rows_of_matrix(Eigen::MatrixXd rows, Eigen::Index time_bins,
                               const std::string& place) {
  const Eigen::Index found_rows = rows.rows(), found_columns = rows.cols();
  if (found_rows != time_bins && found_columns == time_bins) rows.transposeInPlace();
  if (rows.rows() != time_bins) {
    const bool has_end = found_rows == time_bins + 1 || found_columns == time_bins + 1 ||
                         found_rows == time_bins - 1 || found_columns == time_bins - 1;
    throw IoError(place, fmt::format("found the shape ({}, {}); expected (N, K) or (K, N) with the "
                                     "N = {} time bins of the light{}",
                                     found_rows, found_columns, time_bins,
                                     has_end ? "; a period omits its end point" : ""));
  }
  if (rows.cols() < 2 || rows.cols() > max_exposure_rows)
    throw IoError(place, fmt::format("found {} rows of {} time bins; expected 2 to {} rows",
                                     rows.cols(), time_bins, max_exposure_rows));
  for (Eigen::Index k = 0; k < rows.cols(); ++k)
    if (rows.col(k).isZero(0.0))
      throw IoError(place, fmt::format("found only zeros in row {}; expected weights", k));
  return rows;
}

CodeSet rows_from(const std::string& name, Eigen::MatrixXd light, const std::string& light_place,
                  Eigen::MatrixXd rows, const std::string& rows_place) {
  const Eigen::VectorXd one = light_of(std::move(light), light_place);
  if (one.size() < min_samples || one.size() > max_time_bins)
    throw IoError(light_place, fmt::format("found {} time bins; expected {} to {}", one.size(),
                                           min_samples, max_time_bins));
  const Eigen::MatrixXd weights = rows_of_matrix(std::move(rows), one.size(), rows_place);
  return CodeSet::create_rows(name, one, weights);
}

}  // namespace

CodeSet read_rows(const std::filesystem::path& light, const std::filesystem::path& rows) {
  return rows_from(rows.stem().string(), columns_of(read_npy(light), light.string()),
                   light.string(), columns_of(read_npy(rows), rows.string()), rows.string());
}

CodeSet read_rows(const std::filesystem::path& archive) {
  const NpzReader reader(archive);
  const std::string light = archive.string() + ": modfs", rows = archive.string() + ": demodfs";
  return rows_from(archive.stem().string(), columns_of(reader.read("modfs"), light), light,
                   columns_of(reader.read("demodfs"), rows), rows);
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/calibrate/correlation_calibration.hpp"

#include "io/arrays/shared/array_matrix.hpp"
#include "io/arrays/shared/correction_arrays.hpp"
#include "io/shared/file_kind.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {

namespace {

NpyArray list_of(const Eigen::VectorXd& values) {
  return NpyArray::of<double>(
      {static_cast<std::size_t>(values.size())},
      std::span<const double>(values.data(), static_cast<std::size_t>(values.size())));
}

NpzArrays arrays_of(const MeasuredTable& table) {
  NpzArrays arrays;
  arrays.emplace("corrfs", array_of(table.correlation));
  arrays.emplace("taps", NpyArray::of<double>({}, std::vector{static_cast<double>(table.taps)}));
  arrays.emplace("differences",
                 NpyArray::of<double>({}, std::vector{table.differences ? 1.0 : 0.0}));
  arrays.emplace("model_error_percent",
                 NpyArray::of<double>({}, std::vector{table.model_error_percent}));
  if (table.black_level.size() > 0) arrays.emplace("offset_dn", list_of(table.black_level));
  if (table.ambient_gain.size() > 0) arrays.emplace("ambient", list_of(table.ambient_gain));
  if (table.exposure_s.size() > 0) arrays.emplace("exposure_s", list_of(table.exposure_s));
  if (table.correction) add_correction(*table.correction, arrays);
  return arrays;
}

}  // namespace

void write_calibrated_table(const std::filesystem::path& path, const MeasuredTable& table,
                            OutputPolicy policy) {
  known_extension(path, {".npz"});
  write_npz(path, arrays_of(table), policy);
}

void write_calibrated_table(const std::filesystem::path& path, const CalibratedCorrelation& found,
                            OutputPolicy policy) {
  known_extension(path, {".npz"});
  NpzArrays arrays = arrays_of(found.table);
  arrays.emplace("corrfs_se", array_of(found.standard_error));
  write_npz(path, arrays, policy);
}

}  // namespace tofsmith

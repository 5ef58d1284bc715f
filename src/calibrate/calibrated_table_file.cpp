// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/calibrate/correlation_calibration.hpp"

#include "io/arrays/shared/array_matrix.hpp"
#include "io/shared/file_kind.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {

namespace {

NpyArray list_of(const Eigen::VectorXd& values) {
  return NpyArray::of<double>(
      {static_cast<std::size_t>(values.size())},
      std::span<const double>(values.data(), static_cast<std::size_t>(values.size())));
}

}  // namespace

void write_calibrated_table(const std::filesystem::path& path, const CalibratedCorrelation& found,
                            OutputPolicy policy) {
  known_extension(path, {".npz"});
  NpzArrays arrays;
  arrays.emplace("corrfs", array_of(found.table.correlation));
  arrays.emplace("corrfs_se", array_of(found.standard_error));
  arrays.emplace("offset_dn", list_of(found.table.black_level));
  if (found.table.ambient_gain.size() > 0)
    arrays.emplace("ambient", list_of(found.table.ambient_gain));
  if (found.table.exposure_s.size() > 0)
    arrays.emplace("exposure_s", list_of(found.table.exposure_s));
  write_npz(path, arrays, policy);
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/search/direction_table.hpp"

#include "core/shared/whole_vectors.hpp"

namespace tofsmith {

namespace {

/// Returns the bin whose direction row n contains: the nearest earlier bin with contrast, or the
/// nearest later one for the first bins.
std::vector<std::int32_t> bins_of_rows(const RowMajorMatrix& curve) {
  const auto has_contrast = [&](Eigen::Index n) { return !curve.row(n).isZero(0.0); };
  std::int32_t current = 0;
  while (!has_contrast(current)) ++current;
  const auto samples = static_cast<std::int32_t>(curve.rows());
  const std::int32_t rows = rounded_up(samples, rows_per_block);
  std::vector<std::int32_t> bins(static_cast<std::size_t>(rows));
  for (std::int32_t n = 0; n < rows; ++n) {
    if (n < samples && has_contrast(n)) current = n;
    bins[static_cast<std::size_t>(n)] = current;
  }
  return bins;
}

}  // namespace

DirectionTable::DirectionTable(const AmbientProjection& projection)
    : samples_(static_cast<int>(projection.curve.rows())),
      rank_(projection.rank()),
      stride_(static_cast<std::size_t>(rank_) * rows_per_block),
      bin_of_row_(bins_of_rows(projection.curve)) {
  const RowMajorMatrix units = projection.curve.rowwise().normalized();
  directions_.resize(bin_of_row_.size() * static_cast<std::size_t>(rank_));
  for (std::size_t row = 0; row < bin_of_row_.size(); ++row)
    for (int j = 0; j < rank_; ++j)
      directions_[row / rows_per_block * stride_ + static_cast<std::size_t>(j) * rows_per_block +
                  row % rows_per_block] = units(bin_of_row_[row], j);
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/search/direction_table.hpp"

#include <algorithm>

#include "core/shared/whole_vectors.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

namespace {

/// Bin whose direction row n holds: n itself, or where bin n has no contrast the nearest bin before
/// it that has some (for the first bins: the nearest after).
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

  main_lobes_.resize(static_cast<std::size_t>(samples_));
  parallel_for_blocks(samples_, 256, [&](IndexRange bins) {
    for (auto n = static_cast<std::int32_t>(bins.begin); n < bins.end; ++n) {
      const std::int32_t right = fall(n, +1);
      const std::int32_t left = std::min(fall(n, -1), samples_ - 1 - right);
      main_lobes_[static_cast<std::size_t>(n)] = {n - left, n + right + 1};
    }
  });
}

double DirectionTable::score_between(std::int32_t bin, std::int32_t other) const {
  double sum = 0.0;
  for (int j = 0; j < rank_; ++j) sum += direction(bin, j) * direction(other, j);
  return sum;
}

/// How many bins the score of `bin` against its neighbours falls, walking in steps of +-1. Fine
/// tables are walked in strides, at most 1024 of them.
std::int32_t DirectionTable::fall(std::int32_t bin, std::int32_t step) const {
  constexpr double plateau = 1e-9;
  constexpr double short_step = 0.9;  // a longer stride might pass over a lobe
  std::int32_t stride = samples_ / 1024 + 1;
  while (stride > 1 && score_between(bin, (bin + step * stride + samples_) % samples_) < short_step)
    stride /= 2;
  double last = 1.0;
  for (std::int32_t distance = stride; distance < samples_; distance += stride) {
    const std::int32_t other = (bin + step * distance + samples_) % samples_;
    const double score = score_between(bin, other);
    if (score > last + plateau) return distance - stride;
    last = score;
  }
  return samples_ - 1;
}

}  // namespace tofsmith

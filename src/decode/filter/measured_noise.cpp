// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/filter/shared/measured_noise.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <variant>
#include <vector>

#include "decode/filter/shared/filter_parts.hpp"
#include "decode/shared/marked_raw.hpp"
#include "tofsmith/core/statistics.hpp"

namespace tofsmith {

namespace {

constexpr int block_side = 8;
constexpr std::size_t min_blocks = 16;
constexpr double flattest_share = 0.25;
constexpr double median_of_normal = 0.6745;  // of |x| of a standard normal variable

/// Second differences along one direction of a block [standard deviations].
class Differences {
 public:
  Differences(FilterPlanes& frame, int rank) : frame_(frame), rank_(rank) {}

  /// Returns the median of the absolute values; none if fewer than half are known.
  std::optional<double> median_of(int first_row, int first_column, std::ptrdiff_t step) {
    found_.clear();
    for (int row = first_row; row < first_row + block_side; ++row)
      for (int column = first_column; column < first_column + block_side; ++column)
        add(row * frame_.grid.stride + column, step);
    if (found_.size() < static_cast<std::size_t>(rank_ * block_side * block_side / 2)) return {};
    return quantile_of(found_, 0.5);
  }

 private:
  void add(std::ptrdiff_t at, std::ptrdiff_t step) {
    const float* const usable = frame_.scalar(FilterPlanes::usable) + at;
    if (!(usable[0] * usable[step] * usable[-step] > 0.0f)) return;
    const float* const v = frame_.scalar(FilterPlanes::variance) + at;
    const double sigma = std::sqrt(static_cast<double>(v[step] + 4.0f * v[0] + v[-step]));
    for (int j = 0; j < rank_; ++j) {
      const float* const u = frame_.light(0, j) + at;
      found_.push_back(std::abs(static_cast<double>(u[step] - 2.0f * u[0] + u[-step])) / sigma);
    }
  }

  FilterPlanes& frame_;
  int rank_;
  std::vector<double> found_;
};

/// Returns at most 128 rows in the middle of a frame.
RawView middle_rows(RawView raw) {
  constexpr int max_rows = 128;
  const int rows = std::min(raw.height, max_rows), first = (raw.height - rows) / 2;
  std::visit([&](auto& data) { data += first * raw.row_stride; }, raw.data);
  if (raw.averaged) raw.averaged += std::ptrdiff_t{first} * raw.width;
  raw.height = rows;
  return raw;
}

}  // namespace

std::optional<double> measured_noise_ratio(const Filter& filter, const RawView& whole) {
  const Filter::Plan& plan = plan_of(filter);
  const RawView stored = middle_rows(whole);
  const MarkedRaw marked(stored, plan.decoder.table().marking);
  const RawView& raw = marked.view();
  require_filterable(plan, raw, {});
  FilterPlanes frame;
  frame.resize(raw.height, raw.width, plan.measurements, 1);
  plan.read(raw, frame);
  Differences differences(frame, plan.rank);
  std::vector<double> medians;
  for (int row = 0; row + block_side <= raw.height; row += block_side)
    for (int column = 0; column + block_side <= raw.width; column += block_side) {
      const auto along = differences.median_of(row, column, 1),
                 down = differences.median_of(row, column, frame.grid.stride);
      if (along && down) medians.push_back(std::min(*along, *down));
    }
  if (medians.size() < min_blocks) return {};
  return quantile_of(medians, flattest_share) / median_of_normal;
}

}  // namespace tofsmith

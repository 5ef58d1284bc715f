// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "decode/filter/filter_kernel.hpp"

namespace tofsmith {

inline constexpr int patch_side = 2 * patch_reach + 1;
inline constexpr int patch_pixels = patch_side * patch_side;

/// Returns the chi^2 quantile with the tail probability of `sigma` standard deviations
/// (Wilson-Hilferty approximation).
inline float chi2_limit(int freedom, double sigma) {
  const double spread = 2.0 / (9.0 * freedom);
  return static_cast<float>(freedom * std::pow(1.0 - spread + sigma * std::sqrt(spread), 3));
}

/// Chi^2 test for changes: no change below `certain`, full change from `most` on.
struct ChangeTest {
  /// Fraction of max_sigma below which the past keeps its full weight.
  static constexpr double certain_share = 0.6;

  ChangeTest(int freedom, double max_sigma)
      : certain(chi2_limit(freedom, certain_share * max_sigma)),
        most(chi2_limit(freedom, max_sigma)) {}

  /// Fraction of the past that is kept.
  float share(float chi2) const { return std::clamp((most - chi2) / (most - certain), 0.0f, 1.0f); }
  float beyond(float chi2) const { return std::max(0.0f, chi2 - certain); }

  float certain, most;
};

/// Adds values to sums (time_kernel.cpp).
void add_to_sums(const float* values, std::ptrdiff_t count, float* sums);

/// Rows of a strip and of the patches around it. Planes: chi^2, usable flag, and K differences in
/// standard deviations.
class ComparedRows {
 public:
  ComparedRows(int rows, int width, int measurements, std::vector<float>& room)
      : rows_(rows), planes_(planes_of(measurements)), pitch_(width + 2 * patch_reach) {
    const std::size_t wanted = floats(rows, width, measurements);
    if (room.size() < wanted) room.resize(wanted);
    first_ = room.data();
  }
  static std::size_t floats(int rows, int width, int measurements) {
    return static_cast<std::size_t>(rows + 1) * static_cast<std::size_t>(planes_of(measurements)) *
           static_cast<std::size_t>(width + 2 * patch_reach);
  }

  /// First pixel of a row.
  float* chi2(int row) { return plane(row, 0) + patch_reach; }
  float* counts(int row) { return plane(row, 1) + patch_reach; }
  /// Distance between measurements [floats].
  std::ptrdiff_t pitch() const { return pitch_; }
  float* difference(int row, int k) { return plane(row, 2 + k) + patch_reach; }

  void clear(int row, float chi2) {
    std::fill_n(plane(row, 0), pitch_, chi2);
    std::fill_n(plane(row, 1), (planes_ - 1) * pitch_, 0.0f);
  }
  /// Adds the rows of a patch; returns the index of the sums.
  int add_rows(int first_row) {
    float* const sums = plane(rows_, 0);
    std::copy_n(plane(first_row, 0), planes_ * pitch_, sums);
    for (int row = first_row + 1; row < first_row + patch_side; ++row)
      add_to_sums(plane(row, 0), planes_ * pitch_, sums);
    return rows_;
  }

 private:
  static int planes_of(int measurements) { return measurements + 2; }
  float* plane(int row, int index) {
    return first_ + (std::ptrdiff_t{row} * planes_ + index) * pitch_;
  }

  int rows_, planes_;
  std::ptrdiff_t pitch_;
  float* first_;
};

}  // namespace tofsmith

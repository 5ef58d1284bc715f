// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith::benchmarks {

inline constexpr int reference_block = 8;  ///< rows with interleaved components
inline constexpr int max_rank = 8;
inline constexpr double reference_tie = 1e-11;  ///< tolerance of ties, in units of |P y'|

/// A pixel without its ambient component.
struct ReferencePixel {
  std::array<double, max_rank> unit{};  ///< unit vector, or zero
  double tie = reference_tie;           ///< tolerance of ties for `unit`
  double rounding = 0.0;                ///< of a score of `unit`
  bool is_number = false;               ///< all raw values are finite
};

/// The decoder's definition in double: directions of bins and pixels in the space of the bins
/// without the ambient component. Independent of the library's tables.
class ReferenceCurve {
 public:
  /// @throws std::invalid_argument unless the rank is in [2, max_rank], or for bins without
  ///   contrast
  explicit ReferenceCurve(const DecodingTable& table);

  int samples() const { return samples_; }
  int rank() const { return rank_; }
  int measurements() const { return static_cast<int>(coordinates_.cols()); }
  int blocks() const { return (samples_ + reference_block - 1) / reference_block; }
  /// Directions [blocks][rank][reference_block]; padding repeats the last row.
  const double* rows() const { return rows_.data(); }
  double component(int row, int j) const {
    return rows_[static_cast<std::size_t>((row / reference_block * rank_ + j) * reference_block +
                                          row % reference_block)];
  }
  double score(const ReferencePixel& pixel, int row) const;
  /// @param raw  (K)
  ReferencePixel project(const float* raw) const;

 private:
  int samples_ = 0;
  int rank_ = 0;
  Eigen::VectorXd dark_raw_, gain_e_per_raw_;
  Eigen::VectorXd ambient_;  // unit vector, or zero
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> coordinates_;  // (rank, K)
  std::vector<double> rows_;
};

/// Finds the lowest bins with scores within reference_tie of the best, by brute force in double.
/// @param pixels  finite
void bins_by_brute_force(const ReferenceCurve& curve, const ReferencePixel* pixels, int count,
                         std::int32_t* bin);

}  // namespace tofsmith::benchmarks

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "design/optimize/sampled_camera.hpp"
#include "design/optimize/soft_decoder.hpp"

namespace tofsmith {

/// Delays of a second return, in bins of the grid.
struct DelayBins {
  int shortest = 1, longest = 2;
};

/// Decodes two returns, s1 p_j + s2 p_k with s1 >= s2 >= 0, where k is later than j by one of the
/// delays. The score of a pair is half the explained sum of squares,
///   S_jk = max over s1, s2 of s1 <y, p_j> + s2 <y, p_k> - |s1 p_j + s2 p_k|^2 / 2.
/// Positions are bins of a grid: this shows which pairs can be confused, but not their precision.
/// Use one object per thread.
class SoftTwoReturnDecoder {
 public:
  /// @param step  every step-th bin of the curve; divides its samples
  SoftTwoReturnDecoder(const DecodingCurve& curve, int step, DelayBins delays);

  /// Returns the position of the direct return [bins of the curve], for electrons (R).
  double decode(const float* electrons);
  /// Returns the expected circular |error| of the direct return [bins of the curve]; probabilities
  /// of pairs are exp(sharpness S_jk) / sum.
  /// @param by_electrons  unless null, accumulates `weight` times the gradient for pull_back(), and
  ///   writes the unweighted gradient w.r.t. the electrons (R)
  double expected_error(const float* electrons, const SoftQuestion& question, float weight = 0.0f,
                        float* by_electrons = nullptr);
  void pull_back(CurveGradient& gradient) const;

  /// One value per bin, over two periods, or one per pair, (delays, stride).
  struct Pairs {
    Pairs(int bin_count, DelayBins delay_bins);
    std::size_t of(int delay) const {
      return static_cast<std::size_t>(delay - delays.shortest) * static_cast<std::size_t>(stride);
    }

    int bins;
    DelayBins delays;
    int stride;  ///< whole vectors
    AlignedFloats squares, match;
    AlignedFloats products;                       ///< <p_j, p_k>, per pair
    AlignedFloats strength, later, score, share;  ///< s1, s2, S, probability, per pair
    AlignedFloats row, error;                     ///< per bin
    AlignedFloats by_match, by_squares, by_products;
  };

 private:
  struct Shares {
    double total;           ///< of pairs_.row, unnormalized
    double expected_error;  ///< [bins of the curve]
  };

  void set_match(const float* electrons);
  Shares weigh(const float* electrons, const SoftQuestion& question);

  int step_, curve_stride_;
  Eigen::MatrixXf points_;  ///< (bins, R)
  Pairs pairs_;
  Eigen::MatrixXf by_points_;
};

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "design/optimize/decoding_curve.hpp"
#include "design/optimize/soft_decoder.hpp"

namespace tofsmith {

/// Delays of a second return that a decoder looks for, in bins of its grid.
struct DelayBins {
  int shortest = 1, longest = 2;
};

/// Decodes measurements as two returns, s1 p_j + s2 p_k with s1 >= s2 >= 0, k later than j by one
/// of the delays. A pair's score is half of what it explains,
///   S_jk = max over s1, s2 of s1 <y, p_j> + s2 <y, p_k> - |s1 p_j + s2 p_k|^2 / 2.
/// On the bins of a grid and no finer: it tells whether two returns can be taken for two others,
/// not how exactly they are found. Keeps scratch memory: one per thread.
class SoftTwoReturnDecoder {
 public:
  /// @param step  grid of every step-th bin of the curve; divides its samples
  SoftTwoReturnDecoder(const DecodingCurve& curve, int step, DelayBins delays);

  /// Bin of the curve of the direct return for the electrons (R).
  double decode(const float* electrons);
  /// Expected |error| of the direct return [bins of the curve], the shorter way round, where a pair
  /// has probability exp(sharpness S_jk) / sum.
  double expected_error(const float* electrons, const SoftQuestion& question);
  /// The same; adds `weight` times the gradient by the curve to what pull_back gives, and writes
  /// that by the electrons (R), unweighted.
  double expected_error(const float* electrons, const SoftQuestion& question, float weight,
                        float* by_electrons);
  /// Adds the gradient by the curve that was summed up.
  void pull_back(CurveGradient& gradient) const;

  /// Lanes: one value per bin, two periods of them, or one per pair, (delays, stride).
  struct Pairs {
    Pairs(int bin_count, DelayBins delay_bins);
    std::size_t of(int delay) const {
      return static_cast<std::size_t>(delay - delays.shortest) * static_cast<std::size_t>(stride);
    }

    int bins;
    DelayBins delays;
    int stride;                                       ///< whole vectors
    AlignedFloats squares, match;                     ///< |p_j|^2 and <y, p_j>, two periods
    AlignedFloats products;                           ///< <p_j, p_k>, per pair
    AlignedFloats strength, later, score, share;      ///< s1, s2, S, probability, per pair
    AlignedFloats row, error;                         ///< per bin
    AlignedFloats by_match, by_squares, by_products;  ///< gradients
  };

 private:
  struct Shares {
    double total;           ///< of pairs_.row, unnormalized
    double expected_error;  ///< [bins of the curve]
  };

  void set_match(const float* electrons);
  /// Shares of all pairs, and the errors they stand for.
  Shares weigh(const float* electrons, const SoftQuestion& question);

  int step_, curve_stride_;
  Eigen::MatrixXf points_;  ///< (bins, R)
  Pairs pairs_;
  Eigen::MatrixXf by_points_;
};

}  // namespace tofsmith

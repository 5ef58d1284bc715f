// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "decode/ambient_projection.hpp"
#include "decode/likelihood/likelihood_model.hpp"
#include "decode/output/lobe_posterior.hpp"

namespace tofsmith {

/// How well every bin explains a pixel, in double: with equal weights or with given ones.
class DepthScores {
 public:
  explicit DepthScores(const AmbientProjection& projection);

  int samples() const { return static_cast<int>(gated_.cols()); }

  /// The lowest of the bins with the best zero-mean normalized cross-correlation, up to rounding.
  /// @param plane  what ambient light leaves of a pixel (rank)
  std::int32_t best_correlation(const double* plane) const;

  /// By how much light from every bin, with ambient light beside it, lowers sum_i weight_i y_i^2;
  /// signal and ambient light are >= 0.
  /// @param electrons  without dark (K)
  /// @param fall       (N)
  void weighted_fall(const double* electrons, const double* weight, double* fall) const;

 private:
  RowMajorMatrix directions_;  // p / |p| (rank, N); 0 without contrast
  RowMajorMatrix gated_;       // x (K, N)
  Eigen::VectorXd ambient_;    // a (K)
};

/// Most peaks over bins that are followed to the least cost beside them.
inline constexpr std::size_t max_peaks = 16;

/// The most likely light of a pixel.
struct MostLikely {
  std::array<double, max_measurements> weight;  ///< first estimate of inverse variances [1/e^2]
  ChordFit best;
  double moved = 0.0;  ///< of the depth from the best chord's point to that of the curve [rows]
};

/// Finds the most likely depth among all. A peak may be missed whose likelihood, by the weights of
/// the first estimate, is no peak: on ten measurements in dim light, with exposures of 1 : 14, in
/// fewer than one pixel of a thousand.
class LikelihoodSearch {
 public:
  LikelihoodSearch(const DecodingTable& table, const AmbientProjection& projection);

  const LikelihoodModel& model() const { return model_; }
  double depth_row(const ChordFit& fit) const { return fit.position().in_rows(scores_.samples()); }
  double depth_row(const MostLikely& found) const;

  /// No signal where ambient light alone explains the pixel.
  /// @param fall    work space (N); then what every bin explains, DepthScores::weighted_fall
  /// @param within  where the depth must lie; null: anywhere. No signal if no peak lies there.
  MostLikely most_likely(const LikelihoodPixel& pixel, std::vector<double>& fall,
                         const RangePart* within = nullptr) const;
  /// Returns LobePosterior::confidence() of the most likely depth.
  std::optional<double> confidence(const LikelihoodPixel& pixel, const MostLikely& found,
                                   const RangePart* within) const;

 private:
  struct Peak;
  class Peaks;
  bool estimate_weights(const LikelihoodPixel& pixel, MostLikely& result) const;
  double squares_beside(const LikelihoodPixel& pixel, std::int32_t bin, const double* weight) const;
  double moved_to_curve(const LikelihoodPixel& pixel, const ChordFit& best, const double* weight,
                        const std::vector<double>& fall) const;
  bool contains(const RangePart* within, double row) const;
  Peaks peaks(const LikelihoodPixel& pixel, const double* weight, const std::vector<double>& fall,
              const RangePart* within) const;

  DepthScores scores_;
  PixelModel correlation_;
  LikelihoodModel model_;
  bool is_smooth_;  // so that the curve between rows is known to leave the chords
  LobePosterior posterior_;
};

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "decode/ambient_projection.hpp"
#include "decode/likelihood/likelihood_model.hpp"
#include "decode/output/lobe_posterior.hpp"

namespace tofsmith {

/// Computes how well each bin explains a pixel.
class DepthScores {
 public:
  explicit DepthScores(const AmbientProjection& projection);

  int samples() const { return static_cast<int>(gated_.cols()); }

  /// Returns the lowest bin with the best zero-mean normalized cross-correlation, up to rounding.
  /// @param plane  pixel without the ambient component, in the subspace (rank)
  std::int32_t best_correlation(const double* plane) const;

  /// Computes the decrease of sum_i weight_i y_i^2 by signal >= 0 of each bin and ambient light >=
  /// 0.
  /// @param electrons  without dark electrons (K)
  /// @param fall       result (N)
  void weighted_fall(const double* electrons, const double* weight, double* fall) const;

 private:
  RowMajorMatrix directions_;  // p / |p| (rank, N); 0 without contrast
  RowMajorMatrix gated_;       // x (K, N)
  Eigen::VectorXd ambient_;    // a (K)
};

inline constexpr std::size_t max_peaks = 16;

struct MostLikely {
  std::array<double, max_measurements> weight;  ///< estimated inverse variances [1/e^2]
  ChordFit best;
  double moved = 0.0;  ///< from the best point of the chord to that of the curve [rows]
};

/// Finds the global maximum of the likelihood. It is missed if it is not a peak with the initial
/// weights: with ten measurements in dim light and exposures of 1 : 14, in fewer than 0.1 % of
/// pixels.
class LikelihoodSearch {
 public:
  LikelihoodSearch(const DecodingTable& table, const AmbientProjection& projection);

  const LikelihoodModel& model() const { return model_; }
  double depth_row(const ChordFit& fit) const { return fit.position().in_rows(scores_.samples()); }
  double depth_row(const MostLikely& found) const;

  /// Returns no signal if ambient light alone explains the pixel, or if no peak lies within
  /// `within`.
  /// @param fall    working memory (N); returns DepthScores::weighted_fall()
  /// @param within  part in which the depth must lie; null: anywhere
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
  bool is_smooth_;  // the curve between rows is known and differs from the chords
  LobePosterior posterior_;
};

}  // namespace tofsmith

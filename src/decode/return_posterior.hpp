// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "decode/multipath_search.hpp"
#include "tofsmith/decode/multipath_options.hpp"

namespace tofsmith {

/// What is known of the direct depth of a pixel once all later returns the prior allows are
/// averaged over.
struct DepthPosterior {
  double median = 0.0;     ///< [fine points], in [0, points)
  double deviation = 0.0;  ///< [fine points]
};

/// Posterior of direct depth around a single fit, under a prior on the second return (for a tail:
/// on its ratio).
class ReturnPosterior {
 public:
  ReturnPosterior(const MultipathCurve& curve, const ReturnPrior& prior, double range_m,
                  const DelayBounds& delays);

  /// @param position  of the single fit [fine points]
  DepthPosterior around(const MultipathCurve& curve, const PixelGroup& pixels, int lane,
                        double position) const;

 private:
  double single_probability_;
  int reach_;                  // of the window to both sides [fine points]
  std::vector<int> delay_;     // of equal probability [fine points]; one 0 for a tail
  std::vector<double> ratio_;  // of equal probability
};

}  // namespace tofsmith

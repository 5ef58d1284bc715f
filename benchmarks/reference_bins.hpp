// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "reference_curve.hpp"

namespace tofsmith::benchmarks {

/// The lowest bins whose scores are within reference_tie of the best, over all bins. Eight rows at
/// a time and four pixels at a time, in double: what brute force can do.
/// @param pixels  all of them numbers
void bins_by_brute_force(const ReferenceCurve& curve, const ReferencePixel* pixels, int count,
                         std::int32_t* bin);

/// The same by branch and bound: runs of neighbouring bins lie in cones, and a cone whose best
/// thinkable score is behind is passed over.
class BranchAndBound {
 public:
  /// @param curve  outlives this and stays where it is
  explicit BranchAndBound(const ReferenceCurve& curve);

  std::int32_t bin(const ReferencePixel& pixel) const;

  /// What the search reads, as plain memory; runs stand in blocks like rows.
  struct View {
    int rank = 0;
    int run_blocks = 0;
    int row_blocks = 0;
    const double* centre =
        nullptr;  ///< [run_blocks][rank][reference_block]: a direction of the run
    const double* cosine = nullptr;  ///< [runs] of the angle between it and the farthest one
    const double* sine = nullptr;    ///< [runs]
    const double* row = nullptr;     ///< as ReferenceCurve::rows()
  };

 private:
  std::vector<double> centre_, cosine_, sine_;
  View view_;
};

}  // namespace tofsmith::benchmarks

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "reference_curve.hpp"

namespace tofsmith::benchmarks {

/// Finds the lowest bins with scores within reference_tie of the best, by brute force in double.
/// @param pixels  finite
void bins_by_brute_force(const ReferenceCurve& curve, const ReferencePixel* pixels, int count,
                         std::int32_t* bin);

/// The same by branch and bound: runs of adjacent bins are in cones; cones with a bound below the
/// best score are skipped.
class BranchAndBound {
 public:
  /// @param curve  must outlive this object
  explicit BranchAndBound(const ReferenceCurve& curve);

  std::int32_t bin(const ReferencePixel& pixel) const;

  /// Arrays of the search; runs are in blocks like rows.
  struct View {
    int rank = 0;
    int run_blocks = 0;
    int row_blocks = 0;
    const double* centre = nullptr;  ///< [run_blocks][rank][reference_block]: centre of the run
    const double* cosine = nullptr;  ///< [runs] of the angle between centre and farthest row
    const double* sine = nullptr;    ///< [runs]
    const double* row = nullptr;     ///< see ReferenceCurve::rows()
  };

 private:
  std::vector<double> centre_, cosine_, sine_;
  View view_;
};

}  // namespace tofsmith::benchmarks

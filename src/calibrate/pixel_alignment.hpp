// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tofsmith/core/progress.hpp"

namespace tofsmith {

/// Pixels relative to a common curve: c_p = gain_p advanced(C, delay_p).
struct PixelAlignment {
  std::vector<double> delay_periods;  ///< excess depth; mean 0
  std::vector<double> gain;           ///< mean 1
  Eigen::MatrixXcd common;            ///< C (H + 1, K)
};

/// Maximum over shift [periods] of Re sum_n s_n exp(-2 pi i n shift); s_0 is ignored.
struct BestShift {
  double shift = 0.0;
  double value = 0.0;
};
BestShift best_shift(const Eigen::VectorXcd& s);

/// Alternates between pixels and their common curve until delays change by less than 1e-9 periods.
/// @param pixels  c of each pixel (H + 1, K)
PixelAlignment align_pixels(const std::vector<Eigen::MatrixXcf>& pixels, const Progress& progress);

}  // namespace tofsmith

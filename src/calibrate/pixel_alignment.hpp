// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tofsmith/core/progress.hpp"

namespace tofsmith {

/// Harmonics of pixels against those of their common curve: c_p = gain_p advanced(C, delay_p).
struct PixelAlignment {
  std::vector<double> delay_periods;  ///< by how much each pixel decodes too far; mean 0
  std::vector<double> gain;           ///< mean 1
  Eigen::MatrixXcd common;            ///< C (H + 1, K)
};

/// Shift [periods] at which the sum over n of s_n exp(-2 pi i n shift) has its largest real part,
/// and that part. s (H + 1), of which s_0 does not count.
struct BestShift {
  double shift = 0.0;
  double value = 0.0;
};
BestShift best_shift(const Eigen::VectorXcd& s);

/// Alternates between pixels and their common curve until delays stay within 1e-9 periods.
/// @param pixels  c of each pixel (H + 1, K)
PixelAlignment align_pixels(const std::vector<Eigen::MatrixXcf>& pixels, const Progress& progress);

}  // namespace tofsmith

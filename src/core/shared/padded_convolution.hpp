// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "core/shared/periodic.hpp"
#include "tofsmith/core/image.hpp"

namespace tofsmith {

/// Convolution of images of one size; values outside are 0.
class PaddedConvolution {
 public:
  /// @param kernel  (2 R + 1, 2 Q + 1), centred; parts beyond the image are ignored
  PaddedConvolution(const Image<float>& kernel, int height, int width);

  Image<float> apply(const Image<float>& image) const;
  /// Additional memory [bytes].
  static double bytes(const Image<float>& kernel, int height, int width);

 private:
  /// Row transforms: real and imaginary parts, (rows, columns / 2 + 1) each.
  struct Halves {
    Eigen::MatrixXd real, imaginary;
  };
  Halves of_rows(const Eigen::MatrixXd& padded, int rows) const;

  int height_, width_;
  PeriodicTransform along_row_, along_column_;
  Eigen::MatrixXcd real_, imaginary_;  // column transforms of the kernel's halves
};

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "tofsmith/core/image.hpp"

namespace tofsmith {

/// Real Fourier transform of a periodic signal of N samples,
///   X[k] = sum_n x[n] exp(-2 pi i k n / N),  k = 0, ..., N/2
/// Plans are cached per thread and length; objects may be shared between threads.
class PeriodicTransform {
 public:
  /// @throws std::invalid_argument unless samples >= 1
  explicit PeriodicTransform(int samples);

  int samples() const { return samples_; }
  /// N/2 + 1.
  int coefficients() const { return samples_ / 2 + 1; }

  void forward(const Eigen::VectorXd& signal, Eigen::VectorXcd& spectrum) const;
  /// inverse(forward(x)) = x.
  void inverse(const Eigen::VectorXcd& spectrum, Eigen::VectorXd& signal) const;

 private:
  int samples_;
};

/// (a * b)[n] = sum_j a[j] b[n - j], modulo N.
Eigen::VectorXd circular_convolution(const Eigen::VectorXd& a, const Eigen::VectorXd& b);

/// (a corr b)[z] = sum_n a[n] b[n - z], modulo N: the match of a with b delayed by z.
Eigen::VectorXd circular_correlation(const Eigen::VectorXd& a, const Eigen::VectorXd& b);

/// sum_n |x[n + 1] - x[n]|, modulo N.
double circular_total_variation(const Eigen::VectorXd& x);

/// x[n - shift], modulo N.
Eigen::VectorXd circular_shift(const Eigen::VectorXd& x, int shift);

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

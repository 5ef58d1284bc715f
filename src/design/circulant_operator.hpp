// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "tofsmith/core/periodic.hpp"

namespace tofsmith {

/// A x = kernel * x (circular) and its adjoint on half spectra. Keeps the kernel's spectrum.
class CirculantOperator {
 public:
  explicit CirculantOperator(int samples) : transform_(samples) {}

  /// Returns whether the kernel differs from the one held before.
  bool set_kernel(const Eigen::VectorXd& kernel) {
    if (kernel_.size() == kernel.size() && kernel_ == kernel) return false;
    kernel_ = kernel;
    transform_.forward(kernel_, spectrum_);
    return true;
  }

  const PeriodicTransform& transform() const { return transform_; }
  const Eigen::VectorXcd& spectrum() const { return spectrum_; }

  /// sum_n r[n]^2 from the half spectrum of r (Parseval).
  double energy(const Eigen::VectorXcd& half) const {
    const int samples = transform_.samples();
    double sum = 2 * half.squaredNorm() - std::norm(half[0]);
    if (samples % 2 == 0) sum -= std::norm(half[samples / 2]);
    return sum / samples;
  }

 private:
  PeriodicTransform transform_;
  Eigen::VectorXd kernel_;
  Eigen::VectorXcd spectrum_;
};

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "decode/ambient_projection.hpp"
#include "decode/raw_scale.hpp"
#include "tofsmith/core/image.hpp"

namespace tofsmith {

/// Vector of a pixel without ambient light, q = V^T y'.
struct PlaneVector {
  double length = 0.0;    ///< |q| [e]; 0 if a rounding error, NaN if a raw value is not finite
  double residual = 0.0;  ///< |P y'| / |q|, >= 1
  std::array<double, max_measurements> unit;  ///< (rank)
};

class ExactProjection {
 public:
  ExactProjection(const DecodingTable& table, const AmbientProjection& projection)
      : scale_(table), basis_(projection.basis), ambient_(projection.ambient.stableNormalized()) {}

  const RawScale& scale() const { return scale_; }
  int measurements() const { return static_cast<int>(basis_.rows()); }
  int rank() const { return static_cast<int>(basis_.cols()); }

  double electrons(double raw, int measurement) const { return scale_.electrons(raw, measurement); }
  void project(const double* raw, PlaneVector& vector) const;

 private:
  RawScale scale_;
  RowMajorMatrix basis_;     // V (K, rank)
  Eigen::VectorXd ambient_;  // a / |a| (K), or 0
};

}  // namespace tofsmith

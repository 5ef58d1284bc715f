// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <new>
#include <vector>

#include "design/optimize/sampled_camera.hpp"

namespace tofsmith {

/// For aligned vector loads.
template <typename Value>
struct CacheLineAllocator {
  using value_type = Value;
  static constexpr std::align_val_t alignment{64};

  CacheLineAllocator() = default;
  template <typename Other>
  explicit CacheLineAllocator(const CacheLineAllocator<Other>&) {}

  Value* allocate(std::size_t count) {
    return static_cast<Value*>(::operator new(count * sizeof(Value), alignment));
  }
  void deallocate(Value* values, std::size_t) { ::operator delete(values, alignment); }
  friend bool operator==(const CacheLineAllocator&, const CacheLineAllocator&) { return true; }
};

template <typename Value>
using Aligned = std::vector<Value, CacheLineAllocator<Value>>;
using AlignedFloats = Aligned<float>;

/// Curve that the decoder matches, with the ambient component projected out:
///   p_j = P x_j,  x_j = g o chi_j,  P = I - a a^T / |a|^2,  a = g o kappa,  g_i = T_i / mean T,
/// at bins j in [0, N], where bin N equals bin 0; and Q_jk = <p_j, p_k> for adjacent bins.
/// @tparam Value  float, or double to compare gradients with finite differences
template <typename Value>
struct DecodingCurveOf {
  DecodingCurveOf(const SampledCamera& camera, const MeasurementTable& table)
      : DecodingCurveOf(camera, table, camera.exposure_s()) {}
  DecodingCurveOf(const SampledCamera& camera, const MeasurementTable& table,
                  const Eigen::VectorXd& exposure_s);

  const Value* component(int r) const { return points.data() + r * stride; }

  int samples, measurements;
  int stride;                    ///< between components: whole vectors, plus one
  Aligned<Value> points;         ///< (R, stride)
  Aligned<Value> squares;        ///< Q_jj, j in [0, N]
  Aligned<Value> products;       ///< Q_j,j+1, j in [0, N)
  Eigen::MatrixXd exact_points;  ///< (N, R)
  Eigen::VectorXd exposure_s;    ///< T (R)
};
using DecodingCurve = DecodingCurveOf<float>;

template <typename Value>
struct CurveGradientOf {
  explicit CurveGradientOf(const DecodingCurveOf<Value>& curve);
  void clear();
  /// Adds to `gradient` and, unless null, to the gradient w.r.t. the integration times (R).
  void pull_back(const SampledCamera& camera, const MeasurementTable& table,
                 const DecodingCurveOf<Value>& curve, MeasurementTable& gradient,
                 Eigen::VectorXd* by_exposure_s = nullptr) const;

  Aligned<Value> points;                 ///< (R, stride)
  Aligned<Value> squares, next_squares;  ///< w.r.t. Q_jj and Q_j+1,j+1, through chord j
  Aligned<Value> products;
};
using CurveGradient = CurveGradientOf<float>;

}  // namespace tofsmith

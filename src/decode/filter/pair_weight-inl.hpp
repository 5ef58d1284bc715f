// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Weights of pairs of pixels.
#if defined(TOFSMITH_DECODE_FILTER_PAIR_WEIGHT_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef TOFSMITH_DECODE_FILTER_PAIR_WEIGHT_INL_HPP
#undef TOFSMITH_DECODE_FILTER_PAIR_WEIGHT_INL_HPP
#else
#define TOFSMITH_DECODE_FILTER_PAIR_WEIGHT_INL_HPP
#endif

#include "core/shared/vectors-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {

HWY_INLINE Vector load(const float* from) { return hn::LoadU(Floats(), from); }
HWY_INLINE void store(Vector value, float* to) { hn::StoreU(value, Floats(), to); }

/// Squared length of the vector in several planes.
HWY_INLINE Vector square_of(const float* const* planes, int rank, std::ptrdiff_t at) {
  Vector square = hn::Zero(Floats());
  for (int j = 0; j < rank; ++j) {
    const Vector u = load(planes[j] + at);
    square = hn::MulAdd(u, u, square);
  }
  return square;
}

/// Decreases smoothly from 1 without difference to 0 from the maximum on.
HWY_INLINE Vector weight_of(Vector difference, Vector inverse_max) {
  const Vector zero = hn::Zero(Floats());
  const Vector left =
      hn::Max(hn::NegMulAdd(hn::Max(difference, zero), inverse_max, all(1.0f)), zero);
  const Vector square = hn::Mul(left, left);
  return hn::Mul(square, square);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#endif

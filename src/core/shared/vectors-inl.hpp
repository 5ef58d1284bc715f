// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Vector types of all kernels, up to 64 bytes wide. Compiled once per instruction set.
#if defined(TOFSMITH_CORE_VECTORS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef TOFSMITH_CORE_VECTORS_INL_HPP
#undef TOFSMITH_CORE_VECTORS_INL_HPP
#else
#define TOFSMITH_CORE_VECTORS_INL_HPP
#endif

#include <hwy/highway.h>

#include "core/shared/whole_vectors.hpp"

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

using Floats = hn::CappedTag<float, widest_vector>;
using Vector = hn::Vec<Floats>;
using Mask = hn::Mask<Floats>;
using Indices = hn::RebindToSigned<Floats>;
using IndexVector = hn::Vec<Indices>;

using Doubles = hn::CappedTag<double, widest_vector / 2>;
using DoubleVector = hn::Vec<Doubles>;

template <typename Tag = Floats>
HWY_INLINE int lanes_of(Tag tag = {}) {
  return static_cast<int>(hn::Lanes(tag));
}

HWY_INLINE Vector all(float value) { return hn::Set(Floats(), value); }
HWY_INLINE DoubleVector all(double value) { return hn::Set(Doubles(), value); }

/// Sum of all N lanes by halves: lane i + N/2 to lane i, then i + N/4, and so on. The order of
/// hn::SumOfLanes differs between versions of Highway.
template <typename Tag>
HWY_INLINE hn::TFromD<Tag> sum_of_lanes(Tag, hn::Vec<Tag> lanes) {
  if constexpr (hn::MaxLanes(Tag()) == 1) {
    return hn::GetLane(lanes);
  } else {
    const hn::Half<Tag> half;  // HWY_SCALAR has no hn::UpperHalf, hence argument-dependent lookup
    return sum_of_lanes(half, hn::Add(hn::LowerHalf(half, lanes), UpperHalf(half, lanes)));
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#endif

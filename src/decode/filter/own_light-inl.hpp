// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Light of an OwnLightTest.
#if defined(TOFSMITH_DECODE_FILTER_OWN_LIGHT_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef TOFSMITH_DECODE_FILTER_OWN_LIGHT_INL_HPP
#undef TOFSMITH_DECODE_FILTER_OWN_LIGHT_INL_HPP
#else
#define TOFSMITH_DECODE_FILTER_OWN_LIGHT_INL_HPP
#endif

#include "decode/filter/filter_kernel.hpp"
#include "decode/filter/pair_weight-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {

/// Scalar product of the measured light of one pixel and the added light of another.
HWY_INLINE Vector along_added(const OwnLightTest& test, std::ptrdiff_t added,
                              std::ptrdiff_t measured) {
  Vector sum = hn::Zero(Floats());
  for (int j = 0; j < test.rank; ++j)
    sum = hn::MulAdd(load(test.added.data()[j] + added), load(test.measured.data()[j] + measured),
                     sum);
  return sum;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#endif

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Elementary functions of float vectors, with the same bits on all CPUs of an instruction set.
// Compiled once per instruction set.
#if defined(TOFSMITH_CORE_VECTOR_MATH_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef TOFSMITH_CORE_VECTOR_MATH_INL_HPP
#undef TOFSMITH_CORE_VECTOR_MATH_INL_HPP
#else
#define TOFSMITH_CORE_VECTOR_MATH_INL_HPP
#endif

#include <hwy/highway.h>

#include "core/shared/vectors-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {

using Words = hn::Vec<hn::RebindToUnsigned<Floats>>;

/// 1 / sqrt(x) of a positive normal x, to the last bits, by Newton's method. Finite for 0.
HWY_INLINE Vector reciprocal_sqrt(Vector x) {
  const Floats d;
  const hn::RebindToSigned<Floats> di;
  const auto bits = hn::ShiftRight<1>(hn::BitCast(di, x));
  Vector y = hn::BitCast(d, hn::Sub(hn::Set(di, 0x5f375a86), bits));
  const Vector half = hn::Mul(x, all(0.5f));
  for (int step = 0; step < 3; ++step)
    y = hn::Mul(y, hn::NegMulAdd(hn::Mul(half, y), y, all(1.5f)));
  return y;
}

/// ln x of a positive normal x, relative error about 1e-7 (polynomial of Cephes' logf).
HWY_INLINE Vector natural_log(Vector x) {
  const Floats d;
  const hn::RebindToSigned<Floats> di;
  // x = m 2^e with m in [sqrt(1/2), sqrt(2)).
  const auto bits = hn::Add(hn::BitCast(di, x), hn::Set(di, 0x3f800000 - 0x3f3504f3));
  const Vector e = hn::ConvertTo(d, hn::Sub(hn::ShiftRight<23>(bits), hn::Set(di, 127)));
  const auto mantissa = hn::Add(hn::And(bits, hn::Set(di, 0x007fffff)), hn::Set(di, 0x3f3504f3));
  const Vector m = hn::Sub(hn::BitCast(d, mantissa), all(1.0f));
  constexpr float coefficients[] = {7.0376836292e-2f,  -1.1514610310e-1f, 1.1676998740e-1f,
                                    -1.2420140846e-1f, 1.4249322787e-1f,  -1.6668057665e-1f,
                                    2.0000714765e-1f,  -2.4999993993e-1f, 3.3333331174e-1f};
  Vector p = all(coefficients[0]);
  for (int i = 1; i < 9; ++i) p = hn::MulAdd(p, m, all(coefficients[i]));
  const Vector m2 = hn::Mul(m, m);
  p = hn::Mul(hn::Mul(p, m), m2);
  p = hn::MulAdd(e, all(-2.12194440e-4f), p);
  p = hn::NegMulAdd(m2, all(0.5f), p);
  return hn::MulAdd(e, all(0.693359375f), hn::Add(m, p));
}

/// sqrt(-2 ln u), with u in (0, 1] from the upper 31 bits.
HWY_INLINE Vector normal_radius(Words word) {
  const Floats d;
  const hn::RebindToSigned<Floats> di;
  const Vector k = hn::ConvertTo(d, hn::BitCast(di, hn::ShiftRight<1>(word)));
  const Vector u = hn::Mul(hn::Add(k, all(0.5f)), all(0x1p-31f));
  const Vector square = hn::Max(hn::Mul(natural_log(u), all(-2.0f)), hn::Zero(d));
  return hn::Mul(square, reciprocal_sqrt(square));
}

/// Uniform point on the unit circle from the upper 24 bits (polynomials of Cephes' sinf, cosf).
HWY_INLINE void unit_circle(Words word, Vector& cosine, Vector& sine) {
  const Floats d;
  const hn::RebindToSigned<Floats> di;
  const hn::RebindToUnsigned<Floats> du;
  const auto part = hn::And(hn::ShiftRight<8>(word), hn::Set(du, 0x3fffff));
  const Vector turn =
      hn::Mul(hn::Add(hn::ConvertTo(d, hn::BitCast(di, part)), all(0.5f)), all(0x1p-22f));
  // Within an eighth of a turn of the centre of a quadrant, which the upper two bits select.
  const Vector x = hn::Mul(hn::Sub(turn, all(0.5f)), all(1.57079632679f));
  const Vector x2 = hn::Mul(x, x);
  Vector s = hn::MulAdd(x2, all(-1.9515295891e-4f), all(8.3321608736e-3f));
  s = hn::MulAdd(hn::MulAdd(s, x2, all(-1.6666654611e-1f)), hn::Mul(x2, x), x);
  Vector c = hn::MulAdd(x2, all(2.443315711809948e-5f), all(-1.388731625493765e-3f));
  c = hn::MulAdd(c, x2, all(4.166664568298827e-2f));
  c = hn::MulAdd(hn::Mul(c, x2), x2, hn::NegMulAdd(x2, all(0.5f), all(1.0f)));
  const auto is_odd =
      hn::MaskFromVec(hn::BitCast(d, hn::ShiftRight<31>(hn::BitCast(di, hn::ShiftLeft<1>(word)))));
  const auto sign = hn::And(word, hn::Set(du, 0x80000000u));
  const Vector turned_c = hn::IfThenElse(is_odd, hn::Neg(s), c);
  const Vector turned_s = hn::IfThenElse(is_odd, c, s);
  cosine = hn::BitCast(d, hn::Xor(hn::BitCast(du, turned_c), sign));
  sine = hn::BitCast(d, hn::Xor(hn::BitCast(du, turned_s), sign));
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#endif

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Local search for returns, one pixel per lane.
#if defined(TOFSMITH_DECODE_MULTIPATH_FIT_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef TOFSMITH_DECODE_MULTIPATH_FIT_INL_HPP
#undef TOFSMITH_DECODE_MULTIPATH_FIT_INL_HPP
#else
#define TOFSMITH_DECODE_MULTIPATH_FIT_INL_HPP
#endif

#include <hwy/highway.h>

#include "core/shared/vectors-inl.hpp"
#include "decode/multipath/multipath_search.hpp"

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {

static_assert(pixels_per_group == widest_vector);
using Row = float[pixels_per_group];

HWY_INLINE Vector load(const float* row) { return hn::Load(Floats(), row); }
HWY_INLINE void store(Vector value, float* row) { hn::Store(value, Floats(), row); }
HWY_INLINE Vector choose(Mask which, Vector yes, Vector no) {
  return hn::IfThenElse(which, yes, no);
}

template <int Span>
HWY_INLINE Vector dot(const Row* a, const Row* b, int span) {
  const int count = Span > 0 ? Span : span;
  Vector sum = hn::Mul(load(a[0]), load(b[0]));
  for (int i = 1; i < count; ++i) sum = hn::MulAdd(load(a[i]), load(b[i]), sum);
  return sum;
}

constexpr int max_dims = max_span + 1;
constexpr int packed(int row, int column) { return row * (row + 1) / 2 + column; }

/// Pixel in whitened coordinates without ambient light. With the Cholesky factor L of B^T W B, a
/// curve point p becomes L_pp^T p, and y becomes the subspace part of L^-1 B^T W y.
struct White {
  alignas(64) Row factor[packed(max_dims, 0)];
  alignas(64) Row target[max_span];
  int span = 0, first = 0;  // rows of the factor before the subspace

  HWY_INLINE void make(const MultipathCurve& curve, const PixelGroup& pixels, int lane) {
    span = curve.span;
    first = curve.sees_ambient ? 1 : 0;
    const int dims = curve.dims(), pairs = curve.pairs();
    alignas(64) Row sums[max_dims], inverse[max_dims];
    for (int a = 0; a < pairs; ++a) store(hn::Zero(Floats()), factor[a]);
    for (int a = 0; a < dims; ++a) store(hn::Zero(Floats()), sums[a]);
    for (int k = 0; k < curve.measurements; ++k) {
      const Vector weight = hn::Div(all(1.0f), load(pixels.variance_e2[k] + lane));
      const Vector weighted = hn::Mul(weight, load(pixels.electrons[k] + lane));
      const float* product = curve.products.data() + k * pairs;
      for (int a = 0; a < pairs; ++a)
        store(hn::MulAdd(weight, all(product[a]), load(factor[a])), factor[a]);
      const float* column = curve.basis.data() + k * dims;
      for (int a = 0; a < dims; ++a)
        store(hn::MulAdd(weighted, all(column[a]), load(sums[a])), sums[a]);
    }
    for (int a = 0; a < dims; ++a) {
      for (int b = 0; b < a; ++b) {
        Vector left = load(factor[packed(a, b)]);
        for (int k = 0; k < b; ++k)
          left = hn::NegMulAdd(load(factor[packed(a, k)]), load(factor[packed(b, k)]), left);
        store(hn::Mul(left, load(inverse[b])), factor[packed(a, b)]);
      }
      const Vector whole = load(factor[packed(a, a)]);
      Vector left = whole, sum = load(sums[a]);
      for (int k = 0; k < a; ++k) {
        const Vector l = load(factor[packed(a, k)]);
        left = hn::NegMulAdd(l, l, left);
        sum = hn::NegMulAdd(l, load(sums[k]), sum);
      }
      // Rounding errors count as 0.
      const Mask is_left = hn::Gt(left, hn::Mul(all(1e-6f), whole));
      const Vector root = hn::Sqrt(hn::IfThenElseZero(is_left, left));
      const Vector inverse_root = hn::IfThenElseZero(is_left, hn::Div(all(1.0f), root));
      store(root, factor[packed(a, a)]);
      store(inverse_root, inverse[a]);
      store(hn::Mul(sum, inverse_root), sums[a]);
    }
    for (int i = 0; i < span; ++i) store(load(sums[first + i]), target[i]);
  }

  /// Computes L_pp^T p in place.
  HWY_INLINE void whiten(Row* rows) const {
    for (int i = 0; i < span; ++i) {
      Vector sum = hn::Mul(load(factor[packed(first + i, first + i)]), load(rows[i]));
      for (int k = i + 1; k < span; ++k)
        sum = hn::MulAdd(load(factor[packed(first + k, first + i)]), load(rows[k]), sum);
      store(sum, rows[i]);
    }
  }
  HWY_INLINE void whiten(const float* point, Row* rows) const {
    for (int i = 0; i < span; ++i) {
      Vector sum = hn::Mul(load(factor[packed(first + i, first + i)]), all(point[i]));
      for (int k = i + 1; k < span; ++k)
        sum = hn::MulAdd(load(factor[packed(first + k, first + i)]), all(point[k]), sum);
      store(sum, rows[i]);
    }
  }
};

/// Returns whitened points at positions in [0, points), and their slope per point.
HWY_INLINE void point_at(const MultipathCurve& curve, const std::vector<float>& table,
                         const White& white, Vector position, Row* value, Row* slope) {
  const hn::RebindToSigned<Floats> di;
  const auto cell =
      hn::Min(hn::Max(hn::ConvertTo(di, position), hn::Zero(di)), hn::Set(di, curve.points - 1));
  const Vector share = hn::Sub(position, hn::ConvertTo(Floats(), cell));
  const auto at = hn::Mul(cell, hn::Set(di, curve.span));
  for (int i = 0; i < curve.span; ++i) {
    const Vector here = hn::GatherIndex(Floats(), table.data() + i, at);
    const Vector step = hn::Sub(hn::GatherIndex(Floats(), table.data() + curve.span + i, at), here);
    store(hn::MulAdd(share, step, here), value[i]);
    store(step, slope[i]);
  }
  white.whiten(value);
  white.whiten(slope);
}

HWY_INLINE Vector wrapped(Vector position, int points) {
  const Vector period = all(static_cast<float>(points));
  const Vector turns = hn::Floor(hn::Div(position, period));
  const Vector within = hn::NegMulAdd(turns, period, position);
  return choose(hn::Ge(within, period), hn::Zero(Floats()), hn::Max(within, hn::Zero(Floats())));
}

/// Best signals of two curve points, S1 >= S2 >= 0.
struct Signals {
  Vector first, second;
  Mask are_equal;  // the constraint S2 <= S1 is active
};
HWY_INLINE Signals best_signals(Vector b1, Vector b2, Vector g11, Vector g12, Vector g22) {
  const Vector zero = hn::Zero(Floats());
  const Vector det = hn::MulSub(g11, g22, hn::Mul(g12, g12));
  const Vector n1 = hn::MulSub(g22, b1, hn::Mul(g12, b2));
  const Vector n2 = hn::MulSub(g11, b2, hn::Mul(g12, b1));
  const Mask differ = hn::Gt(det, hn::Mul(all(1e-5f), hn::Mul(g11, g22)));
  const Vector sum = hn::Add(b1, b2);
  const Mask are_equal = hn::And(hn::Or(hn::Gt(n2, n1), hn::Not(differ)), hn::Gt(sum, zero));
  const Mask are_two = hn::And(differ, hn::And(hn::Ge(n1, n2), hn::Ge(n2, zero)));
  const Vector together =
      hn::Div(sum, hn::Add(hn::Add(g11, g22), hn::Add(hn::Add(g12, g12), all(1e-20f))));
  const Vector alone = hn::Div(hn::Max(b1, zero), hn::Add(g11, all(1e-20f)));
  const Vector per_det = hn::Div(all(1.0f), choose(differ, det, all(1.0f)));
  Signals best{alone, zero, are_equal};
  best.first = choose(are_two, hn::Mul(n1, per_det), choose(are_equal, together, alone));
  best.second = choose(are_two, hn::Mul(n2, per_det), choose(are_equal, together, zero));
  return best;
}

enum class Fitted { single, pair, tail };

/// State of the search: chi^2, its gradient (times -1/2) and Gauss-Newton matrix.
struct Place {
  Vector first, second;  // positions: of the direct return, and its delay
  Vector s1, s2;
  Vector chi2;
  Vector pull1, pull2;
  Vector h11, h12, h22;
};

/// @param free_signals  computes the matrix for unconstrained signals, for standard deviations
template <Fitted What, int Span>
HWY_INLINE Place look(const MultipathCurve& curve, const White& white, Vector first, Vector second,
                      bool free_signals = false) {
  const int span = curve.span;
  const Vector zero = hn::Zero(Floats());
  alignas(64) Row g1[max_span], d1[max_span], g2[max_span], d2[max_span];
  point_at(curve, curve.fine, white, first, g1, d1);
  Place place{first, second, zero, zero, zero, zero, zero, zero, zero, zero};
  Mask are_equal = hn::Gt(zero, zero);
  const Vector g11 = dot<Span>(g1, g1, span), b1 = dot<Span>(g1, white.target, span);
  Vector g12 = zero, g22 = zero;
  if constexpr (What == Fitted::single) {
    place.s1 = hn::Div(hn::Max(b1, zero), hn::Add(g11, all(1e-20f)));
  } else {
    if constexpr (What == Fitted::pair)
      point_at(curve, curve.fine, white, wrapped(hn::Add(first, second), curve.points), g2, d2);
    else
      point_at(curve, curve.tail, white, first, g2, d2);
    g12 = dot<Span>(g1, g2, span), g22 = dot<Span>(g2, g2, span);
    const Signals s = best_signals(b1, dot<Span>(g2, white.target, span), g11, g12, g22);
    place.s1 = s.first, place.s2 = s.second;
    if (!free_signals) are_equal = s.are_equal;
  }
  // u and v: directions in which signals can change.
  Vector uj = zero, vj = zero, uk = zero, vk = zero, jj = zero, jk = zero, kk = zero;
  for (int i = 0; i < (Span > 0 ? Span : span); ++i) {
    const Vector first_i = load(g1[i]), slope1 = hn::Mul(place.s1, load(d1[i]));
    Vector left = hn::NegMulAdd(place.s1, first_i, load(white.target[i]));
    if constexpr (What == Fitted::single) {
      uj = hn::MulAdd(first_i, slope1, uj);
      jj = hn::MulAdd(slope1, slope1, jj);
      place.pull1 = hn::MulAdd(left, slope1, place.pull1);
    } else {
      const Vector second_i = load(g2[i]), slope2 = hn::Mul(place.s2, load(d2[i]));
      left = hn::NegMulAdd(place.s2, second_i, left);
      // Delays are relative to the direct return.
      const Vector j = hn::Add(slope1, slope2);
      const Vector u = choose(are_equal, hn::Add(first_i, second_i), first_i);
      uj = hn::MulAdd(u, j, uj);
      vj = hn::MulAdd(second_i, j, vj);
      jj = hn::MulAdd(j, j, jj);
      place.pull1 = hn::MulAdd(left, j, place.pull1);
      if constexpr (What == Fitted::pair) {
        uk = hn::MulAdd(u, slope2, uk);
        vk = hn::MulAdd(second_i, slope2, vk);
        jk = hn::MulAdd(j, slope2, jk);
        kk = hn::MulAdd(slope2, slope2, kk);
        place.pull2 = hn::MulAdd(left, slope2, place.pull2);
      }
    }
    place.chi2 = hn::MulAdd(left, left, place.chi2);
  }
  // Variable projection: subtract the part that the linear amplitudes explain.
  const Vector tiny = all(1e-20f);
  Vector uu = hn::Add(g11, tiny);
  if constexpr (What != Fitted::single)
    uu = choose(are_equal, hn::Add(uu, hn::Add(g22, hn::Add(g12, g12))), uu);
  const Vector per_uu = hn::Div(all(1.0f), uu);
  const Vector uju = hn::Mul(uj, per_uu);
  place.h11 = hn::NegMulAdd(uj, uju, jj);
  if constexpr (What != Fitted::single) {
    const Vector vu = hn::Mul(g12, per_uu), vv = hn::NegMulAdd(g12, vu, g22);
    const Mask moves = hn::AndNot(are_equal, hn::Gt(vv, hn::Mul(all(1e-6f), g22)));
    const Vector per_vv = hn::IfThenElseZero(moves, hn::Div(all(1.0f), hn::Add(vv, tiny)));
    const Vector vjr = hn::NegMulAdd(uj, vu, vj);
    place.h11 = hn::NegMulAdd(hn::Mul(vjr, vjr), per_vv, place.h11);
    if constexpr (What == Fitted::pair) {
      const Vector vkr = hn::NegMulAdd(uk, vu, vk);
      place.h12 = hn::NegMulAdd(hn::Mul(vjr, vkr), per_vv, hn::NegMulAdd(uk, uju, jk));
      place.h22 =
          hn::NegMulAdd(hn::Mul(vkr, vkr), per_vv, hn::NegMulAdd(uk, hn::Mul(uk, per_uu), kk));
    }
  }
  return place;
}

HWY_INLINE Place choose(Mask which, const Place& yes, const Place& no) {
  return {choose(which, yes.first, no.first), choose(which, yes.second, no.second),
          choose(which, yes.s1, no.s1),       choose(which, yes.s2, no.s2),
          choose(which, yes.chi2, no.chi2),   choose(which, yes.pull1, no.pull1),
          choose(which, yes.pull2, no.pull2), choose(which, yes.h11, no.h11),
          choose(which, yes.h12, no.h12),     choose(which, yes.h22, no.h22)};
}

/// Levenberg-Marquardt. Converged lanes remain unchanged.
template <Fitted What, int Span>
HWY_INLINE Place downhill(const MultipathCurve& curve, const DelayBounds& delays,
                          const White& white, Vector first, Vector second, int max_steps) {
  const Vector zero = hn::Zero(Floats()), one = all(1.0f);
  const Vector near = all(1e-3f * static_cast<float>(curve.points_per_row));
  const Vector reach =
      all(0.7f * static_cast<float>(curve.points) / static_cast<float>(curve.coarse));
  Place best = look<What, Span>(curve, white, first, second);
  Vector damping = all(0.01f);
  Mask moves = hn::Gt(best.s1, zero);
  for (int step = 0; step < max_steps && !hn::AllFalse(Floats(), moves); ++step) {
    const Vector raised = hn::Add(one, damping);
    const Vector h11 = hn::MulAdd(best.h11, raised, all(1e-20f));
    Vector by_first, by_second = zero;
    if constexpr (What == Fitted::pair) {
      const Vector h22 = hn::MulAdd(best.h22, raised, all(1e-20f));
      const Vector det = hn::MulSub(h11, h22, hn::Mul(best.h12, best.h12));
      const Vector per_det = hn::Div(one, hn::Max(det, hn::Mul(all(1e-6f), hn::Mul(h11, h22))));
      by_first = hn::Mul(per_det, hn::MulSub(h22, best.pull1, hn::Mul(best.h12, best.pull2)));
      by_second = hn::Mul(per_det, hn::MulSub(h11, best.pull2, hn::Mul(best.h12, best.pull1)));
      by_second = hn::Min(hn::Max(by_second, hn::Neg(reach)), reach);
    } else {
      by_first = hn::Div(best.pull1, h11);
    }
    by_first = hn::Min(hn::Max(by_first, hn::Neg(reach)), reach);
    Vector delay = hn::Add(best.second, by_second);
    if constexpr (What == Fitted::pair)
      delay = hn::Min(hn::Max(delay, all(delays.shortest)), all(delays.longest));
    const Place tried =
        look<What, Span>(curve, white, wrapped(hn::Add(best.first, by_first), curve.points), delay);
    const Mask falls = hn::And(moves, hn::Lt(tried.chi2, best.chi2));
    const Mask is_small =
        hn::And(hn::Lt(hn::Abs(by_first), near), hn::Lt(hn::Abs(by_second), near));
    best = choose(falls, tried, best);
    damping = choose(falls, hn::Mul(damping, all(0.2f)), hn::Mul(damping, all(8.0f)));
    moves = hn::And(hn::AndNot(is_small, moves), hn::Lt(damping, all(1e4f)));
  }
  return best;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#endif

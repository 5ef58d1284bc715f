// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Goodness of fit (see ResidualModel).
#if defined(TOFSMITH_DECODE_OUTPUT_RESIDUAL_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef TOFSMITH_DECODE_OUTPUT_RESIDUAL_INL_HPP
#undef TOFSMITH_DECODE_OUTPUT_RESIDUAL_INL_HPP
#else
#define TOFSMITH_DECODE_OUTPUT_RESIDUAL_INL_HPP
#endif

#include "decode/output/output_noise-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {
struct Unexplained {
  static constexpr int lanes = widest_vector;
  Mask is_left;  ///< the position lies before the row
  Vector square;
  /// Components in the decoding subspace and outside it, and orthonormal directions of signal and
  /// depth in the subspace.
  alignas(64) float component[max_measurements * lanes];
  alignas(64) float direction[max_measurements * lanes];
  alignas(64) float slope[max_measurements * lanes];
};

/// Uses the chord on the nearer side; at a bin, the one with the larger change.
HWY_INLINE void find_chord(const RecordLayout& layout, int rank, const OutputChunk& chunk, int i,
                           Unexplained& left) {
  const Floats d;
  const Vector zero = hn::Zero(d), offset = load(chunk.offset, i);
  const Vector length = load(chunk.field(layout.bound()), i);
  const Vector to_left = along(chunk, rank, layout.left(), i);
  const Vector to_right = along(chunk, rank, layout.right(), i);
  left.is_left = hn::Or(hn::Lt(offset, zero),
                        hn::And(hn::Eq(offset, zero), hn::Ge(hn::Abs(to_left), hn::Abs(to_right))));
  for (int j = 0; j < rank; ++j) {
    hn::StoreU(hn::Mul(load(chunk.field(layout.point() + j), i), length), d,
               left.direction + j * Unexplained::lanes);
    hn::StoreU(hn::IfThenElse(left.is_left, load(chunk.field(layout.left() + j), i),
                              load(chunk.field(layout.right() + j), i)),
               d, left.slope + j * Unexplained::lanes);
  }
}

HWY_INLINE void normalize(float* components, int rank, Vector square) {
  const Vector least = all(std::numeric_limits<float>::min());
  const Vector scale = hn::Div(all(1.0f), hn::Sqrt(hn::Max(square, least)));
  for (int j = 0; j < rank; ++j) {
    float* const at = components + j * Unexplained::lanes;
    hn::StoreU(hn::Mul(load(at, 0), scale), Floats(), at);
  }
}

/// Finds the direction u(n + t) of a smooth curve and its slope (DepthPolynomials):
///   u / |p_n| = p_n / |p_n|^2 + t W + t^2 B / 2 + t^3 C / 3.
HWY_INLINE void find_tangent(const RecordLayout& layout, int rank, const OutputChunk& chunk, int i,
                             Unexplained& left) {
  const Floats d;
  const Vector t = load(chunk.offset, i);
  left.is_left = hn::Lt(t, hn::Zero(d));
  Vector own = hn::Zero(d), own_slope = own;
  for (int j = 0; j < rank; ++j) {
    const Vector w = load(chunk.field(layout.slope() + j), i);
    const Vector b = load(chunk.field(layout.bend() + j), i);
    const Vector c = load(chunk.field(layout.asymmetry() + j), i);
    const Vector slope = product_plus(t, product_plus(t, c, b), w);
    const Vector mean_slope =
        product_plus(t, product_plus(t, hn::Mul(c, all(1.0f / 3.0f)), hn::Mul(b, all(0.5f))), w);
    const Vector direction = product_plus(t, mean_slope, load(chunk.field(layout.point() + j), i));
    hn::StoreU(direction, d, left.direction + j * Unexplained::lanes);
    hn::StoreU(slope, d, left.slope + j * Unexplained::lanes);
    own = product_plus(direction, direction, own);
    own_slope = product_plus(slope, slope, own_slope);
  }
  normalize(left.direction, rank, own);
  normalize(left.slope, rank, own_slope);
}

HWY_INLINE void find_unexplained(const OutputConstants& c, const RecordLayout& layout, int rank,
                                 const OutputChunk& chunk, int i, Unexplained& left) {
  const Floats d;
  if (layout.is_smooth)
    find_tangent(layout, rank, chunk, i, left);
  else
    find_chord(layout, rank, chunk, i, left);
  const auto fit = [&](const float* direction) {
    Vector sum = hn::Mul(load(chunk.plane, i), load(direction, 0));
    for (int j = 1; j < rank; ++j)
      sum = product_plus(load(chunk.plane + j * pixels_per_tile, i),
                         load(direction + j * Unexplained::lanes, 0), sum);
    return sum;
  };
  const Vector score = fit(left.direction), rise = fit(left.slope);
  left.square = hn::Zero(d);
  for (int j = 0; j < rank; ++j) {
    const Vector found = product_plus(score, load(left.direction + j * Unexplained::lanes, 0),
                                      hn::Mul(rise, load(left.slope + j * Unexplained::lanes, 0)));
    const Vector rest = hn::Sub(load(chunk.plane + j * pixels_per_tile, i), found);
    hn::StoreU(rest, d, left.component + j * Unexplained::lanes);
    left.square = product_plus(rest, rest, left.square);
  }
  for (int m = 0; m < c.off_plane_count; ++m) {
    const float* const weight = c.off_plane.data() + m * layout.measurements;
    Vector rest = hn::Mul(load(chunk.electrons, i), all(weight[0]));
    for (int k = 1; k < layout.measurements; ++k)
      rest = product_plus(load(chunk.electrons + k * pixels_per_tile, i), all(weight[k]), rest);
    hn::StoreU(rest, d, left.component + (rank + m) * Unexplained::lanes);
    left.square = product_plus(rest, rest, left.square);
  }
}

/// Variances at positions between rows, (K, lanes).
HWY_INLINE void find_variances(const OutputConstants& c, const BinRecords& records,
                               OutputChunk& chunk, int i, Mask is_left, float* variance) {
  const Floats d;
  const Indices di;
  const RecordLayout& layout = records.layout;
  const auto one = hn::Set(di, 1), zero = hn::Zero(di), samples = hn::Set(di, c.samples);
  const auto bin = hn::LoadU(di, chunk.bin + i);
  auto beside = hn::IfThenElse(hn::RebindMask(di, is_left), hn::Sub(bin, one), hn::Add(bin, one));
  beside = hn::IfThenElse(hn::Lt(beside, zero), hn::Sub(samples, one), beside);
  beside = hn::IfThenElse(hn::Lt(beside, samples), beside, zero);
  alignas(64) std::uint32_t start[Unexplained::lanes];
  const auto rows = hn::Mul(hn::Add(beside, one), hn::Set(di, records.records.stride()));
  hn::StoreU(hn::BitCast(hn::RebindToUnsigned<Floats>(), rows), hn::RebindToUnsigned<Floats>(),
             start);
  gather(records.records.data(), start, layout.shot(), layout.end(), chunk.record + i);
  const Vector t = hn::Abs(load(chunk.offset, i));
  for (int k = 0; k < layout.measurements; ++k)
    hn::StoreU(hn::Mul(t, load(chunk.field(layout.shot() + k), i)), d,
               variance + k * Unexplained::lanes);
  gather(records.records.data(), chunk.start + i, layout.shot(), layout.end(), chunk.record + i);

  const Vector signal = load(chunk.signal, i), ambient = noisy_ambient(chunk, i);
  const Vector rest = hn::Sub(all(1.0f), t);
  const Vector least =
      product_plus(signal, all(c.least_shot),
                   product_plus(ambient, all(c.least_shot_ambient), all(c.least_floor_e2)));
  for (int k = 0; k < layout.measurements; ++k) {
    float* const at = variance + k * Unexplained::lanes;
    const Vector shot = product_plus(rest, load(chunk.field(layout.shot() + k), i), load(at, 0));
    const Vector without_signal =
        product_plus(ambient, all(c.shot_ambient.data()[k]), all(c.floor_noise_e2.data()[k]));
    hn::StoreU(hn::Max(product_plus(signal, shot, without_signal), least), d, at);
  }
}

/// Returns a - b^2 / c for c >= 0, where c = 0 implies b = 0.
HWY_INLINE Vector less_square(Vector a, Vector b, Vector c) {
  return hn::Sub(a, hn::Mul(hn::Div(b, hn::Max(c, all(std::numeric_limits<float>::min()))), b));
}

HWY_INLINE Vector weighted_squares(const OutputConstants& c, const RecordLayout& layout, int rank,
                                   const Unexplained& left, const float* variance) {
  // Weighted products: ambient light a, signal x, slope s, residual r.
  const Vector zero = hn::Zero(Floats());
  Vector aa = zero, ax = zero, as = zero, ar = zero, xx = zero, xs = zero, xr = zero, ss = zero,
         sr = zero, rr = zero;
  const int components = rank + c.off_plane_count;
  for (int k = 0; k < layout.measurements; ++k) {
    const float* const basis = c.residual_basis.data() + k * components;
    Vector x = zero, s = zero, r = zero;
    for (int j = 0; j < rank; ++j) {
      x = product_plus(load(left.direction + j * Unexplained::lanes, 0), all(basis[j]), x);
      s = product_plus(load(left.slope + j * Unexplained::lanes, 0), all(basis[j]), s);
    }
    for (int j = 0; j < components; ++j)
      r = product_plus(load(left.component + j * Unexplained::lanes, 0), all(basis[j]), r);
    const Vector a = all(c.ambient_direction.data()[k]);
    const Vector weight = hn::Div(all(1.0f), load(variance + k * Unexplained::lanes, 0));
    const Vector by_a = hn::Mul(weight, a), by_x = hn::Mul(weight, x), by_s = hn::Mul(weight, s);
    aa = product_plus(by_a, a, aa);
    ax = product_plus(by_a, x, ax);
    as = product_plus(by_a, s, as);
    ar = product_plus(by_a, r, ar);
    xx = product_plus(by_x, x, xx);
    xs = product_plus(by_x, s, xs);
    xr = product_plus(by_x, r, xr);
    ss = product_plus(by_s, s, ss);
    sr = product_plus(by_s, r, sr);
    rr = product_plus(hn::Mul(weight, r), r, rr);
  }
  if (c.sees_ambient) {
    const Vector of_x = hn::Div(ax, aa), of_s = hn::Div(as, aa);
    xx = hn::Sub(xx, hn::Mul(of_x, ax));
    xs = hn::Sub(xs, hn::Mul(of_x, as));
    xr = hn::Sub(xr, hn::Mul(of_x, ar));
    ss = hn::Sub(ss, hn::Mul(of_s, as));
    sr = hn::Sub(sr, hn::Mul(of_s, ar));
    rr = less_square(rr, ar, aa);
  }
  const Vector of_s = hn::Div(xs, hn::Max(xx, all(std::numeric_limits<float>::min())));
  ss = hn::Sub(ss, hn::Mul(of_s, xs));
  sr = hn::Sub(sr, hn::Mul(of_s, xr));
  rr = less_square(rr, xr, xx);
  return hn::Max(less_square(rr, sr, ss), zero);
}

/// Finds inconsistent pixels and, if `wants_plane`, residuals. For most pixels the unweighted
/// squares divided by the least variance suffice. Not inlined, because g++ 12 fails with an
/// internal error for AVX-512.
template <int Rank>
HWY_NOINLINE void find_residual(const OutputConstants& c, const BinRecords& records,
                                const RecordTable& limits, bool wants_plane, OutputChunk& chunk) {
  const Floats d;
  const RecordLayout& layout = records.layout;
  const int rank = Rank > 0 ? Rank : layout.rank;
  Unexplained left;
  alignas(64) float variance[max_measurements * Unexplained::lanes];
  find_rows(limits, chunk.bin, chunk.pixels, chunk.limit_start);
  for (int i = 0; i < chunk.pixels; i += lanes_of(d)) {
    gather(limits.data(), chunk.limit_start + i, 0, LimitLayout::end_of_bound, chunk.limit + i);
    const auto limit = [&](int field) { return load(chunk.limit + field * pixels_per_chunk, i); };
    find_unexplained(c, layout, rank, chunk, i, left);
    const Vector signal = load(chunk.signal, i), share = load(chunk.residual_share, i);
    const Vector bound =
        hn::Mul(variance_of(signal, noisy_ambient(chunk, i), limit(LimitLayout::variance),
                            limit(LimitLayout::variance + 1), limit(LimitLayout::variance + 2)),
                share);
    const Vector from_noise = hn::Sqrt(bound), error = hn::Mul(signal, limit(LimitLayout::error));
    const Vector longest = hn::Add(
        from_noise,
        hn::Min(error, hn::Div(hn::Mul(hn::Mul(error, error), all(c.half_quantile)), from_noise)));
    const Mask is_open = hn::Gt(left.square, hn::Mul(longest, longest));
    Mask is_inconsistent = is_open;
    if (wants_plane || !hn::AllFalse(d, is_open)) {
      gather(limits.data(), chunk.limit_start + i, LimitLayout::end_of_bound, LimitLayout::end,
             chunk.limit + i);
      find_variances(c, records, chunk, i, left.is_left, variance);
      const Vector chi2 = hn::Div(weighted_squares(c, layout, rank, left, variance), share);
      is_inconsistent = hn::And(is_open, hn::Gt(hn::Sqrt(hn::Mul(chi2, bound)),
                                                hn::Mul(limit(LimitLayout::root), longest)));
      hn::StoreU(hn::Mul(chi2, limit(LimitLayout::per_freedom)), d, chunk.residual + i);
    }
    hn::StoreU(hn::IfThenElseZero(is_inconsistent, all(1.0f)), d, chunk.inconsistent + i);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#endif

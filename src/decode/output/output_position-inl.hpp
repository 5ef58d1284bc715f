// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Position and light of pixels.
#if defined(TOFSMITH_DECODE_OUTPUT_POSITION_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef TOFSMITH_DECODE_OUTPUT_POSITION_INL_HPP
#undef TOFSMITH_DECODE_OUTPUT_POSITION_INL_HPP
#else
#define TOFSMITH_DECODE_OUTPUT_POSITION_INL_HPP
#endif

#include "decode/output/shared/output_vectors-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {
HWY_INLINE Vector along(const OutputChunk& chunk, int rank, int field, int i) {
  Vector sum = hn::Mul(load(chunk.plane, i), load(chunk.field(field), i));
  for (int j = 1; j < rank; ++j)
    sum = product_plus(load(chunk.plane + j * pixels_per_tile, i), load(chunk.field(field + j), i),
                       sum);
  return sum;
}

/// Finds the best point on both chords. With x = <q, p> / |p|^2 and v = <q, w>, which is positive
/// on rising sides: S = x - v beta / c, t = v / (c S). If both sides rise, the steeper one is best,
/// unless its best point lies beyond the chord: the bin may not be the best one (see ChordMatcher).
HWY_INLINE void refine_on_chords(const RecordLayout& layout, int rank, OutputChunk& chunk) {
  const Floats d;
  const Vector zero = hn::Zero(d);
  for (int i = 0; i < chunk.pixels; i += lanes_of(d)) {
    const Vector at_bin = along(chunk, rank, layout.point(), i);
    const Vector to_left = along(chunk, rank, layout.left(), i);
    const Vector to_right = along(chunk, rank, layout.right(), i);
    const Vector turn_left = load(chunk.field(layout.turn()), i);
    const Vector turn_right = load(chunk.field(layout.turn() + 1), i);
    const Vector reach_left = load(chunk.field(layout.reach()), i);
    const Vector reach_right = load(chunk.field(layout.reach() + 1), i);
    const auto ends_first = [&](Vector rise, Vector turn, Vector reach) {
      return hn::Gt(hn::Mul(rise, hn::Add(reach, turn)), at_bin);
    };
    const Mask left_is_on =
        hn::AndNot(ends_first(to_left, turn_left, reach_left), hn::Gt(to_left, zero));
    const Mask right_is_on =
        hn::AndNot(ends_first(to_right, turn_right, reach_right), hn::Gt(to_right, zero));
    const Mask is_left =
        hn::Or(hn::AndNot(right_is_on, left_is_on),
               hn::AndNot(hn::Xor(left_is_on, right_is_on), hn::Ge(to_left, to_right)));
    const Vector rise = hn::Max(hn::IfThenElse(is_left, to_left, to_right), zero);
    const Vector turn = hn::IfThenElse(is_left, turn_left, turn_right);
    const Vector reach = hn::IfThenElse(is_left, reach_left, reach_right);
    const Vector inside = hn::Sub(at_bin, hn::Mul(rise, turn));
    const Mask has_depth = hn::And(hn::Gt(at_bin, zero), hn::Gt(inside, zero));
    const Vector t = hn::Min(hn::Div(hn::Mul(rise, reach), inside), all(1.0f));
    hn::StoreU(hn::IfThenElseZero(has_depth, inside), d, chunk.signal + i);
    hn::StoreU(hn::IfThenElseZero(has_depth, hn::IfThenElse(is_left, hn::Neg(t), t)), d,
               chunk.offset + i);
  }
}

/// Finds the maximum around the row of a smooth curve (see DepthPolynomials::maximum()), and the
/// signal there, with x = <q, p> / |p|^2:
///   S = (x + g t + b t^2 / 2 + c t^3 / 3) / (1 + growth t + growth_change t^2).
HWY_INLINE void refine_on_curve(const RecordLayout& layout, int rank, OutputChunk& chunk) {
  const Floats d;
  const Vector zero = hn::Zero(d), one = all(1.0f), back = all(-1.0f);
  for (int i = 0; i < chunk.pixels; i += lanes_of(d)) {
    const Vector at_row = along(chunk, rank, layout.point(), i);
    const Vector g = along(chunk, rank, layout.slope(), i);
    const Vector b = along(chunk, rank, layout.bend(), i);
    const Vector c = along(chunk, rank, layout.asymmetry(), i);
    const auto within = [&](Vector t) { return hn::Min(hn::Max(t, back), one); };
    Vector t = within(hn::Neg(hn::Div(g, b)));
    for (int step = 0; step < 2; ++step) {
      const Vector curvature = product_plus(hn::Add(c, c), t, b);
      const Vector rise = product_plus(t, product_plus(t, c, b), g);
      const Vector moved = within(hn::Sub(t, hn::Div(rise, curvature)));
      t = hn::IfThenElse(hn::Lt(curvature, zero), moved, t);
    }
    t = hn::IfThenElseZero(hn::Lt(b, zero), t);
    const Vector third = hn::Mul(c, all(1.0f / 3.0f));
    const Vector slopes = product_plus(t, product_plus(t, third, hn::Mul(b, all(0.5f))), g);
    const Vector growth = product_plus(t, load(chunk.field(layout.growth() + 1), i),
                                       load(chunk.field(layout.growth()), i));
    const Vector signal = hn::Div(product_plus(t, slopes, at_row), product_plus(t, growth, one));
    const Mask has_depth = hn::And(hn::Gt(at_row, zero), hn::Gt(signal, zero));
    hn::StoreU(hn::IfThenElseZero(has_depth, signal), d, chunk.signal + i);
    hn::StoreU(hn::IfThenElseZero(has_depth, t), d, chunk.offset + i);
  }
}

HWY_INLINE void refine(const RecordLayout& layout, int rank, OutputChunk& chunk) {
  if (layout.is_smooth)
    refine_on_curve(layout, rank, chunk);
  else
    refine_on_chords(layout, rank, chunk);
}

HWY_INLINE void find_chords(const RecordTable& chords, OutputChunk& chunk) {
  const Floats d;
  const Indices di;
  const hn::RebindToUnsigned<Floats> du;
  const auto last = hn::Set(di, ChordLayout::quarters - 1), one = hn::Set(di, 1);
  const auto at_bin = hn::Set(di, ChordLayout::at_bin), blocks = hn::Set(di, ChordLayout::blocks);
  alignas(64) std::uint32_t start[pixels_per_chunk];
  for (int i = 0; i < chunk.pixels; i += lanes_of(d)) {
    const Vector offset = load(chunk.offset, i);
    const auto is_left = hn::RebindMask(di, hn::Lt(offset, hn::Zero(d)));
    const auto is_at_bin = hn::RebindMask(di, hn::Eq(offset, hn::Zero(d)));
    const auto quarter =
        hn::ConvertTo(di, hn::Mul(hn::Abs(offset), all(static_cast<float>(ChordLayout::quarters))));
    const auto steps = hn::IfThenZeroElse(is_at_bin, hn::Add(hn::Min(quarter, last), one));
    const auto block = hn::IfThenElse(is_left, hn::Sub(at_bin, steps), hn::Add(at_bin, steps));
    const auto bin = hn::Add(hn::LoadU(di, chunk.bin + i), one);
    const auto row = hn::Add(hn::Mul(bin, blocks), block);
    hn::StoreU(hn::BitCast(du, hn::ShiftLeft<2>(row)), du, start + i);
  }
  for (int i = 0; i < chunk.pixels; i += lanes_of(d))
    gather(chords.data(), start + i, 0, ChordLayout::fields, chunk.chord + i);
}

HWY_INLINE void write_depth(const OutputConstants& c, const OutputChunk& chunk, float* depth_m) {
  const Floats d;
  const Vector zero = hn::Zero(d);
  for (int i = 0; i < chunk.pixels; i += lanes_of(d)) {
    const Vector offset = load(chunk.offset, i);
    Vector bin = hn::ConvertTo(d, hn::LoadU(Indices(), chunk.bin + i));
    const Mask is_below = hn::And(hn::Eq(bin, zero), hn::Lt(offset, zero));
    bin = hn::IfThenElse(is_below, all(static_cast<float>(c.samples)), bin);
    const Vector rest = product_plus(offset, all(c.bin_m), hn::Mul(bin, all(c.bin_low_m)));
    Vector depth = product_plus(bin, all(c.bin_high_m), rest);
    depth = hn::IfThenZeroElse(hn::Ge(depth, all(c.range_m)), depth);
    store_some(d, unless(hn::Gt(load(chunk.signal, i), zero), depth), depth_m + i,
               chunk.pixels - i);
  }
}

/// Pixels without a depth become NaN.
HWY_INLINE void write_values(const OutputChunk& chunk, const float* values, float* plane) {
  const Floats d;
  for (int i = 0; i < chunk.pixels; i += lanes_of(d)) {
    const Mask has_depth = hn::Gt(load(chunk.signal, i), hn::Zero(d));
    store_some(d, unless(has_depth, load(values, i)), plane + i, chunk.pixels - i);
  }
}

/// Ambient light is the remainder after the signal; 0 if differences hide it.
HWY_INLINE void find_ambient(const OutputConstants& c, const RecordLayout& layout,
                             OutputChunk& chunk) {
  const Floats d;
  if (!c.sees_ambient) return static_cast<void>(std::fill_n(chunk.ambient, pixels_per_chunk, 0.0f));
  const int count = layout.measurements;
  for (int i = 0; i < chunk.pixels; i += lanes_of(d)) {
    Vector sum = hn::Mul(load(chunk.electrons, i), all(c.ambient_weight[0]));
    for (int k = 1; k < count; ++k)
      sum = product_plus(load(chunk.electrons + k * pixels_per_tile, i),
                         all(c.ambient_weight[static_cast<std::size_t>(k)]), sum);
    const Vector of_signal = product_plus(hn::Abs(load(chunk.offset, i)),
                                          load(chunk.chord_field(ChordLayout::ambient), i),
                                          load(chunk.field(layout.ambient()), i));
    hn::StoreU(hn::Sub(sum, hn::Mul(load(chunk.signal, i), of_signal)), d, chunk.ambient + i);
  }
}

HWY_INLINE void write_ambient(const OutputConstants& c, const OutputChunk& chunk, float* plane) {
  if (c.sees_ambient) return write_values(chunk, chunk.ambient, plane);
  std::fill_n(plane, chunk.pixels, std::numeric_limits<float>::quiet_NaN());
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#endif

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Lookup of cells.
#if defined(TOFSMITH_DECODE_CELL_PLACE_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef TOFSMITH_DECODE_CELL_PLACE_INL_HPP
#undef TOFSMITH_DECODE_CELL_PLACE_INL_HPP
#else
#define TOFSMITH_DECODE_CELL_PLACE_INL_HPP
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <limits>

#include "core/shared/vectors-inl.hpp"
#include "decode/search/cell_search.hpp"
#include "decode/search/rows-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {

using Words = hn::RebindToUnsigned<Floats>;

constexpr int tile = pixels_per_tile;
constexpr int row_floats = 4;

struct Scratch {
  alignas(64) float place[3][tile];     // t_s in the cell
  alignas(64) std::int32_t cell[tile];  // before enter_roots(): index of the root
  alignas(64) std::int32_t cut[tile];   // rank 4: index within a cut root
  alignas(64) std::int32_t is_cut[tile];
  alignas(64) std::int32_t first[tile];
  alignas(64) std::int32_t last[tile];
  alignas(64) float slip[tile];
  std::int32_t with_list[tile + 16];
  std::int32_t unproven[tile + 16];
  int lists;
  int unproven_count;
  bool all_proven;
};

/// Leaves the nearest integer in the lowest bits, up to 22 bits.
constexpr float to_whole = 0x1.8p23f;

/// Returns 1 / v with a relative error of 2^-22 (larger on architectures other than x86).
HWY_INLINE Vector reciprocal_of(Vector v) {
  const Floats d;
#if HWY_ARCH_X86
  const auto near = hn::ApproximateReciprocal(v);
  return hn::Mul(near, hn::NegMulAdd(v, near, hn::Set(d, 2.0f)));
#else
  return hn::Div(hn::Set(d, 1.0f), v);
#endif
}

/// Computes the cell of every pixel, the position in it, and a bound on the error of the position,
/// infinite if the pixel is too uncertain. For rank 4, computes the root, the cell if the root is
/// cut, and the position in that.
template <int Rank>
HWY_INLINE void locate(const CellSearchView& view, const PixelTile& pixels, int padded,
                       Scratch& scratch) {
  const Floats d;
  const Indices di;
  const int lanes = lanes_of(d);
  const int bits = view.root_bits + view.cut_bits;
  const auto sides = static_cast<float>(1 << bits);
  const auto half = hn::Set(d, 0.5f * sides), middle = hn::Set(d, to_whole + 0.5f * sides);
  const auto first_cell = hn::Set(d, to_whole), last_cell = hn::Set(d, to_whole + sides - 1);
  const auto fine_bits = hn::Set(di, (1 << bits) - 1),
             cut_mask = hn::Set(di, (1 << view.cut_bits) - 1);
  const auto infinite = hn::Set(d, std::numeric_limits<float>::infinity());
  const auto rounding_of_place = hn::Set(d, 1e-6f * (sides + 2));
  constexpr float farthest = 1e30f;  // reciprocals of larger numbers underflow
  // CellRecord::overlap exceeds twice this plus rounding.
  constexpr auto reach = static_cast<float>(max_proven_error);
  for (int i = 0; i < padded; i += lanes) {
    Vector q[Rank];
    for (int j = 0; j < Rank; ++j) q[j] = hn::Load(d, pixels.plane + j * tile + i);
    auto largest = hn::Abs(q[0]), signed_largest = q[0];
    auto axis = hn::Zero(di);
    for (int j = 1; j < Rank; ++j) {
      const auto size = hn::Abs(q[j]);
      const auto leads = hn::Gt(size, largest);
      largest = hn::Max(size, largest);
      signed_largest = hn::IfThenElse(leads, q[j], signed_largest);
      axis = hn::IfThenElse(hn::RebindMask(di, leads), hn::Set(di, j), axis);
    }
    const auto error = hn::Load(d, pixels.error + i);
    const auto has_cell = hn::And(hn::Lt(error, hn::Mul(hn::Set(d, reach), largest)),
                                  hn::Lt(largest, hn::Set(d, farthest)));

    const auto scale = hn::Mul(half, reciprocal_of(largest));
    // An error of q changes c by at most twice the error divided by the largest component, and t by
    // G times that.
    const auto slip = hn::MulAdd(hn::Mul(error, scale), hn::Set(d, 4.1f), rounding_of_place);
    hn::Store(hn::IfThenElse(has_cell, slip, infinite), d, scratch.slip + i);

    const auto is_negative = hn::ShiftRight<31>(hn::BitCast(Words(), signed_largest));
    auto cell = hn::Add(hn::Add(axis, axis), hn::BitCast(di, is_negative)), cut = hn::Zero(di);
    for (int s = 0; s + 1 < Rank; ++s) {
      const auto is_before = hn::RebindMask(d, hn::Gt(axis, hn::Set(di, s)));
      const auto c = hn::Mul(hn::IfThenElse(is_before, q[s], q[s + 1]), scale);
      const auto shifted = hn::Sub(c, hn::Set(d, 0.5f));
      const auto index = hn::Min(hn::Max(hn::Add(shifted, middle), first_cell), last_cell);
      const auto within = hn::Sub(shifted, hn::Sub(index, middle));
      hn::Store(hn::Add(within, within), d, scratch.place[s] + i);
      // NaN also maps to a valid cell.
      const auto fine = hn::And(hn::BitCast(di, index), fine_bits);
      if (Rank == 4) {
        cut = hn::Add(hn::ShiftLeftSame(cut, view.cut_bits), hn::And(fine, cut_mask));
        cell = hn::Add(hn::ShiftLeftSame(cell, view.root_bits),
                       hn::ShiftRightSame(fine, view.cut_bits));
      } else {
        cell = hn::Add(hn::ShiftLeftSame(cell, view.root_bits), fine);
      }
    }
    if (Rank == 4) hn::Store(cut, di, scratch.cut + i);
    hn::Store(cell, di, scratch.cell + i);
  }
}

/// Converts roots to cells and prefetches these. Scalar code is faster than gathers here.
HWY_INLINE void enter_roots(const CellSearchView& view, int padded, Scratch& scratch) {
  for (int i = 0; i < padded; ++i) {
    const std::int32_t root = view.roots[scratch.cell[i]], is_cut = root & 1;
    const std::int32_t cell = (root >> 1) + (scratch.cut[i] & -is_cut);
    hwy::Prefetch(view.cells + cell);
    scratch.cell[i] = cell;
    scratch.is_cut[i] = is_cut;
  }
}

/// Converts the position in a cut cell to that in a root that is not cut.
HWY_INLINE void place_in_roots(const CellSearchView& view, int padded, Scratch& scratch) {
  constexpr int sides = 3;
  const Floats d;
  const Indices di;
  const auto shrink = hn::Set(d, 1.0f / static_cast<float>(1 << view.cut_bits));
  const auto to_centre = hn::Sub(shrink, hn::Set(d, 1.0f));
  const auto cut_mask = hn::Set(di, (1 << view.cut_bits) - 1);
  for (int i = 0; i < padded; i += lanes_of(d)) {
    const auto cut = hn::Load(di, scratch.cut + i);
    const auto is_whole = hn::Eq(hn::Load(di, scratch.is_cut + i), hn::Zero(di));
    if (hn::AllFalse(di, is_whole)) continue;
    for (int s = 0; s < sides; ++s) {
      const auto part = hn::And(hn::ShiftRightSame(cut, view.cut_bits * (sides - 1 - s)), cut_mask);
      const auto fine = hn::Load(d, scratch.place[s] + i);
      const auto wide =
          hn::MulAdd(hn::Add(fine, hn::ConvertTo(d, hn::Add(part, part))), shrink, to_centre);
      hn::Store(hn::IfThenElse(hn::RebindMask(d, is_whole), wide, fine), d, scratch.place[s] + i);
    }
  }
}

HWY_INLINE IndexVector low_half(IndexVector v) { return hn::And(v, hn::Set(Indices(), 0xffff)); }

/// Low and high halves of words as floats.
HWY_INLINE Vector low_number(IndexVector words) {
  return hn::ConvertTo(Floats(), hn::ShiftRight<16>(hn::ShiftLeft<16>(words)));
}
HWY_INLINE Vector high_number(IndexVector words) {
  return hn::ConvertTo(Floats(), hn::ShiftRight<16>(words));
}

/// Writes the pixels of a mask (up to one vector more); returns their number. Compressing stores
/// are slow on some processors.
HWY_INLINE int list(IndexVector pixel, hn::Mask<Indices> mask, std::int32_t* listed) {
  hn::StoreU(hn::Compress(pixel, mask), Indices(), listed);
  return static_cast<int>(hn::CountTrue(Indices(), mask));
}

/// Computes the bins that cells prove. Lists other pixels, with the start in the run.
template <int Rank>
HWY_INLINE void predict(const CellSearchView& view, int padded, PixelTile& pixels,
                        Scratch& scratch) {
  const Floats d;
  const Indices di;
  const int lanes = lanes_of(d);
  scratch.lists = scratch.unproven_count = 0;
  const auto unit = hn::Set(d, view.fit_unit), half = hn::Set(d, 0.5f),
             whole = hn::Set(d, to_whole);
  const auto slack_unit = hn::Set(d, static_cast<float>(CellRecord::slack_unit)),
             steepest = hn::Set(d, view.steepest_fit), no_border = hn::Set(d, 1e30f);
  const auto count = hn::Set(di, view.count), lane = hn::Iota(di, 0);
  for (int i = 0; i < padded; i += lanes) {
    Vector words[row_length];
    load_rows(
        [&](int lane) {
          return reinterpret_cast<const float*>(view.cells + scratch.cell[i + lane]);
        },
        words);
    const auto run = hn::BitCast(di, words[0]), fit01 = hn::BitCast(di, words[1]),
               fit23 = hn::BitCast(di, words[2]), beside = hn::BitCast(di, words[3]);
    // For rank 3, the last fit is the slack.
    auto slack = high_number(fit23);
    if (Rank == 4) slack = high_number(beside);
    auto x = hn::MulAdd(high_number(fit01), hn::Load(d, scratch.place[0] + i), low_number(fit01));
    x = hn::MulAdd(low_number(fit23), hn::Load(d, scratch.place[1] + i), x);
    if (Rank == 4) x = hn::MulAdd(high_number(fit23), hn::Load(d, scratch.place[2] + i), x);
    x = hn::Mul(x, unit);

    const auto length = hn::ShiftRight<16>(run), first = low_half(run);
    const auto last_after = hn::ConvertTo(d, length);
    const auto after = hn::Min(hn::Max(hn::Sub(hn::Add(x, whole), whole), hn::Zero(d)), last_after);
    // NaN also stays in the run.
    const auto steps =
        hn::Min(hn::And(hn::BitCast(di, hn::Add(after, whole)), hn::Set(di, 0x7fff)), length);
    const auto at = hn::Add(first, steps);
    const auto once = hn::IfThenElse(hn::Lt(at, count), at, hn::Sub(at, count));
    hn::Store(once, di, pixels.bin + i);

    // The distance of x from the borders must exceed the error bound.
    const auto rounding =
        hn::MulAdd(slack, slack_unit, hn::Mul(steepest, hn::Load(d, scratch.slip + i)));
    const auto place = hn::Sub(x, after);
    const auto above = hn::IfThenElse(hn::Eq(after, last_after), no_border, hn::Sub(half, place));
    const auto below = hn::IfThenElse(hn::Eq(after, hn::Zero(d)), no_border, hn::Add(half, place));
    const auto is_proven = hn::RebindMask(di, hn::Gt(hn::Min(above, below), rounding));
    const auto is_list = hn::Lt(run, hn::Zero(di));
    const auto is_unproven = hn::AndNot(is_list, hn::Not(is_proven));
    const auto is_left = hn::Or(is_list, is_unproven);
    if (hn::AllFalse(di, is_left)) continue;
    hn::Store(first, di, scratch.first + i);
    hn::Store(hn::Add(first, length), di, scratch.last + i);
    const auto pixel = hn::Add(lane, hn::Set(di, i));
    scratch.unproven_count += list(pixel, is_unproven, scratch.unproven + scratch.unproven_count);
    scratch.lists += list(pixel, is_list, scratch.with_list + scratch.lists);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();
#endif

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// From the vectors of a tile to what their cells say; compiled once for every instruction set.
#if defined(TOFSMITH_DECODE_CELL_PLACE_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef TOFSMITH_DECODE_CELL_PLACE_INL_HPP
#undef TOFSMITH_DECODE_CELL_PLACE_INL_HPP
#else
#define TOFSMITH_DECODE_CELL_PLACE_INL_HPP
#endif

#include <hwy/highway.h>

#include <limits>

#include "core/shared/vectors-inl.hpp"
#include "decode/search/cell_search.hpp"

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {

using Words = hn::RebindToUnsigned<Floats>;

constexpr int tile = pixels_per_tile;
constexpr int row_floats = 4;  // of a step or a direction

struct Scratch {
  alignas(64) float place[3][tile];  // t_s in the cell
  alignas(64) std::int32_t cell[tile];
  alignas(64) std::int32_t first[tile];
  alignas(64) std::int32_t last[tile];
  alignas(64) float slip[tile];
  std::int32_t with_list[tile + 16];
  std::int32_t unproven[tile + 16];
  int lists;
  int unproven_count;
  bool all_proven;
};

/// Added to a number of up to 22 bits it leaves the nearest whole one in the lowest bits.
constexpr float to_whole = 0x1.8p23f;

/// 1 / v to 2^-22; elsewhere than on x86 approximations may be coarser.
HWY_INLINE Vector reciprocal_of(Vector v) {
  const Floats d;
#if HWY_ARCH_X86
  const auto near = hn::ApproximateReciprocal(v);
  return hn::Mul(near, hn::NegMulAdd(v, near, hn::Set(d, 2.0f)));
#else
  return hn::Div(hn::Set(d, 1.0f), v);
#endif
}

/// Cell and place in it of every pixel, and how much the place may be off; infinite where the pixel
/// is too uncertain for its cell.
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
  // Of a cell of an uncut root: its place from the place in the fine cell that could be there.
  const auto shrink = hn::Set(d, 1.0f / static_cast<float>(1 << view.cut_bits));
  const auto to_centre = hn::Sub(shrink, hn::Set(d, 1.0f));
  const auto infinite = hn::Set(d, std::numeric_limits<float>::infinity());
  const auto rounding_of_place = hn::Set(d, 1e-6f * (sides + 2));
  constexpr float farthest = 1e30f;  // beyond, reciprocals are lost
  // Twice this and rounding is less than CellRecord::overlap.
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
    // An error of q moves c by twice itself over the largest component, and t by G times that.
    const auto slip = hn::MulAdd(hn::Mul(error, scale), hn::Set(d, 4.1f), rounding_of_place);
    hn::Store(hn::IfThenElse(has_cell, slip, infinite), d, scratch.slip + i);

    const auto is_negative = hn::ShiftRight<31>(hn::BitCast(Words(), signed_largest));
    auto cell = hn::Add(hn::Add(axis, axis), hn::BitCast(di, is_negative)), cut = hn::Zero(di);
    Vector fine_place[3], wide_place[3];
    for (int s = 0; s + 1 < Rank; ++s) {
      const auto is_before = hn::RebindMask(d, hn::Gt(axis, hn::Set(di, s)));
      const auto c = hn::Mul(hn::IfThenElse(is_before, q[s], q[s + 1]), scale);
      const auto shifted = hn::Sub(c, hn::Set(d, 0.5f));
      const auto index = hn::Min(hn::Max(hn::Add(shifted, middle), first_cell), last_cell);
      const auto within = hn::Sub(shifted, hn::Sub(index, middle));
      fine_place[s] = hn::Add(within, within);
      // Also what is no number lands in a cell.
      const auto fine = hn::And(hn::BitCast(di, index), fine_bits);
      if (Rank == 4) {
        const auto part = hn::And(fine, cut_mask);
        wide_place[s] = hn::MulAdd(hn::Add(fine_place[s], hn::ConvertTo(d, hn::Add(part, part))),
                                   shrink, to_centre);
        cut = hn::Add(hn::ShiftLeftSame(cut, view.cut_bits), part);
        cell = hn::Add(hn::ShiftLeftSame(cell, view.root_bits),
                       hn::ShiftRightSame(fine, view.cut_bits));
      } else {
        cell = hn::Add(hn::ShiftLeftSame(cell, view.root_bits), fine);
      }
    }
    if (Rank == 4) {
      const auto root = hn::GatherIndex(di, view.roots, cell);
      const auto is_cut = hn::Ne(hn::And(root, hn::Set(di, 1)), hn::Zero(di));
      cell = hn::Add(hn::ShiftRight<1>(root), hn::IfThenElseZero(is_cut, cut));
      for (int s = 0; s + 1 < Rank; ++s)
        fine_place[s] = hn::IfThenElse(hn::RebindMask(d, is_cut), fine_place[s], wide_place[s]);
    }
    for (int s = 0; s + 1 < Rank; ++s) hn::Store(fine_place[s], d, scratch.place[s] + i);
    hn::Store(cell, di, scratch.cell + i);
  }
}

HWY_INLINE IndexVector low_half(IndexVector v) { return hn::And(v, hn::Set(Indices(), 0xffff)); }

/// Low and high halves of words as numbers.
HWY_INLINE Vector low_number(IndexVector words) {
  return hn::ConvertTo(Floats(), hn::ShiftRight<16>(hn::ShiftLeft<16>(words)));
}
HWY_INLINE Vector high_number(IndexVector words) {
  return hn::ConvertTo(Floats(), hn::ShiftRight<16>(words));
}

/// The bins of pixels whose cell proves them, and where to begin in the run of the others, which
/// are listed; so are pixels with several runs.
template <int Rank>
HWY_INLINE void predict(const CellSearchView& view, int padded, bool wants_second_peaks,
                        PixelTile& pixels, Scratch& scratch) {
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
    const auto word = hn::ShiftLeft<2>(hn::Load(di, scratch.cell + i));
    const auto* words = reinterpret_cast<const std::int32_t*>(view.cells);
    const auto run = hn::GatherIndex(di, words, word), fit01 = hn::GatherIndex(di, words + 1, word),
               fit23 = hn::GatherIndex(di, words + 2, word);
    // Of rank 3 the slack stands in place of the fourth fit.
    auto slack = high_number(fit23);
    if (Rank == 4 || wants_second_peaks) {
      const auto beside = hn::GatherIndex(di, words + 3, word);
      hn::Store(beside, di, pixels.second_peak + i);
      if (Rank == 4) slack = high_number(beside);
    }
    auto x = hn::MulAdd(high_number(fit01), hn::Load(d, scratch.place[0] + i), low_number(fit01));
    x = hn::MulAdd(low_number(fit23), hn::Load(d, scratch.place[1] + i), x);
    if (Rank == 4) x = hn::MulAdd(high_number(fit23), hn::Load(d, scratch.place[2] + i), x);
    x = hn::Mul(x, unit);

    const auto length = hn::ShiftRight<16>(run), first = low_half(run);
    const auto last_after = hn::ConvertTo(d, length);
    const auto after = hn::Min(hn::Max(hn::Sub(hn::Add(x, whole), whole), hn::Zero(d)), last_after);
    // Also what is no number stays in the run.
    const auto steps =
        hn::Min(hn::And(hn::BitCast(di, hn::Add(after, whole)), hn::Set(di, 0x7fff)), length);
    const auto at = hn::Add(first, steps);
    const auto once = hn::IfThenElse(hn::Lt(at, count), at, hn::Sub(at, count));
    hn::Store(once, di, pixels.bin + i);

    // x must be further from the borders of its direction than it may be off.
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
    scratch.unproven_count += static_cast<int>(
        hn::CompressStore(pixel, is_unproven, di, scratch.unproven + scratch.unproven_count));
    scratch.lists +=
        static_cast<int>(hn::CompressStore(pixel, is_list, di, scratch.with_list + scratch.lists));
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();
#endif

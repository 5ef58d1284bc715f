// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/cell_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "decode/cell_search.cpp"
#include <hwy/foreach_target.h>
// Highway asks for its own header after foreach_target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 16>;
using Ints = hn::RebindToSigned<Floats>;
using Words = hn::RebindToUnsigned<Floats>;
using FloatVector = hn::Vec<Floats>;
using IntVector = hn::Vec<Ints>;

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

/// Cell and place in it of every pixel, and how much the place may be off; infinite where the pixel
/// is too uncertain for its cell.
template <int Rank>
HWY_INLINE void locate(const CellSearchView& view, const PixelTile& pixels, int padded,
                       Scratch& scratch) {
  const Floats d;
  const Ints di;
  const auto lanes = static_cast<int>(hn::Lanes(d));
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
  constexpr float reach = 8e-6f;  // twice this and rounding is less than CellRecord::overlap
  for (int i = 0; i < padded; i += lanes) {
    FloatVector q[Rank];
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
    const auto has_cell = hn::Lt(error, hn::Mul(hn::Set(d, reach), largest));

    auto reciprocal = hn::ApproximateReciprocal(largest);
    reciprocal = hn::Mul(reciprocal, hn::NegMulAdd(largest, reciprocal, hn::Set(d, 2.0f)));
    const auto scale = hn::Mul(half, reciprocal);
    // An error of q moves c by twice itself over the largest component, and t by G times that.
    const auto slip = hn::MulAdd(hn::Mul(error, scale), hn::Set(d, 4.1f), rounding_of_place);
    hn::Store(hn::IfThenElse(has_cell, slip, infinite), d, scratch.slip + i);

    const auto is_negative = hn::ShiftRight<31>(hn::BitCast(Words(), signed_largest));
    auto cell = hn::Add(hn::Add(axis, axis), hn::BitCast(di, is_negative)), cut = hn::Zero(di);
    FloatVector fine_place[3], wide_place[3];
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

HWY_INLINE IntVector low_half(IntVector v) { return hn::And(v, hn::Set(Ints(), 0xffff)); }

/// Low and high halves of words as numbers.
HWY_INLINE FloatVector low_number(IntVector words) {
  return hn::ConvertTo(Floats(), hn::ShiftRight<16>(hn::ShiftLeft<16>(words)));
}
HWY_INLINE FloatVector high_number(IntVector words) {
  return hn::ConvertTo(Floats(), hn::ShiftRight<16>(words));
}

/// The bins of pixels whose cell proves them, and where to begin in the run of the others, which
/// are listed; so are pixels with several runs.
template <int Rank>
HWY_INLINE void predict(const CellSearchView& view, int padded, bool wants_rivals,
                        PixelTile& pixels, Scratch& scratch) {
  const Floats d;
  const Ints di;
  const auto lanes = static_cast<int>(hn::Lanes(d));
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
    if (Rank == 4 || wants_rivals) {
      const auto beside = hn::GatherIndex(di, words + 3, word);
      hn::Store(beside, di, pixels.rival + i);
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
    const auto doubt =
        hn::MulAdd(slack, slack_unit, hn::Mul(steepest, hn::Load(d, scratch.slip + i)));
    const auto place = hn::Sub(x, after);
    const auto above = hn::IfThenElse(hn::Eq(after, last_after), no_border, hn::Sub(half, place));
    const auto below = hn::IfThenElse(hn::Eq(after, hn::Zero(d)), no_border, hn::Add(half, place));
    const auto is_proven = hn::RebindMask(di, hn::Gt(hn::Min(above, below), doubt));
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

/// The vector of one pixel, and how uncertain signs of its products with unit vectors are.
template <int Rank>
struct PixelVector {
  float q[Rank];
  float margin;

  PixelVector(const CellSearchView& view, const PixelTile& pixels, std::int32_t pixel) {
    float size = 0.0f;
    for (int j = 0; j < Rank; ++j) {
      q[j] = pixels.plane[j * tile + pixel];
      size += std::abs(q[j]);
    }
    margin = pixels.error[pixel] + view.rounding * size;
  }
  float along(const float* row) const {
    float sum = q[0] * row[0];
    for (int j = 1; j < Rank; ++j) sum += q[j] * row[j];
    return sum;
  }
};

/// The winner of a run, all counted twice around, by the signs beside it; -1 where one is unsure.
template <int Rank>
HWY_INLINE std::int32_t settle(const CellSearchView& view, const PixelVector<Rank>& pixel,
                               std::int32_t first, std::int32_t last, std::int32_t at) {
  for (bool is_guess = true;; is_guess = false) {
    const float* const steps = view.steps + row_floats * static_cast<std::ptrdiff_t>(at);
    if (at < last) {
      const float after = pixel.along(steps + row_floats);
      if (!(std::abs(after) > pixel.margin)) return -1;
      if (after > 0.0f) {
        first = at + 1;
        at = is_guess ? first : (first + last) / 2;
        continue;
      }
    }
    if (at > first) {
      const float before = pixel.along(steps);
      if (!(std::abs(before) > pixel.margin)) return -1;
      if (before < 0.0f) {
        last = at - 1;
        at = is_guess ? last : (first + last) / 2;
        continue;
      }
    }
    return at;
  }
}

/// Notes the direction of a pixel, twice around, or -1.
HWY_INLINE void keep(const CellSearchView& view, std::int32_t pixel, std::int32_t n,
                     PixelTile& pixels, Scratch& scratch) {
  pixels.bin[pixel] = n < view.count ? n : n - view.count;
  scratch.all_proven = scratch.all_proven && n >= 0;
}

HWY_INLINE bool is_sharp(const Scratch& scratch, std::int32_t pixel) {
  return scratch.slip[pixel] < std::numeric_limits<float>::infinity();
}

/// Searches the runs of the pixels that their cells do not prove.
template <int Rank>
HWY_INLINE void search_runs(const CellSearchView& view, PixelTile& pixels, Scratch& scratch) {
  for (int k = 0; k < scratch.unproven_count; ++k) {
    const std::int32_t pixel = scratch.unproven[k];
    std::int32_t found = -1;
    if (is_sharp(scratch, pixel)) {
      const std::int32_t first = scratch.first[pixel], last = scratch.last[pixel];
      const std::int32_t once = pixels.bin[pixel];
      found = settle<Rank>(view, PixelVector<Rank>(view, pixels, pixel), first, last,
                           once < first ? once + view.count : once);
    }
    keep(view, pixel, found, pixels, scratch);
  }
}

/// The best of the runs of one pixel; -1 where it is unsure.
template <int Rank>
HWY_INLINE std::int32_t search_list(const CellSearchView& view, std::int32_t pixel,
                                    const Scratch& scratch, PixelTile& pixels) {
  const CellRecord& cell = view.cells[scratch.cell[pixel]];
  const PixelVector<Rank> vector(view, pixels, pixel);
  float best = -std::numeric_limits<float>::infinity(), second = best;
  std::int32_t leader = -1;
  for (std::uint32_t e = 0; e < cell.list_length(); ++e) {
    const CellRecord& run = view.lists[cell.list_begin() + e];
    float after = run.fit[0];
    for (int s = 0; s + 1 < Rank; ++s)
      after +=
          static_cast<float>(run.fit[static_cast<std::size_t>(s) + 1]) * scratch.place[s][pixel];
    const float guess = std::max(0.0f, after * view.fit_unit + 0.5f);
    const std::int32_t at =
        settle<Rank>(view, vector, run.first, run.first + run.length,
                     run.first + static_cast<std::int32_t>(std::min<float>(guess, run.length)));
    if (at < 0) return -1;
    const float score = vector.along(view.units + row_floats * static_cast<std::ptrdiff_t>(at));
    second = std::max(second, std::min(best, score));
    if (score <= best) continue;
    best = score;
    leader = at;
    pixels.rival[pixel] = run.rival;
  }
  return best - second > 2.0f * vector.margin ? leader : -1;
}

/// Searches all runs of the pixels that have several.
template <int Rank>
HWY_INLINE void search_lists(const CellSearchView& view, PixelTile& pixels, Scratch& scratch) {
  for (int k = 0; k < scratch.lists; ++k) {
    const std::int32_t pixel = scratch.with_list[k];
    const std::int32_t found =
        is_sharp(scratch, pixel) ? search_list<Rank>(view, pixel, scratch, pixels) : -1;
    keep(view, pixel, found, pixels, scratch);
  }
}

/// @returns whether all pixels are proven
template <int Rank>
bool search_tile(const CellSearchView& view, bool wants_rivals, PixelTile& pixels) {
  const auto lanes = static_cast<int>(hn::Lanes(Floats()));
  const int padded = (pixels.pixels + lanes - 1) / lanes * lanes;
  Scratch scratch;
  locate<Rank>(view, pixels, padded, scratch);
  predict<Rank>(view, padded, wants_rivals, pixels, scratch);
  scratch.all_proven = true;
  if (scratch.unproven_count > 0) search_runs<Rank>(view, pixels, scratch);
  if (scratch.lists > 0) search_lists<Rank>(view, pixels, scratch);
  if (view.bin)
    for (int i = 0; i < pixels.pixels; ++i)
      if (pixels.bin[i] >= 0) pixels.bin[i] = view.bin[pixels.bin[i]];
  return scratch.all_proven;
}

bool search(const CellSearchView& view, bool wants_rivals, PixelTile& pixels) {
  return view.rank == 3 ? search_tile<3>(view, wants_rivals, pixels)
                        : search_tile<4>(view, wants_rivals, pixels);
}

}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tofsmith {

HWY_EXPORT(search);

namespace {

constexpr double unit_roundoff = 0.5 * std::numeric_limits<float>::epsilon();

/// Rows of 4, twice around, beginning with row `begin`.
std::vector<float> twice_around(const RowMajorMatrix& rows, std::int32_t begin) {
  const auto count = static_cast<std::int32_t>(rows.rows());
  std::vector<float> laid;
  for (std::int32_t n = begin; n <= 2 * count; ++n)
    for (int j = 0; j < 4; ++j)
      laid.push_back(j < rows.cols() ? static_cast<float>(rows((n + count) % count, j)) : 0.0f);
  return laid;
}

}  // namespace

CellSearch::CellSearch(const DistinctDirections& directions, const RivalSearch& rivals)
    : table_(directions, rivals), bin_(directions.bin), unit_(directions.unit) {
  const std::int32_t count = directions.count();
  RowMajorMatrix step(count, directions.rank());
  for (std::int32_t n = 0; n < count; ++n)
    step.row(n) = (directions.unit.row(directions.next(n)) - directions.unit.row(n)).normalized();
  steps_ = twice_around(step, -1);
  units_ = twice_around(directions.unit, 0);

  // Rounding a step, r products and r - 1 sums, to first order, with a little for higher ones; and
  // scores that tie, whose neighbours differ by a step at least.
  constexpr double safety = 1.02;
  const double tie = 10 * tie_tolerance / directions.shortest_step;
  view_ = {.rank = directions.rank(),
           .root_bits = table_.root_bits(),
           .cut_bits = table_.cut_bits(),
           .roots = reinterpret_cast<const std::int32_t*>(table_.roots()),
           .cells = table_.cells(),
           .lists = table_.lists(),
           .fit_unit = static_cast<float>(table_.fit_unit()),
           .count = count,
           .steps = steps_.data(),
           .units = units_.data(),
           .bin = directions.bin.back() + 1 == count ? nullptr : bin_.data(),
           .steepest_fit = static_cast<float>(table_.steepest_fit()),
           .rounding = static_cast<float>((directions.rank() + 2) * unit_roundoff * safety + tie)};
}

std::int32_t CellSearch::choose(const double* unit) const {
  const std::span<const CellRecord> runs = table_.runs(unit);
  const auto for_each_score = [&](const auto& use) {
    for (const CellRecord& run : runs)
      for (std::int32_t i = 0; i <= run.length; ++i) {
        const std::int32_t n = (run.first + i) % view_.count;
        double score = 0.0;
        for (int j = 0; j < view_.rank; ++j) score += unit[j] * unit_(n, j);
        use(n, score);
      }
  };
  double best = -std::numeric_limits<double>::infinity();
  for_each_score([&](std::int32_t, double score) { best = std::max(best, score); });
  std::int32_t lowest = view_.count;
  for_each_score([&](std::int32_t n, double score) {
    if (score >= best - tie_tolerance) lowest = std::min(lowest, n);
  });
  return bin_[static_cast<std::size_t>(lowest)];
}

bool CellSearch::search(bool wants_rivals, PixelTile& tile) const {
  return HWY_DYNAMIC_DISPATCH(search)(view_, wants_rivals, tile);
}

}  // namespace tofsmith
#endif

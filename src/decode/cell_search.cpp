// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/cell_search.hpp"

#include <algorithm>
#include <bit>
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
constexpr int row_floats = 4;       // of a step or a direction
constexpr int most_searches = 512;  // of pixels with several runs, at a time

/// One search of a run each: where it is, and what is left of the run.
struct Searches {
  int count;
  std::int32_t pixel[most_searches + 16];
  std::int32_t slot[most_searches + 16];  // of the result
  std::int32_t first[most_searches + 16];
  std::int32_t last[most_searches + 16];
  std::int32_t at[most_searches + 16];
};

struct Scratch {
  alignas(64) float place[3][tile];  // t_s in the cell
  alignas(64) std::int32_t cell[tile];
  alignas(64) std::uint32_t record[4 * tile];
  alignas(64) std::int32_t first[tile];
  alignas(64) std::int32_t last[tile];
  alignas(64) float slip[tile];
  std::int32_t with_list[tile + 16];
  std::int32_t unproven[tile + 16];
  int lists;
  int unproven_count;
  bool all_proven;
  Searches searches;
  std::int32_t result[most_searches + 16];
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
  const auto sides = static_cast<float>(view.resolution);
  const auto half = hn::Set(d, 0.5f * sides), middle = hn::Set(d, to_whole + 0.5f * (sides - 1));
  const auto first_cell = hn::Set(d, to_whole), last_cell = hn::Set(d, to_whole + sides - 1);
  const auto low_bits = hn::Set(di, view.resolution - 1);
  const auto infinite = hn::Set(d, std::numeric_limits<float>::infinity());
  const auto rounding_of_place = hn::Set(d, 1e-6f * (sides + 2));
  constexpr float reach = 8e-6f;  // twice this and rounding is less than CellTable::overlap
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
    const auto is_sharp = hn::Lt(error, hn::Mul(hn::Set(d, reach), largest));

    auto reciprocal = hn::ApproximateReciprocal(largest);
    reciprocal = hn::Mul(reciprocal, hn::NegMulAdd(largest, reciprocal, hn::Set(d, 2.0f)));
    const auto scale = hn::Mul(half, reciprocal);
    // An error of q moves c by twice itself over the largest component, and t by G times that.
    const auto slip = hn::MulAdd(hn::Mul(error, scale), hn::Set(d, 4.1f), rounding_of_place);
    hn::Store(hn::IfThenElse(is_sharp, slip, infinite), d, scratch.slip + i);

    const auto is_negative = hn::ShiftRight<31>(hn::BitCast(Words(), signed_largest));
    auto cell = hn::Add(hn::Add(axis, axis), hn::BitCast(di, is_negative));
    for (int s = 0; s + 1 < Rank; ++s) {
      const auto is_before = hn::RebindMask(d, hn::Gt(axis, hn::Set(di, s)));
      const auto c = hn::Mul(hn::IfThenElse(is_before, q[s], q[s + 1]), scale);
      const auto index = hn::Min(hn::Max(hn::Add(c, middle), first_cell), last_cell);
      const auto centre = hn::Sub(index, middle);
      const auto within = hn::Sub(c, centre);
      hn::Store(hn::Add(within, within), d, scratch.place[s] + i);
      // Also what is no number lands in a cell.
      cell = hn::Add(hn::ShiftLeftSame(cell, view.resolution_bits),
                     hn::And(hn::BitCast(di, index), low_bits));
    }
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
HWY_INLINE void predict(const CellSearchView& view, int padded, PixelTile& pixels,
                        Scratch& scratch) {
  const Floats d;
  const Ints di;
  const Words dw;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  for (int i = 0; i < padded; ++i)
    std::memcpy(scratch.record + 4 * i, view.cells + scratch.cell[i], sizeof(CellRecord));
  scratch.lists = scratch.unproven_count = 0;
  const auto unit = hn::Set(d, view.fit_unit), half = hn::Set(d, 0.5f),
             whole = hn::Set(d, to_whole);
  const auto slack_unit = hn::Set(d, static_cast<float>(CellRecord::slack_unit)),
             steepest = hn::Set(d, view.steepest_fit), no_border = hn::Set(d, 1e30f);
  const auto count = hn::Set(di, view.count);
  for (int i = 0; i < padded; i += lanes) {
    hn::Vec<Words> w0, w1, w2, w3;
    hn::LoadInterleaved4(dw, scratch.record + 4 * i, w0, w1, w2, w3);
    const auto run = hn::BitCast(di, w0), fit01 = hn::BitCast(di, w1), fit23 = hn::BitCast(di, w2),
               beside = hn::BitCast(di, w3);
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
    hn::Store(beside, di, pixels.rival + i);

    // x must be further from the borders of its direction than it may be off.
    const auto slack = hn::ConvertTo(d, hn::BitCast(di, hn::ShiftRight<16>(w3)));
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
    const auto pixel = hn::Iota(di, i);
    scratch.unproven_count += static_cast<int>(
        hn::CompressStore(pixel, is_unproven, di, scratch.unproven + scratch.unproven_count));
    scratch.lists +=
        static_cast<int>(hn::CompressStore(pixel, is_list, di, scratch.with_list + scratch.lists));
  }
}

/// What the two signs at a direction say.
struct Verdict {
  hn::Mask<Ints> up, down, unsure;
};

HWY_INLINE Verdict judge(FloatVector before, FloatVector after, FloatVector margin, IntVector first,
                         IntVector last, IntVector at) {
  const Floats d;
  const Ints di;
  const auto has_after = hn::Lt(at, last), has_before = hn::Gt(at, first);
  const auto is_near = [&](FloatVector sign) {
    return hn::Not(hn::RebindMask(di, hn::Gt(hn::Abs(sign), margin)));
  };
  return {hn::And(has_after, hn::RebindMask(di, hn::Gt(after, hn::Zero(d)))),
          hn::And(has_before, hn::RebindMask(di, hn::Lt(before, hn::Zero(d)))),
          hn::Or(hn::And(has_after, is_near(after)), hn::And(has_before, is_near(before)))};
}

/// Settles the searches there are; results by slot, -1 where unsure.
template <int Rank>
void settle(const CellSearchView& view, const PixelTile& pixels, Scratch& scratch) {
  const Floats d;
  const Ints di;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  Searches& all = scratch.searches;
  for (bool is_first_step = true; all.count > 0; is_first_step = false) {
    int left = 0;
    for (int i = 0; i < all.count; i += lanes) {
      const auto is_there = hn::FirstN(di, static_cast<std::size_t>(all.count - i));
      const auto load = [&](const std::int32_t* from) {
        return hn::IfThenElseZero(is_there, hn::LoadU(di, from + i));
      };
      const auto pixel = load(all.pixel), slot = load(all.slot), first = load(all.first),
                 last = load(all.last), at = load(all.at);
      auto before = hn::Zero(d), after = hn::Zero(d), size = hn::Zero(d);
      const auto row = hn::ShiftLeft<2>(at);
      for (int j = 0; j < Rank; ++j) {
        const auto q = hn::GatherIndex(d, pixels.plane + j * tile, pixel);
        before = hn::MulAdd(q, hn::GatherIndex(d, view.steps + j, row), before);
        after = hn::MulAdd(q, hn::GatherIndex(d, view.steps + row_floats + j, row), after);
        size = hn::Add(size, hn::Abs(q));
      }
      const auto margin =
          hn::MulAdd(size, hn::Set(d, view.rounding), hn::GatherIndex(d, pixels.error, pixel));
      const Verdict verdict = judge(before, after, margin, first, last, at);
      const auto moves = hn::AndNot(verdict.unsure, hn::Or(verdict.up, verdict.down));
      const auto one = hn::Set(di, 1);
      const auto new_first = hn::IfThenElse(verdict.up, hn::Add(at, one), first);
      const auto new_last = hn::IfThenElse(verdict.down, hn::Sub(at, one), last);
      const auto middle = hn::ShiftRight<1>(hn::Add(new_first, new_last));
      const auto beside = hn::IfThenElse(verdict.up, new_first, new_last);
      const auto next = is_first_step ? beside : middle;

      const auto settled = hn::AndNot(moves, is_there);
      const auto found = hn::IfThenElse(verdict.unsure, hn::Set(di, -1), at);
      alignas(64) std::int32_t slots[16], rows[16];
      const auto count = hn::CompressStore(slot, settled, di, slots);
      hn::CompressStore(found, settled, di, rows);
      for (std::size_t k = 0; k < count; ++k) scratch.result[slots[k]] = rows[k];

      const auto stays = hn::And(moves, is_there);
      hn::CompressStore(pixel, stays, di, all.pixel + left);
      hn::CompressStore(slot, stays, di, all.slot + left);
      hn::CompressStore(new_first, stays, di, all.first + left);
      hn::CompressStore(new_last, stays, di, all.last + left);
      left += static_cast<int>(hn::CompressStore(next, stays, di, all.at + left));
    }
    all.count = left;
  }
}

/// Notes the direction of a pixel, twice around, or -1.
HWY_INLINE void keep(const CellSearchView& view, std::int32_t pixel, std::int32_t n,
                     PixelTile& pixels, Scratch& scratch) {
  pixels.bin[pixel] = n < view.count ? n : n - view.count;
  scratch.all_proven = scratch.all_proven && n >= 0;
}

/// Searches the runs of the pixels that their cells do not prove.
template <int Rank>
HWY_INLINE void search_runs(const CellSearchView& view, PixelTile& pixels, Scratch& scratch) {
  Searches& all = scratch.searches;
  all.count = 0;
  for (int k = 0; k < scratch.unproven_count; ++k) {
    const std::int32_t pixel = scratch.unproven[k], once = pixels.bin[pixel];
    if (!(scratch.slip[pixel] < std::numeric_limits<float>::infinity())) {
      scratch.result[k] = -1;
      continue;
    }
    const int at = all.count++;
    all.pixel[at] = pixel;
    all.slot[at] = k;
    all.first[at] = scratch.first[pixel];
    all.last[at] = scratch.last[pixel];
    all.at[at] = once < all.first[at] ? once + view.count : once;
  }
  settle<Rank>(view, pixels, scratch);
  for (int k = 0; k < scratch.unproven_count; ++k)
    keep(view, scratch.unproven[k], scratch.result[k], pixels, scratch);
}

/// A run of a pixel that has several.
struct Entry {
  std::int32_t pixel;
  const CellRecord* record;
};

/// The best of the runs of one pixel, given the peak of each.
template <int Rank>
HWY_INLINE void choose_run(const CellSearchView& view, const Entry* entries, const std::int32_t* at,
                           int count, Scratch& scratch, PixelTile& pixels) {
  const std::int32_t pixel = entries[0].pixel;
  float best = -std::numeric_limits<float>::infinity(), second = best;
  int leader = 0;
  bool is_sure = true;
  float margin = pixels.error[pixel];
  for (int j = 0; j < Rank; ++j) margin += view.rounding * std::abs(pixels.plane[j * tile + pixel]);
  for (int e = 0; e < count; ++e) {
    is_sure = is_sure && at[e] >= 0;
    const float* unit = view.units + row_floats * static_cast<std::ptrdiff_t>(std::max(at[e], 0));
    float score = 0.0f;
    for (int j = 0; j < Rank; ++j) score += unit[j] * pixels.plane[j * tile + pixel];
    if (score > best) {
      second = best;
      best = score;
      leader = e;
    } else {
      second = std::max(second, score);
    }
  }
  is_sure = is_sure && best - second > 2.0f * margin;
  keep(view, pixel, is_sure ? at[leader] : -1, pixels, scratch);
  pixels.rival[pixel] = entries[leader].record->rival;
}

/// Searches all runs of the pixels that have several.
template <int Rank>
HWY_INLINE void search_lists(const CellSearchView& view, PixelTile& pixels, Scratch& scratch) {
  Searches& all = scratch.searches;
  Entry entries[most_searches];
  int next = 0;
  while (next < scratch.lists) {
    int filled = 0;
    all.count = 0;
    for (; next < scratch.lists; ++next) {
      const std::int32_t pixel = scratch.with_list[next];
      const CellRecord& cell = view.cells[scratch.cell[pixel]];
      const auto runs = static_cast<int>(cell.list_length());
      if (runs > most_searches || !(scratch.slip[pixel] < std::numeric_limits<float>::infinity())) {
        keep(view, pixel, -1, pixels, scratch);
        continue;
      }
      if (filled + runs > most_searches) break;
      for (int e = 0; e < runs; ++e, ++filled) {
        const CellRecord& run = view.lists[cell.list_begin() + static_cast<std::uint32_t>(e)];
        entries[filled] = {pixel, &run};
        scratch.result[filled] = run.first;
        if (run.length == 0) continue;
        float after = run.fit[0];
        for (int s = 0; s + 1 < Rank; ++s)
          after += static_cast<float>(run.fit[static_cast<std::size_t>(s) + 1]) *
                   scratch.place[s][pixel];
        const int k = all.count++;
        all.pixel[k] = pixel;
        all.slot[k] = filled;
        all.first[k] = run.first;
        all.last[k] = run.first + run.length;
        all.at[k] = run.first +
                    std::clamp(static_cast<int>(after * view.fit_unit + 0.5f), 0, int{run.length});
      }
    }
    settle<Rank>(view, pixels, scratch);
    for (int begin = 0; begin < filled;) {
      int end = begin + 1;
      while (end < filled && entries[end].pixel == entries[begin].pixel) ++end;
      choose_run<Rank>(view, entries + begin, scratch.result + begin, end - begin, scratch, pixels);
      begin = end;
    }
  }
}

/// @returns whether all pixels are proven
template <int Rank>
bool search_tile(const CellSearchView& view, PixelTile& pixels) {
  const auto lanes = static_cast<int>(hn::Lanes(Floats()));
  const int padded = (pixels.pixels + lanes - 1) / lanes * lanes;
  Scratch scratch;
  locate<Rank>(view, pixels, padded, scratch);
  predict<Rank>(view, padded, pixels, scratch);
  scratch.all_proven = true;
  if (scratch.unproven_count > 0) search_runs<Rank>(view, pixels, scratch);
  if (scratch.lists > 0) search_lists<Rank>(view, pixels, scratch);
  if (view.bin)
    for (int i = 0; i < pixels.pixels; ++i)
      if (pixels.bin[i] >= 0) pixels.bin[i] = view.bin[pixels.bin[i]];
  return scratch.all_proven;
}

bool search(const CellSearchView& view, PixelTile& pixels) {
  return view.rank == 3 ? search_tile<3>(view, pixels) : search_tile<4>(view, pixels);
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
           .resolution = table_.resolution(),
           .resolution_bits = std::countr_zero(static_cast<unsigned>(table_.resolution())),
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

bool CellSearch::search(PixelTile& tile) const { return HWY_DYNAMIC_DISPATCH(search)(view_, tile); }

}  // namespace tofsmith
#endif

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/search/cell_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "decode/search/cell_search.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "decode/search/cell_place-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {

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

/// Returns the best direction of a run (index up to 2 M) from the signs of neighbouring score
/// differences; -1 if one is not certain.
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

HWY_INLINE void keep(const CellSearchView& view, std::int32_t pixel, std::int32_t n,
                     PixelTile& pixels, Scratch& scratch) {
  pixels.bin[pixel] = n < view.count ? n : n - view.count;
  scratch.all_proven = scratch.all_proven && n >= 0;
}

HWY_INLINE bool is_sharp(const Scratch& scratch, std::int32_t pixel) {
  return scratch.slip[pixel] < std::numeric_limits<float>::infinity();
}

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

template <int Rank>
HWY_INLINE std::int32_t search_list(const CellSearchView& view, std::int32_t pixel,
                                    const Scratch& scratch, const PixelTile& pixels) {
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
  }
  return best - second > 2.0f * vector.margin ? leader : -1;
}

template <int Rank>
HWY_INLINE void search_lists(const CellSearchView& view, PixelTile& pixels, Scratch& scratch) {
  for (int k = 0; k < scratch.lists; ++k) {
    const std::int32_t pixel = scratch.with_list[k];
    const std::int32_t found =
        is_sharp(scratch, pixel) ? search_list<Rank>(view, pixel, scratch, pixels) : -1;
    keep(view, pixel, found, pixels, scratch);
  }
}

/// @returns true if all pixels are proven
template <int Rank>
bool search_tile(const CellSearchView& view, PixelTile& pixels) {
  const int lanes = lanes_of();
  const int padded = rounded_up(pixels.pixels, lanes);
  Scratch scratch;
  locate<Rank>(view, pixels, padded, scratch);
  if (Rank == 4) {
    enter_roots(view, padded, scratch);
    place_in_roots(view, padded, scratch);
  }
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

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tofsmith {

HWY_EXPORT(search);

namespace {

constexpr double unit_roundoff = 0.5 * std::numeric_limits<float>::epsilon();

std::vector<float> twice_around(const RowMajorMatrix& rows, std::int32_t begin) {
  const auto count = static_cast<std::int32_t>(rows.rows());
  std::vector<float> laid;
  for (std::int32_t n = begin; n <= 2 * count; ++n)
    for (int j = 0; j < 4; ++j)
      laid.push_back(j < rows.cols() ? static_cast<float>(rows((n + count) % count, j)) : 0.0f);
  return laid;
}

}  // namespace

CellSearch::CellSearch(const DistinctDirections& directions)
    : table_(directions), bin_(directions.bin), unit_(directions.unit) {
  const std::int32_t count = directions.count();
  RowMajorMatrix step(count, directions.rank());
  for (std::int32_t n = 0; n < count; ++n)
    step.row(n) = (directions.unit.row(directions.next(n)) - directions.unit.row(n)).normalized();
  steps_ = twice_around(step, -1);
  units_ = twice_around(directions.unit, 0);

  // Rounding errors of a step, r products and r - 1 sums; and ties, whose neighbours differ by at
  // least one step.
  constexpr double safety = 1.02;
  const double tie = 10 * tie_tolerance / directions.shortest_step;
  view_ = {.rank = directions.rank(),
           .root_bits = table_.root_bits(),
           .cut_bits = table_.cut_bits(),
           .roots = reinterpret_cast<const std::int32_t*>(table_.roots().data()),
           .cells = table_.cells().data(),
           .lists = table_.lists().data(),
           .fit_unit = static_cast<float>(table_.fit_unit()),
           .count = count,
           .steps = steps_.data(),
           .units = units_.data(),
           .bin = directions.bin.back() + 1 == count ? nullptr : bin_.data(),
           .steepest_fit = static_cast<float>(table_.steepest_fit()),
           .rounding = static_cast<float>((directions.rank() + 2) * unit_roundoff * safety + tie)};
}

std::int32_t CellSearch::choose(const double* unit, double tie) const {
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
    if (score >= best - tie) lowest = std::min(lowest, n);
  });
  return bin_[static_cast<std::size_t>(lowest)];
}

bool CellSearch::search(PixelTile& tile) const { return HWY_DYNAMIC_DISPATCH(search)(view_, tile); }

}  // namespace tofsmith
#endif

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/search/arc_search.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "decode/search/arc_search.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "decode/search/arc_walk-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {

constexpr int group_pixels = 16;  // to hide latencies

/// Best and second best score of every lane.
struct Leaders {
  float best[block_lanes];
  float second[block_lanes];
  std::int32_t row[block_lanes];
};

template <int Rank>
struct MeetRows {
  const ArcTable& table;
  const Query& q;
  Vector best, second;
  IndexVector row;
  HWY_INLINE void operator()(std::int32_t block) {
    for (int i = 0; i < block_lanes; i += lanes_of()) {
      const Vector score = scores<Rank>(q, table.rows(block) + i);
      const auto leads = hn::RebindMask(Indices(), hn::Gt(score, best));
      row = hn::IfThenElse(leads, hn::Set(Indices(), block * block_lanes + i), row);
      second = hn::Max(second, hn::Min(best, score));
      best = hn::Max(best, score);
    }
  }
};

template <int Rank>
HWY_INLINE void meet_near_rows(const ArcTable& table, const Query& q, const Walk& walk,
                               Leaders& leaders) {
  MeetRows<Rank> meet{table, q, all(no_score), all(no_score), hn::Zero(Indices())};
  for_each_near_rows<Rank>(table, q, walk, meet);
  hn::StoreU(meet.best, Floats(), leaders.best);
  hn::StoreU(meet.second, Floats(), leaders.second);
  hn::StoreU(hn::Add(meet.row, hn::Iota(Indices(), 0)), Indices(), leaders.row);
}

/// Returns the row that leads by more than `margin`, or -1.
template <int Rank>
HWY_INLINE std::int32_t leader_of_window(const float* window, const Query& q, float margin) {
  HWY_ALIGN float score[block_lanes];
  Vector best = all(no_score);
  for (int i = 0; i < block_lanes; i += lanes_of()) {
    const Vector part = scores<Rank>(q, window + i);
    hn::Store(part, Floats(), score + i);
    best = hn::Max(best, part);
  }
  const Vector least = all(largest(best) - margin);
  std::uint32_t reached = 0;
  for (int i = 0; i < block_lanes; i += lanes_of())
    reached |= bits_of(hn::Ge(hn::Load(Floats(), score + i), least)) << i;
  return std::has_single_bit(reached) ? std::countr_zero(reached) : -1;
}

/// Proves the best row. Rows close to the best score are compared by differences of directions,
/// which are short and therefore accurate; others must be behind by a larger margin.
template <int Rank>
HWY_INLINE std::int32_t prove(const ArcTable& table, const Query& q, const Leaders& leaders,
                              const Margins& margins, float error) {
  const Floats d;
  const Vector best = hn::LoadU(d, leaders.best);
  const float most = largest(best);
  const auto lane = static_cast<std::size_t>(
      std::max<std::intptr_t>(0, hn::FindFirstTrue(d, hn::Eq(best, all(most)))));
  constexpr std::int32_t step = block_lanes / 2;
  const std::int32_t w = std::clamp((leaders.row[lane] - step / 2) / step, 0, table.windows() - 1);

  const auto row = hn::LoadU(Indices(), leaders.row);
  const auto is_below = hn::Lt(row, hn::Set(Indices(), w * step));
  const auto is_above = hn::Gt(row, hn::Set(Indices(), w * step + block_lanes - 1));
  const Vector outside = hn::IfThenElse(hn::RebindMask(d, hn::Or(is_below, is_above)), best,
                                        hn::LoadU(d, leaders.second));
  const float lead = margins.lead * q.length + 2.0f * error, tie = margins.tie * q.length;
  const bool leads = hn::AllTrue(d, hn::Lt(outside, all(most - (lead + tie))));
  const std::int32_t found =
      leader_of_window<Rank>(table.window(w), q, lead * table.window_radius(w) + tie);
  return leads && found >= 0 ? w * step + found : -1;
}

HWY_INLINE bool can_be_proven(float length, float error) {
  return length > 1e-12f && length < 1e12f && error < length;
}

template <int Rank>
void search_rows(const ArcTable& table, const float* plane, int stride, const float* error,
                 int pixels, std::int32_t* row) {
  const int rank = Rank > 0 ? Rank : table.rank();
  const Margins margins = margins_of(rank);
  Query q[group_pixels];
  Walk walk[group_pixels];
  Leaders leaders[group_pixels];
  for (int first = 0; first < pixels; first += group_pixels) {
    int count = 0, pixel[group_pixels];
    for (int i = first; i < std::min(first + group_pixels, pixels); ++i) {
      float square = 0.0f;
      for (int j = 0; j < rank; ++j) square += plane[j * stride + i] * plane[j * stride + i];
      const float length = std::sqrt(square);
      row[i] = -1;
      if (!can_be_proven(length, error[i])) continue;
      pixel[count] = i;
      q[count++] = {plane + i, stride, rank, length};
    }
    const auto slack = [&](int k) { return margins.prune * q[k].length + 2.0f * error[pixel[k]]; };
    for (int k = 0; k < count; ++k) start_walk<Rank>(table, q[k], slack(k), walk[k]);
    for (int k = 0; k < count; ++k) refine_walk<Rank>(table, q[k], slack(k), walk[k]);
    for (int k = 0; k < count; ++k) meet_near_rows<Rank>(table, q[k], walk[k], leaders[k]);
    for (int k = 0; k < count; ++k)
      row[pixel[k]] = prove<Rank>(table, q[k], leaders[k], margins, error[pixel[k]]);
  }
}

void search(const ArcTable& table, const float* plane, int stride, const float* error, int pixels,
            std::int32_t* row) {
  switch (table.rank()) {
    case 4:
      return search_rows<4>(table, plane, stride, error, pixels, row);
    case 5:
      return search_rows<5>(table, plane, stride, error, pixels, row);
    case 6:
      return search_rows<6>(table, plane, stride, error, pixels, row);
    case 7:
      return search_rows<7>(table, plane, stride, error, pixels, row);
    case 8:
      return search_rows<8>(table, plane, stride, error, pixels, row);
    default:
      return search_rows<0>(table, plane, stride, error, pixels, row);
  }
}

struct DoubleScores {
  const DirectionTable& directions;
  const double* unit;
  int stride;
  double score[rows_per_block];
  HWY_INLINE void of(std::int32_t block) {
    const double* direction = directions.block(block);
    for (int row = 0; row < rows_per_block; ++row) score[row] = unit[0] * direction[row];
    for (int j = 1; j < directions.rank(); ++j)
      for (int row = 0; row < rows_per_block; ++row)
        score[row] += unit[j * stride] * direction[j * rows_per_block + row];
  }
};

struct MeetBest {
  DoubleScores& scores;
  double best;
  HWY_INLINE void operator()(std::int32_t rows) {
    const std::int32_t end = std::min(2 * (rows + 1), scores.directions.blocks());
    for (std::int32_t block = 2 * rows; block < end; ++block) {
      scores.of(block);
      for (const double score : scores.score) best = std::max(best, score);
    }
  }
};

struct MeetLowest {
  DoubleScores& scores;
  double least;
  std::int32_t row;
  HWY_INLINE void operator()(std::int32_t rows) {
    const std::int32_t end = std::min(2 * (rows + 1), scores.directions.blocks());
    for (std::int32_t block = 2 * rows; block < end; ++block) {
      scores.of(block);
      for (int i = rows_per_block - 1; i >= 0; --i)
        if (scores.score[i] >= least) row = std::min(row, block * rows_per_block + i);
    }
  }
};

std::int32_t choose_row(const ArcTable& table, const DirectionTable& directions, const double* unit,
                        int stride, double tie) {
  float components[max_measurements];
  for (int j = 0; j < table.rank(); ++j) components[j] = static_cast<float>(unit[j * stride]);
  const Query q{components, 1, table.rank(), 1.0f};
  const Margins margins = margins_of(q.rank);
  const float slack = margins.prune + margins.lead + 1.01f * static_cast<float>(tie);
  Walk walk;
  start_walk<0>(table, q, slack, walk);
  refine_walk<0>(table, q, slack, walk);

  DoubleScores scores{directions, unit, stride, {}};
  MeetBest best{scores, -2.0};
  for_each_near_rows<0>(table, q, walk, best);
  MeetLowest lowest{scores, best.best - tie, table.samples()};
  for_each_near_rows<0>(table, q, walk, lowest);
  return lowest.row;
}

struct MeetScores {
  const ArcTable& table;
  const Query& q;
  float* score;
  float best = no_score;
  HWY_INLINE void operator()(std::int32_t block) {
    Vector most = all(no_score);
    for (int i = 0; i < block_lanes; i += lanes_of()) {
      const Vector part = scores<0>(q, table.rows(block) + i);
      hn::StoreU(part, Floats(), score + block * block_lanes + i);
      most = hn::Max(most, part);
    }
    best = std::max(best, largest(most));
  }
};

int near_peaks(const ArcTable& table, const float* unit, float slack, int room,
               std::int32_t* found) {
  const Query q{unit, 1, table.rank(), 1.0f};
  const Margins margins = margins_of(q.rank);
  const float reach = slack + margins.prune + margins.lead;
  Walk walk;
  start_walk<0>(table, q, reach, walk);
  refine_walk<0>(table, q, reach, walk);
  thread_local std::vector<float> score;
  const auto rows = static_cast<std::size_t>(table.row_blocks()) * block_lanes;
  score.assign(rows, no_score);
  MeetScores meet{table, q, score.data()};
  for_each_near_rows<0>(table, q, walk, meet);

  const float least = meet.best - reach;
  const std::int32_t samples = table.samples();
  int count = 0;
  for (std::int32_t n = 0; n < samples; ++n) {
    const float here = score[static_cast<std::size_t>(n)];
    if (!(here >= least)) continue;
    const float before = score[static_cast<std::size_t>(n > 0 ? n - 1 : samples - 1)];
    const float after = score[static_cast<std::size_t>(n + 1 < samples ? n + 1 : 0)];
    if (here < before || here < after) continue;
    if (count < room) {
      found[count++] = n;
      continue;
    }
    std::int32_t* const worst = std::min_element(found, found + room, [&](auto a, auto b) {
      return score[static_cast<std::size_t>(a)] < score[static_cast<std::size_t>(b)];
    });
    if (score[static_cast<std::size_t>(*worst)] < here) *worst = n;
  }
  return count;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tofsmith {

HWY_EXPORT(search);
HWY_EXPORT(choose_row);
HWY_EXPORT(near_peaks);

void ArcSearch::search(const float* plane, int stride, const float* error, int pixels,
                       std::int32_t* row) const {
  HWY_DYNAMIC_DISPATCH(search)(table_, plane, stride, error, pixels, row);
}

int ArcSearch::near_peaks(const float* unit, float slack, int room, std::int32_t* found) const {
  return HWY_DYNAMIC_DISPATCH(near_peaks)(table_, unit, slack, room, found);
}

std::int32_t ArcSearch::choose(const DirectionTable& directions, const double* unit, int stride,
                               double tie) const {
  bool is_zero = true;
  for (int j = 0; j < directions.rank(); ++j) is_zero = is_zero && unit[j * stride] == 0.0;
  return is_zero ? 0 : HWY_DYNAMIC_DISPATCH(choose_row)(table_, directions, unit, stride, tie);
}

}  // namespace tofsmith
#endif

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/arc_search.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "decode/arc_search.cpp"
#include <hwy/foreach_target.h>
// Highway asks for its own header after foreach_target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, block_lanes>;
using Vector = hn::Vec<Floats>;
using Mask = hn::Mask<Floats>;
using Indices = hn::RebindToSigned<Floats>;
using IndexVector = hn::Vec<Indices>;

constexpr float no_score = -std::numeric_limits<float>::infinity();
constexpr float unit_roundoff = 0.5f * std::numeric_limits<float>::epsilon();
constexpr int group_pixels = 16;      // whose steps are taken together, so that they overlap
constexpr int most_flat_blocks = 16;  // of arcs that are looked at one by one

HWY_INLINE int lanes() { return static_cast<int>(hn::Lanes(Floats())); }
HWY_INLINE Vector set(float value) { return hn::Set(Floats(), value); }
HWY_INLINE float largest(Vector v) { return hn::GetLane(hn::MaxOfLanes(Floats(), v)); }

HWY_INLINE std::uint32_t bits_of(Mask mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(Floats(), mask, bytes);
  std::uint16_t bits;
  std::memcpy(&bits, bytes, sizeof bits);
  return bits;
}

/// One vector q, its components `stride` apart.
struct Query {
  const float* first;
  int stride;
  int rank;
  float length;
  HWY_INLINE float operator[](int j) const { return first[j * stride]; }
};

/// Scores of as many vectors of a block as fit, each plus its offset.
template <int Rank>
HWY_INLINE Vector scores(const Query& q, const float* block) {
  const Floats d;
  const int rank = Rank > 0 ? Rank : q.rank;
  Vector sum = hn::Load(d, block);
  for (int j = 0; j < rank; ++j)
    sum = hn::MulAdd(set(q[j]), hn::Load(d, block + (j + 1) * block_lanes), sum);
  return sum;
}

/// How far float scores may be off, as shares of |q| (in all: `per_error` times the error of q and
/// `share` |q|). `lead` is what proves that one score beats another; pruned is what scores less
/// than the best by more than `prune`.
struct Margins {
  float lead;
  float tie;
  float prune;
};

// Rounding a direction to float and summing rank products, fused or not, moves a score by at most
// (rank + 2) u |q| to first order. The bound of an arc takes at most 1.5 of that from its knots
// (growth), and few u |q| from its own operations.
HWY_INLINE Margins margins_of(int rank) {
  const float score = static_cast<float>(rank + 2) * unit_roundoff * 1.01f;
  const float bound = 4.0f * static_cast<float>(rank + 4) * unit_roundoff;
  const auto tie = static_cast<float>(2 * tie_tolerance);
  return {2.0f * score, tie, score + bound + tie};
}

/// The arcs of one query that may hold its best row: of all, or of the bundles that may.
struct Walk {
  std::uint64_t near[most_bundle_blocks / 4];  // bits of arcs (flat) or bundles, 16 a block
  float threshold;                             // bounds below it are passed over
};

/// All rows count.
struct Anywhere {
  HWY_INLINE Vector operator()(Vector score, std::int32_t, std::int32_t) const { return score; }
};

/// Rows at the positions [begin, end), modulo N, count.
struct Within {
  std::int32_t begin, end, samples;
  /// Positions of rows first, first + step, ..; those that do not count are -1.
  HWY_INLINE IndexVector positions(std::int32_t first, std::int32_t step) const {
    const Indices d;
    const auto row = hn::Min(hn::Add(hn::Mul(hn::Iota(d, 0), hn::Set(d, step)), hn::Set(d, first)),
                             hn::Set(d, samples - 1));
    const auto least = hn::Set(d, begin), none = hn::Set(d, -1);
    const auto position =
        hn::IfThenElse(hn::Lt(row, least), hn::Add(row, hn::Set(d, samples)), row);
    const auto in_time = hn::IfThenElse(hn::Lt(position, hn::Set(d, end)), position, none);
    return hn::IfThenElse(hn::Lt(position, least), none, in_time);
  }
  HWY_INLINE Vector operator()(Vector score, std::int32_t first, std::int32_t step) const {
    const auto counts = hn::Gt(positions(first, step), hn::Set(Indices(), -1));
    return hn::IfThenElse(hn::RebindMask(Floats(), counts), score, set(no_score));
  }
};

/// A threshold at or below 0 would need negative scores in its bounds: nothing is passed over.
HWY_INLINE float threshold_of(float best, float slack) {
  return best > slack ? best - slack : no_score;
}

/// Bits of the knots whose score reaches what the bounds of their arcs ask for.
HWY_INLINE std::uint32_t reaching(Vector score, const float* bounds, const Query& q,
                                  float threshold) {
  const Floats d;
  const Vector needed = hn::NegMulAdd(set(q.length), hn::Load(d, bounds + block_lanes),
                                      hn::Mul(set(threshold), hn::Load(d, bounds)));
  return bits_of(hn::Ge(score, needed));
}

/// Bits of the arcs of a block whose bound reaches the threshold.
template <int Rank>
HWY_INLINE std::uint32_t near_in_block(const float* block, const float* score, const Query& q,
                                       float threshold) {
  const int rank = Rank > 0 ? Rank : q.rank;
  const float* starts = block + (1 + rank) * block_lanes;
  const float* ends = starts + 2 * block_lanes;
  std::uint32_t by_start = 0, by_end = 0;
  for (int i = 0; i < block_lanes; i += lanes()) {
    const Vector positive = hn::Max(hn::Load(Floats(), score + i), hn::Zero(Floats()));
    by_start |= reaching(positive, starts + i, q, threshold) << i;
    by_end |= reaching(positive, ends + i, q, threshold) << i;
  }
  return by_start | by_end >> 1;
}

template <int Rank, typename Where>
HWY_INLINE Vector score_knots(const KnotLevel& level, int b, const Query& q, const Where& where,
                              Vector best, float* score) {
  for (int i = 0; i < block_lanes; i += lanes()) {
    const Vector part = scores<Rank>(q, level.block(b) + i);
    hn::Store(part, Floats(), score + i);
    best = hn::Max(
        best, where(part, (b * arcs_per_block + i) * level.rows_per_arc(), level.rows_per_arc()));
  }
  return best;
}

HWY_INLINE bool is_flat(const ArcTable& table) { return table.arcs().blocks() <= most_flat_blocks; }
HWY_INLINE const KnotLevel& first_level(const ArcTable& table) {
  return is_flat(table) ? table.arcs() : table.bundles();
}

/// Looks at all knots of the first level.
template <int Rank, typename Where>
HWY_INLINE void start_walk(const ArcTable& table, const Query& q, float slack, const Where& where,
                           Walk& walk) {
  HWY_ALIGN float score[most_bundle_blocks * block_lanes];
  const KnotLevel& level = first_level(table);
  Vector best = set(no_score);
  for (int b = 0; b < level.blocks(); ++b)
    best = score_knots<Rank>(level, b, q, where, best, score + b * block_lanes);
  walk.threshold = threshold_of(largest(best), slack);
  for (int b = 0; b < level.blocks(); ++b) {
    const std::uint64_t bits =
        near_in_block<Rank>(level.block(b), score + b * block_lanes, q, walk.threshold);
    walk.near[b / 4] = (b % 4 == 0 ? 0 : walk.near[b / 4]) | bits << b % 4 * block_lanes;
  }
}

/// Calls visit(15 block + bit) for all bits of the first level.
template <typename Visit>
HWY_INLINE void for_each_near(const ArcTable& table, const Walk& walk, Visit& visit) {
  for (int b = 0; b < first_level(table).blocks(); b += 4)
    for (std::uint64_t bits = walk.near[b / 4]; bits != 0; bits &= bits - 1) {
      const int bit = std::countr_zero(bits);
      visit((b + bit / block_lanes) * arcs_per_block + bit % block_lanes);
    }
}

template <int Rank, typename Where>
struct BestKnot {
  const ArcTable& table;
  const Query& q;
  const Where& where;
  float (&most)[block_lanes];
  HWY_INLINE void operator()(std::int32_t bundle) {
    HWY_ALIGN float score[block_lanes];
    const Vector best = hn::Load(Floats(), most);
    hn::Store(score_knots<Rank>(table.arcs(), bundle, q, where, best, score), Floats(), most);
  }
};

/// Raises the threshold by the knots of the arcs in all bundles that are near.
template <int Rank, typename Where>
HWY_INLINE void refine_walk(const ArcTable& table, const Query& q, float slack, const Where& where,
                            Walk& walk) {
  if (is_flat(table)) return;
  HWY_ALIGN float most[block_lanes];
  hn::Store(set(no_score), Floats(), most);
  BestKnot<Rank, Where> best{table, q, where, most};
  for_each_near(table, walk, best);
  walk.threshold = std::max(walk.threshold, threshold_of(largest(hn::Load(Floats(), most)), slack));
}

template <typename Visit>
HWY_INLINE void visit_arc(const ArcTable& table, std::int32_t arc, Visit& visit) {
  const std::int32_t per_arc = table.blocks_per_arc();
  const std::int32_t end = std::min((arc + 1) * per_arc, table.row_blocks());
  for (std::int32_t block = arc * per_arc; block < end; ++block) visit(block);
}

template <typename Visit>
struct OfArc {
  const ArcTable& table;
  Visit& visit;
  HWY_INLINE void operator()(std::int32_t arc) { visit_arc(table, arc, visit); }
};

template <int Rank, typename Visit>
struct OfBundle {
  const ArcTable& table;
  const Query& q;
  float threshold;
  Visit& visit;
  HWY_INLINE void operator()(std::int32_t bundle) {
    HWY_ALIGN float score[block_lanes];
    score_knots<Rank>(table.arcs(), bundle, q, Anywhere(), set(no_score), score);
    std::uint32_t bits = near_in_block<Rank>(table.arcs().block(bundle), score, q, threshold);
    for (; bits != 0; bits &= bits - 1)
      visit_arc(table, bundle * arcs_per_block + std::countr_zero(bits), visit);
  }
};

/// Calls visit(block of rows) for all arcs that may hold the best row.
template <int Rank, typename Visit>
HWY_INLINE void for_each_near_rows(const ArcTable& table, const Query& q, const Walk& walk,
                                   Visit& visit) {
  if (is_flat(table)) {
    OfArc<Visit> of_arc{table, visit};
    for_each_near(table, walk, of_arc);
  } else {
    OfBundle<Rank, Visit> of_bundle{table, q, walk.threshold, visit};
    for_each_near(table, walk, of_bundle);
  }
}

/// What leads in every lane: the best score, the second best, and the row of the best.
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
    for (int i = 0; i < block_lanes; i += lanes()) {
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
  MeetRows<Rank> meet{table, q, set(no_score), set(no_score), hn::Zero(Indices())};
  for_each_near_rows<Rank>(table, q, walk, meet);
  hn::StoreU(meet.best, Floats(), leaders.best);
  hn::StoreU(meet.second, Floats(), leaders.second);
  hn::StoreU(hn::Add(meet.row, hn::Iota(Indices(), 0)), Indices(), leaders.row);
}

/// The row of a window that leads in it by more than `margin`, or -1.
template <int Rank>
HWY_INLINE std::int32_t leader_of_window(const float* window, const Query& q, float margin) {
  HWY_ALIGN float score[block_lanes];
  Vector best = set(no_score);
  for (int i = 0; i < block_lanes; i += lanes()) {
    const Vector part = scores<Rank>(q, window + i);
    hn::Store(part, Floats(), score + i);
    best = hn::Max(best, part);
  }
  const Vector least = set(largest(best) - margin);
  std::uint32_t reached = 0;
  for (int i = 0; i < block_lanes; i += lanes())
    reached |= bits_of(hn::Ge(hn::Load(Floats(), score + i), least)) << i;
  return std::has_single_bit(reached) ? std::countr_zero(reached) : -1;
}

/// Around the best score, rows are told apart by differences of directions, which are short and
/// hence exact. All others have to be behind by whole scores.
template <int Rank>
HWY_INLINE std::int32_t prove(const ArcTable& table, const Query& q, const Leaders& leaders,
                              const Margins& margins, float error) {
  const Floats d;
  const Vector best = hn::LoadU(d, leaders.best);
  const float most = largest(best);
  const auto lane = static_cast<std::size_t>(
      std::max<std::intptr_t>(0, hn::FindFirstTrue(d, hn::Eq(best, set(most)))));
  constexpr std::int32_t step = block_lanes / 2;
  const std::int32_t w = std::clamp((leaders.row[lane] - step / 2) / step, 0, table.windows() - 1);

  const auto row = hn::LoadU(Indices(), leaders.row);
  const auto is_below = hn::Lt(row, hn::Set(Indices(), w * step));
  const auto is_above = hn::Gt(row, hn::Set(Indices(), w * step + block_lanes - 1));
  const Vector outside = hn::IfThenElse(hn::RebindMask(d, hn::Or(is_below, is_above)), best,
                                        hn::LoadU(d, leaders.second));
  const float lead = margins.lead * q.length + 2.0f * error, tie = margins.tie * q.length;
  const bool leads = hn::AllTrue(d, hn::Lt(outside, set(most - (lead + tie))));
  const std::int32_t found =
      leader_of_window<Rank>(table.window(w), q, lead * table.window_radius(w) + tie);
  return leads && found >= 0 ? w * step + found : -1;
}

/// Far from where floats under- or overflow.
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
    for (int k = 0; k < count; ++k) start_walk<Rank>(table, q[k], slack(k), Anywhere(), walk[k]);
    for (int k = 0; k < count; ++k) refine_walk<Rank>(table, q[k], slack(k), Anywhere(), walk[k]);
    for (int k = 0; k < count; ++k) meet_near_rows<Rank>(table, q[k], walk[k], leaders[k]);
    for (int k = 0; k < count; ++k)
      row[pixel[k]] = prove<Rank>(table, q[k], leaders[k], margins, error[pixel[k]]);
  }
}

void search(const ArcTable& table, const float* plane, int stride, const float* error, int pixels,
            std::int32_t* row) {
  switch (table.rank()) {
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

/// The best position in every lane.
struct MeetPositions {
  const ArcTable& table;
  const Query& q;
  Within within;
  Vector best;
  IndexVector position;
  HWY_INLINE void operator()(std::int32_t block) {
    const Floats d;
    for (int i = 0; i < block_lanes; i += lanes()) {
      const float* directions = table.rows(block) + block_lanes + i;
      Vector score = hn::Mul(set(q[0]), hn::Load(d, directions));
      for (int j = 1; j < q.rank; ++j)
        score = hn::Add(score, hn::Mul(set(q[j]), hn::Load(d, directions + j * block_lanes)));
      const std::int32_t first = block * block_lanes + i;
      score = within(score, first, 1);
      const auto here = within.positions(first, 1);
      const auto is_lower = hn::RebindMask(d, hn::Lt(here, position));
      const auto leads = hn::Or(hn::Gt(score, best), hn::And(hn::Eq(score, best), is_lower));
      position = hn::IfThenElse(hn::RebindMask(Indices(), leads), here, position);
      best = hn::Max(best, score);
    }
  }
};

std::int32_t best_position(const ArcTable& table, const float* components, std::int32_t begin,
                           std::int32_t end) {
  const Query q{components, 1, table.rank(), 1.0f};
  const Margins margins = margins_of(q.rank);
  const Within within{begin, end, table.samples()};
  Walk walk;
  start_walk<0>(table, q, margins.prune + margins.lead, within, walk);
  refine_walk<0>(table, q, margins.prune + margins.lead, within, walk);
  MeetPositions meet{table, q, within, set(no_score), hn::Set(Indices(), end)};
  for_each_near_rows<0>(table, q, walk, meet);
  const Indices di;
  const auto of_best = hn::RebindMask(di, hn::Eq(meet.best, set(largest(meet.best))));
  return hn::GetLane(hn::MinOfLanes(di, hn::IfThenElse(of_best, meet.position, hn::Set(di, end))));
}

/// Scores of 8 rows in double.
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
                        int stride) {
  float components[max_measurements];
  for (int j = 0; j < table.rank(); ++j) components[j] = static_cast<float>(unit[j * stride]);
  const Query q{components, 1, table.rank(), 1.0f};
  const Margins margins = margins_of(q.rank);
  Walk walk;
  start_walk<0>(table, q, margins.prune + margins.lead, Anywhere(), walk);
  refine_walk<0>(table, q, margins.prune + margins.lead, Anywhere(), walk);

  DoubleScores scores{directions, unit, stride, {}};
  MeetBest best{scores, -2.0};
  for_each_near_rows<0>(table, q, walk, best);
  MeetLowest lowest{scores, best.best - tie_tolerance, table.samples()};
  for_each_near_rows<0>(table, q, walk, lowest);
  return lowest.row;
}

}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tofsmith {

HWY_EXPORT(search);
HWY_EXPORT(best_position);
HWY_EXPORT(choose_row);

void ArcSearch::search(const float* plane, int stride, const float* error, int pixels,
                       std::int32_t* row) const {
  HWY_DYNAMIC_DISPATCH(search)(table_, plane, stride, error, pixels, row);
}

std::int32_t ArcSearch::best_bin_within(const float* components, std::int32_t begin,
                                        std::int32_t end) const {
  return HWY_DYNAMIC_DISPATCH(best_position)(table_, components, begin, end) % table_.samples();
}

std::int32_t ArcSearch::choose(const DirectionTable& directions, const double* unit,
                               int stride) const {
  bool is_zero = true;
  for (int j = 0; j < directions.rank(); ++j) is_zero = is_zero && unit[j * stride] == 0.0;
  return is_zero ? 0 : HWY_DYNAMIC_DISPATCH(choose_row)(table_, directions, unit, stride);
}

}  // namespace tofsmith
#endif

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Branch and bound over arcs.
#if defined(TOFSMITH_DECODE_ARC_WALK_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef TOFSMITH_DECODE_ARC_WALK_INL_HPP
#undef TOFSMITH_DECODE_ARC_WALK_INL_HPP
#else
#define TOFSMITH_DECODE_ARC_WALK_INL_HPP
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>

#include "core/shared/vectors-inl.hpp"
#include "decode/search/arc_table.hpp"

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {

static_assert(block_lanes == widest_vector);
constexpr float no_score = -std::numeric_limits<float>::infinity();
constexpr int max_flat_blocks = 16;

HWY_INLINE float largest(Vector v) { return hn::GetLane(hn::MaxOfLanes(Floats(), v)); }

HWY_INLINE std::uint32_t bits_of(Mask mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(Floats(), mask, bytes);
  std::uint16_t bits;
  std::memcpy(&bits, bytes, sizeof bits);
  return bits;
}

struct Query {
  const float* first;
  int stride;
  int rank;
  float length;
  HWY_INLINE float operator[](int j) const { return first[j * stride]; }
};

template <int Rank>
HWY_INLINE Vector scores(const Query& q, const float* block) {
  const Floats d;
  const int rank = Rank > 0 ? Rank : q.rank;
  Vector sum = hn::Load(d, block);
  for (int j = 0; j < rank; ++j)
    sum = hn::MulAdd(all(q[j]), hn::Load(d, block + (j + 1) * block_lanes), sum);
  return sum;
}

/// Arcs that may contain the best row.
struct Walk {
  std::uint64_t near[max_bundle_blocks / 4];  // bits of arcs (flat) or bundles, 16 per block
  float threshold;                            // lower bounds are excluded
};

/// Thresholds <= 0 exclude nothing: they would require bounds on negative scores.
HWY_INLINE float threshold_of(float best, float slack) {
  return best > slack ? best - slack : no_score;
}

/// Returns the bits of the knots that reach the requirement of their arcs' bounds.
HWY_INLINE std::uint32_t reaching(Vector score, const float* bounds, const Query& q,
                                  float threshold) {
  const Floats d;
  const Vector needed = hn::NegMulAdd(all(q.length), hn::Load(d, bounds + block_lanes),
                                      hn::Mul(all(threshold), hn::Load(d, bounds)));
  return bits_of(hn::Ge(score, needed));
}

/// Returns the bits of the arcs whose bound reaches the threshold.
template <int Rank>
HWY_INLINE std::uint32_t near_in_block(const float* block, const float* score, const Query& q,
                                       float threshold) {
  const int rank = Rank > 0 ? Rank : q.rank;
  const float* starts = block + (1 + rank) * block_lanes;
  const float* ends = starts + 2 * block_lanes;
  std::uint32_t by_start = 0, by_end = 0;
  for (int i = 0; i < block_lanes; i += lanes_of()) {
    const Vector positive = hn::Max(hn::Load(Floats(), score + i), hn::Zero(Floats()));
    by_start |= reaching(positive, starts + i, q, threshold) << i;
    by_end |= reaching(positive, ends + i, q, threshold) << i;
  }
  return by_start | by_end >> 1;
}

template <int Rank>
HWY_INLINE Vector score_knots(const KnotLevel& level, int b, const Query& q, Vector best,
                              float* score) {
  for (int i = 0; i < block_lanes; i += lanes_of()) {
    const Vector part = scores<Rank>(q, level.block(b) + i);
    hn::Store(part, Floats(), score + i);
    best = hn::Max(best, part);
  }
  return best;
}

HWY_INLINE bool is_flat(const ArcTable& table) { return table.arcs().blocks() <= max_flat_blocks; }
HWY_INLINE const KnotLevel& first_level(const ArcTable& table) {
  return is_flat(table) ? table.arcs() : table.bundles();
}

template <int Rank>
HWY_INLINE void start_walk(const ArcTable& table, const Query& q, float slack, Walk& walk) {
  HWY_ALIGN float score[max_bundle_blocks * block_lanes];
  const KnotLevel& level = first_level(table);
  Vector best = all(no_score);
  for (int b = 0; b < level.blocks(); ++b)
    best = score_knots<Rank>(level, b, q, best, score + b * block_lanes);
  walk.threshold = threshold_of(largest(best), slack);
  for (int b = 0; b < level.blocks(); ++b) {
    const std::uint64_t bits =
        near_in_block<Rank>(level.block(b), score + b * block_lanes, q, walk.threshold);
    walk.near[b / 4] = (b % 4 == 0 ? 0 : walk.near[b / 4]) | bits << b % 4 * block_lanes;
  }
}

template <typename Visit>
HWY_INLINE void for_each_near(const ArcTable& table, const Walk& walk, Visit& visit) {
  for (int b = 0; b < first_level(table).blocks(); b += 4)
    for (std::uint64_t bits = walk.near[b / 4]; bits != 0; bits &= bits - 1) {
      const int bit = std::countr_zero(bits);
      visit((b + bit / block_lanes) * arcs_per_block + bit % block_lanes);
    }
}

template <int Rank>
struct BestKnot {
  const ArcTable& table;
  const Query& q;
  float (&most)[block_lanes];
  HWY_INLINE void operator()(std::int32_t bundle) {
    HWY_ALIGN float score[block_lanes];
    const Vector best = hn::Load(Floats(), most);
    hn::Store(score_knots<Rank>(table.arcs(), bundle, q, best, score), Floats(), most);
  }
};

/// Raises the threshold with the knots of candidate bundles.
template <int Rank>
HWY_INLINE void refine_walk(const ArcTable& table, const Query& q, float slack, Walk& walk) {
  if (is_flat(table)) return;
  HWY_ALIGN float most[block_lanes];
  hn::Store(all(no_score), Floats(), most);
  BestKnot<Rank> best{table, q, most};
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
    score_knots<Rank>(table.arcs(), bundle, q, all(no_score), score);
    std::uint32_t bits = near_in_block<Rank>(table.arcs().block(bundle), score, q, threshold);
    for (; bits != 0; bits &= bits - 1)
      visit_arc(table, bundle * arcs_per_block + std::countr_zero(bits), visit);
  }
};

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

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#endif

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/block_search.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "decode/block_search.cpp"
#include <hwy/foreach_target.h>
// Highway asks for its own header after foreach_target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr float below_all_scores = -4.0f;  // of unit vectors

// Two vectors of pixels share every load of a direction and must fit a tile.
using Floats = hn::CappedTag<float, pixels_per_tile / 2>;
using Vector = hn::Vec<Floats>;
using Indices = hn::RebindToSigned<Floats>;

/// Best scores so far of one vector of pixels.
struct Leader {
  Vector best, second;
  hn::Vec<Indices> block;

  // Not member initializers: g++ compiles implicit constructors without the target's instructions.
  HWY_INLINE void start() {
    best = second = hn::Set(Floats(), below_all_scores);
    block = hn::Zero(Indices());
  }
  HWY_INLINE void meet(Vector score, std::int32_t b) {
    const auto leads = hn::Gt(score, best);
    block = hn::IfThenElse(hn::RebindMask(Indices(), leads), hn::Set(Indices(), b), block);
    second = hn::Max(second, hn::Min(best, score));
    best = hn::Max(best, score);
  }
  HWY_INLINE void store(int pixel, BestBlocks& result) const {
    hn::StoreU(block, Indices(), result.block + pixel);
    hn::StoreU(hn::Sub(best, second), Floats(), result.lead + pixel);
  }
};

/// Searches a tile. `Rank` 0 stands for any rank, known only when running.
template <int Rank>
HWY_INLINE void search_tile(const float* blocks, int count, int rank_if_any,
                            const float* components, BestBlocks& result) {
  const Floats d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const int rank = Rank > 0 ? Rank : rank_if_any;
  for (int pixel = 0; pixel < pixels_per_tile; pixel += 2 * lanes) {
    const float* left = components + pixel;
    const float* right = left + lanes;
    Leader left_leader, right_leader;
    left_leader.start();
    right_leader.start();
    const float* block = blocks;
    for (int b = 0; b < count; ++b, block += rank * rows_per_block) {
      Vector left_best = hn::Set(d, below_all_scores), right_best = left_best;
      for (int row = 0; row < rows_per_block; ++row) {
        Vector direction = hn::Set(d, block[row]);
        Vector left_score = hn::Mul(hn::LoadU(d, left), direction);
        Vector right_score = hn::Mul(hn::LoadU(d, right), direction);
        for (int j = 1; j < rank; ++j) {
          direction = hn::Set(d, block[j * rows_per_block + row]);
          left_score = hn::MulAdd(hn::LoadU(d, left + j * pixels_per_tile), direction, left_score);
          right_score =
              hn::MulAdd(hn::LoadU(d, right + j * pixels_per_tile), direction, right_score);
        }
        left_best = hn::Max(left_best, left_score);
        right_best = hn::Max(right_best, right_score);
      }
      left_leader.meet(left_best, b);
      right_leader.meet(right_best, b);
    }
    left_leader.store(pixel, result);
    right_leader.store(pixel + lanes, result);
  }
}

void search(const float* blocks, int count, int rank, const float* components, BestBlocks& result) {
  switch (rank) {
    case 2:
      return search_tile<2>(blocks, count, rank, components, result);
    case 3:
      return search_tile<3>(blocks, count, rank, components, result);
    case 4:
      return search_tile<4>(blocks, count, rank, components, result);
    case 5:
      return search_tile<5>(blocks, count, rank, components, result);
    default:
      return search_tile<0>(blocks, count, rank, components, result);
  }
}

/// Position in [begin, end) with the best score, the lowest of those that tie.
std::int32_t search_positions(const float* first_component, std::ptrdiff_t stride, int rank,
                              const float* components, std::int32_t begin, std::int32_t end) {
  const Floats d;
  const Indices di;
  const auto lanes = static_cast<std::int32_t>(hn::Lanes(d));
  const Vector lowest = hn::Set(d, below_all_scores);
  Vector best = lowest;
  auto best_position = hn::Set(di, begin);
  for (std::int32_t n = begin; n < end; n += lanes) {
    Vector score = hn::Mul(hn::Set(d, components[0]), hn::LoadU(d, first_component + n));
    for (int j = 1; j < rank; ++j)
      score = hn::Add(score, hn::Mul(hn::Set(d, components[j]),
                                     hn::LoadU(d, first_component + j * stride + n)));
    if (end - n < lanes)
      score = hn::IfThenElse(hn::FirstN(d, static_cast<std::size_t>(end - n)), score, lowest);
    const auto leads = hn::Gt(score, best);
    best_position = hn::IfThenElse(hn::RebindMask(di, leads), hn::Iota(di, n), best_position);
    best = hn::Max(best, score);
  }
  const auto of_best = hn::RebindMask(di, hn::Eq(best, hn::MaxOfLanes(d, best)));
  return hn::GetLane(hn::MinOfLanes(di, hn::IfThenElse(of_best, best_position, hn::Set(di, end))));
}

}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tofsmith {

HWY_EXPORT(search);
HWY_EXPORT(search_positions);

void search_blocks(const DirectionTable& table, const float* components, BestBlocks& best) {
  HWY_DYNAMIC_DISPATCH(search)
  (table.float_blocks(), table.blocks(), table.rank(), components, best);
}

std::int32_t best_bin_within(const DirectionTable& table, const float* components,
                             std::int32_t begin, std::int32_t end) {
  return HWY_DYNAMIC_DISPATCH(search_positions)(table.float_component(0), table.component_stride(),
                                                table.rank(), components, begin, end) %
         table.samples();
}

}  // namespace tofsmith
#endif

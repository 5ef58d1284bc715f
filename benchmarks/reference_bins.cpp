// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "reference_bins.hpp"

#include <algorithm>

#include "tofsmith/core/error.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reference_bins.cpp"
#include <hwy/foreach_target.h>
// Highway requires its header after foreach_target.
#include <hwy/highway.h>

#ifndef TOFSMITH_BENCHMARKS_RUNS
#define TOFSMITH_BENCHMARKS_RUNS
namespace tofsmith::benchmarks {
inline constexpr int group_blocks = 16;  // blocks of rows with a common best score
inline constexpr int max_groups = 128;   // so N <= 16384
inline constexpr int pixels_at_once = 4;
}  // namespace tofsmith::benchmarks
#endif

HWY_BEFORE_NAMESPACE();
namespace tofsmith::benchmarks {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Doubles = hn::CappedTag<double, reference_block>;
using Vector = hn::Vec<Doubles>;

HWY_INLINE int lanes() { return static_cast<int>(hn::Lanes(Doubles())); }

/// Scores of the rows of a block from row i on.
template <int Rank>
HWY_INLINE Vector scores(const double* unit, const double* block, int i) {
  const Doubles d;
  Vector sum = hn::Mul(hn::Set(d, unit[0]), hn::LoadU(d, block + i));
  for (int j = 1; j < Rank; ++j)
    sum = hn::MulAdd(hn::Set(d, unit[j]), hn::LoadU(d, block + j * reference_block + i), sum);
  return sum;
}

HWY_INLINE double largest(Vector v) { return hn::GetLane(hn::MaxOfLanes(Doubles(), v)); }

/// First row of a block with a score of at least `least`, or -1.
template <int Rank>
HWY_INLINE int first_row(const double* unit, const double* block, double least) {
  const Doubles d;
  for (int i = 0; i < reference_block; i += lanes()) {
    const auto found =
        hn::FindFirstTrue(d, hn::Ge(scores<Rank>(unit, block, i), hn::Set(d, least)));
    if (found >= 0) return i + static_cast<int>(found);
  }
  return -1;
}

template <int Rank>
void brute_force(const double* rows, int blocks, const ReferencePixel* pixels, int count,
                 std::int32_t* bin) {
  const Doubles d;
  constexpr int stride = Rank * reference_block;
  HWY_ALIGN double of_group[pixels_at_once][max_groups][reference_block];
  const int groups = (blocks + group_blocks - 1) / group_blocks;
  double best[pixels_at_once];
  for (double& value : best) value = -2.0;
  for (int group = 0; group < groups; ++group) {
    const int end = std::min((group + 1) * group_blocks, blocks);
    Vector most[pixels_at_once] = {hn::Set(d, -2.0), hn::Set(d, -2.0), hn::Set(d, -2.0),
                                   hn::Set(d, -2.0)};
    for (int block = group * group_blocks; block < end; ++block)
      for (int i = 0; i < reference_block; i += lanes())
        for (int p = 0; p < pixels_at_once; ++p)
          most[p] = hn::Max(most[p], scores<Rank>(pixels[std::min(p, count - 1)].unit.data(),
                                                  rows + block * stride, i));
    for (int p = 0; p < pixels_at_once; ++p) hn::Store(most[p], d, of_group[p][group]);
  }
  for (int p = 0; p < count; ++p) {
    Vector most = hn::Set(d, -2.0);
    for (int group = 0; group < groups; ++group)
      most = hn::Max(most, hn::Load(d, of_group[p][group]));
    const double least = largest(most) - pixels[p].tie;
    int group = 0;
    while (largest(hn::Load(d, of_group[p][group])) < least) ++group;
    int row = -1;
    for (int block = group * group_blocks; row < 0; ++block) {
      row = first_row<Rank>(pixels[p].unit.data(), rows + block * stride, least);
      bin[p] = block * reference_block + row;
    }
  }
}

void brute_force_of_rank(int rank, const double* rows, int blocks, const ReferencePixel* pixels,
                         int count, std::int32_t* bin) {
  switch (rank) {
    case 2:
      return brute_force<2>(rows, blocks, pixels, count, bin);
    case 3:
      return brute_force<3>(rows, blocks, pixels, count, bin);
    case 4:
      return brute_force<4>(rows, blocks, pixels, count, bin);
    case 5:
      return brute_force<5>(rows, blocks, pixels, count, bin);
    case 6:
      return brute_force<6>(rows, blocks, pixels, count, bin);
    case 7:
      return brute_force<7>(rows, blocks, pixels, count, bin);
    default:
      return brute_force<8>(rows, blocks, pixels, count, bin);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tofsmith::benchmarks
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tofsmith::benchmarks {

HWY_EXPORT(brute_force_of_rank);

void bins_by_brute_force(const ReferenceCurve& curve, const ReferencePixel* pixels, int count,
                         std::int32_t* bin) {
  require(curve.blocks() <= group_blocks * max_groups, "samples", curve.samples(),
          "must be at most 16384");
  for (int first = 0; first < count; first += pixels_at_once)
    HWY_DYNAMIC_DISPATCH(brute_force_of_rank)
  (curve.rank(), curve.rows(), curve.blocks(), pixels + first,
   std::min(count - first, pixels_at_once), bin + first);
}

}  // namespace tofsmith::benchmarks
#endif

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Loads rows of four numbers.
#if defined(TOFSMITH_DECODE_ROWS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef TOFSMITH_DECODE_ROWS_INL_HPP
#undef TOFSMITH_DECODE_ROWS_INL_HPP
#else
#define TOFSMITH_DECODE_ROWS_INL_HPP
#endif

#include <hwy/highway.h>

#include "core/shared/vectors-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {

inline constexpr int row_length = 4;

#if HWY_HAVE_SCALABLE || HWY_TARGET == HWY_SCALAR

/// Loads number j of the row of every lane to columns[j].
template <typename RowOf>
HWY_INLINE void load_rows(const RowOf& row_of, Vector* columns) {
  HWY_ALIGN float column[row_length][widest_vector];
  for (int lane = 0; lane < lanes_of(); ++lane)
    for (int j = 0; j < row_length; ++j) column[j][lane] = row_of(lane)[j];
  for (int j = 0; j < row_length; ++j) columns[j] = hn::Load(Floats(), column[j]);
}

#else

/// Loads the rows of the lanes first, first + 4, ... consecutively.
template <int Lanes, typename RowOf>
HWY_INLINE hn::Vec<hn::CappedTag<float, Lanes> > every_fourth_row(const RowOf& row_of, int first) {
  const hn::CappedTag<float, Lanes> d;
  if constexpr (Lanes == row_length)
    return hn::LoadU(d, row_of(first));
  else
    return hn::Combine(d, every_fourth_row<Lanes / 2>(row_of, first + Lanes / 2),
                       every_fourth_row<Lanes / 2>(row_of, first));
}

/// As above. Loading and transposing whole rows is much faster than gathers.
template <typename RowOf>
HWY_INLINE void load_rows(const RowOf& row_of, Vector* columns) {
  const Floats d;
  const hn::Repartition<double, Floats> pairs;
  constexpr int lanes = static_cast<int>(hn::MaxLanes(d));
  Vector row[row_length];
  for (int i = 0; i < row_length; ++i) row[i] = every_fourth_row<lanes>(row_of, i);
  const auto low01 = hn::BitCast(pairs, hn::InterleaveLower(d, row[0], row[1]));
  const auto low23 = hn::BitCast(pairs, hn::InterleaveLower(d, row[2], row[3]));
  const auto high01 = hn::BitCast(pairs, hn::InterleaveUpper(d, row[0], row[1]));
  const auto high23 = hn::BitCast(pairs, hn::InterleaveUpper(d, row[2], row[3]));
  columns[0] = hn::BitCast(d, hn::InterleaveLower(pairs, low01, low23));
  columns[1] = hn::BitCast(d, hn::InterleaveUpper(pairs, low01, low23));
  columns[2] = hn::BitCast(d, hn::InterleaveLower(pairs, high01, high23));
  columns[3] = hn::BitCast(d, hn::InterleaveUpper(pairs, high01, high23));
}

#endif

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#endif

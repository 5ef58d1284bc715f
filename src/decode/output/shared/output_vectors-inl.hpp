// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Vectors of pixels, and conversion of their records to vectors.
#if defined(TOFSMITH_DECODE_OUTPUT_VECTORS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef TOFSMITH_DECODE_OUTPUT_VECTORS_INL_HPP
#undef TOFSMITH_DECODE_OUTPUT_VECTORS_INL_HPP
#else
#define TOFSMITH_DECODE_OUTPUT_VECTORS_INL_HPP
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "core/shared/vector_math-inl.hpp"
#include "decode/output/output_chunk.hpp"
#include "decode/search/shared/pixel_tile.hpp"

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {
using Bytes = hn::Rebind<std::uint8_t, Indices>;

/// a b + c with two roundings, with and without FMA instructions.
HWY_INLINE Vector product_plus(Vector a, Vector b, Vector c) { return hn::Add(hn::Mul(a, b), c); }
HWY_INLINE Vector load(const float* row, int i) { return hn::LoadU(Floats(), row + i); }
HWY_INLINE Vector unless(Mask is_so, Vector value) {
  return hn::IfThenElse(is_so, value, all(std::numeric_limits<float>::quiet_NaN()));
}

/// Stores the first `room` values.
template <typename Tag, typename Values, typename T>
HWY_INLINE void store_some(Tag tag, Values values, T* to, int room) {
  if (room >= lanes_of(tag)) return hn::StoreU(values, tag, to);
  alignas(64) T buffer[pixels_per_chunk];
  hn::StoreU(values, tag, buffer);
  std::memcpy(to, buffer, static_cast<std::size_t>(room) * sizeof(T));
}

#if HWY_TARGET == HWY_SCALAR || HWY_HAVE_SCALABLE
/// Transposes the fields [begin, end) of the records at `start` to rows of fields. `begin` must be
/// a multiple of four; up to three more fields are written.
HWY_INLINE void gather(const float* table, const std::uint32_t* start, int begin, int end,
                       float* rows) {
  for (int i = 0; i < lanes_of(); ++i)
    for (int f = begin; f < end; ++f) rows[f * pixels_per_chunk + i] = table[start[i] + f];
}
#else
/// Returns four fields of every fourth record.
template <typename Tag>
HWY_INLINE hn::Vec<Tag> load_blocks(Tag d, const float* table, const std::uint32_t* start) {
  constexpr int lanes = static_cast<int>(hn::MaxLanes(Tag()));
  if constexpr (lanes == 4) {
    return hn::Load(d, table + start[0]);
  } else if constexpr (lanes == 8) {
    const hn::Half<Tag> half;
    return hn::Combine(d, hn::Load(half, table + start[4]), hn::Load(half, table + start[0]));
  } else {
    // Masked loads of single blocks avoid shuffles.
    hn::Vec<Tag> blocks = hn::LoadDup128(d, table + start[0]);
    for (int b = 4; b < lanes; b += 4)
      blocks = hn::IfThenElse(hn::FirstN(d, static_cast<std::size_t>(b)), blocks,
                              hn::LoadDup128(d, table + start[b]));
    return blocks;
  }
}

/// As above. Pixel 4 b + v is loaded to block b of vector v, so that the transposition does not
/// cross blocks.
HWY_INLINE void gather(const float* table, const std::uint32_t* start, int begin, int end,
                       float* rows) {
  const Floats d;
  const hn::Repartition<std::uint64_t, Floats> pairs;
  for (int f = begin; f < end; f += 4) {
    const Vector v0 = load_blocks(d, table + f, start), v1 = load_blocks(d, table + f, start + 1);
    const Vector v2 = load_blocks(d, table + f, start + 2);
    const Vector v3 = load_blocks(d, table + f, start + 3);
    const auto low01 = hn::BitCast(pairs, hn::InterleaveLower(d, v0, v1));
    const auto low23 = hn::BitCast(pairs, hn::InterleaveLower(d, v2, v3));
    const auto high01 = hn::BitCast(pairs, hn::InterleaveUpper(d, v0, v1));
    const auto high23 = hn::BitCast(pairs, hn::InterleaveUpper(d, v2, v3));
    float* row = rows + f * pixels_per_chunk;
    hn::StoreU(hn::BitCast(d, hn::InterleaveLower(pairs, low01, low23)), d, row);
    hn::StoreU(hn::BitCast(d, hn::InterleaveUpper(pairs, low01, low23)), d, row + pixels_per_chunk);
    row += 2 * pixels_per_chunk;
    hn::StoreU(hn::BitCast(d, hn::InterleaveLower(pairs, high01, high23)), d, row);
    hn::StoreU(hn::BitCast(d, hn::InterleaveUpper(pairs, high01, high23)), d,
               row + pixels_per_chunk);
  }
}
#endif

/// Unused entries of a chunk refer to row -1.
HWY_INLINE void find_rows(const RecordTable& table, const std::int32_t* numbers, int pixels,
                          std::uint32_t* start) {
  const auto stride = static_cast<std::uint32_t>(table.stride());
  for (int i = 0; i < pixels; ++i) start[i] = static_cast<std::uint32_t>(numbers[i] + 1) * stride;
  std::fill(start + pixels, start + pixels_per_chunk, 0u);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#endif

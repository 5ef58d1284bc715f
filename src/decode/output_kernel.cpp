// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/output_kernel.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "decode/output_kernel.cpp"
#include <hwy/foreach_target.h>
// Highway asks for its own header after foreach_target.
#include <hwy/highway.h>

#ifndef TOFSMITH_OUTPUT_CHUNK
#define TOFSMITH_OUTPUT_CHUNK
namespace tofsmith {

/// Pixels whose records lie side by side in the work space.
inline constexpr int pixels_per_chunk = 64;
/// Keeps a noiseless table from dividing by zero [e^2].
inline constexpr float least_variance_e2 = 1e-12f;
/// Of so many deviations, squared, the normal probability is 1 in single precision.
inline constexpr float sure_sigma2 = 36.0f;

/// Which steps the wanted planes need.
struct OutputSteps {
  bool ambient = false;
  bool noise = false;
  bool confidence = false;
  int fields = 0;  // of the records
};

/// Work space of a chunk, all that is known of its pixels in rows of pixels_per_chunk.
struct OutputChunk {
  int pixels = 0;
  const float* plane = nullptr;      // as in the tile
  const float* electrons = nullptr;  // as in the tile
  alignas(64) std::int32_t bin[pixels_per_chunk];
  alignas(64) std::int32_t rival[pixels_per_chunk];
  alignas(64) std::uint32_t start[pixels_per_chunk];        // of the bins' records
  alignas(64) std::uint32_t rival_start[pixels_per_chunk];  // of the rivals' directions
  alignas(64) float signal[pixels_per_chunk];               // > 0 where there is a depth
  alignas(64) float offset[pixels_per_chunk];  // of depth from the bin, in bins: in [-1, 1]
  alignas(64) float ambient[pixels_per_chunk];
  alignas(64) float signal_variance[pixels_per_chunk];
  alignas(64) float confidence[pixels_per_chunk];
  alignas(64) float chord[ChordLayout::fields * pixels_per_chunk];
  alignas(64) float rival_direction[max_measurements * pixels_per_chunk];
  alignas(64) float record[max_record_fields * pixels_per_chunk];

  const float* field(int f) const { return record + f * pixels_per_chunk; }
  const float* chord_field(int f) const { return chord + f * pixels_per_chunk; }
};

}  // namespace tofsmith
#endif

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Constants = OutputKernel::Constants;
using Floats = hn::CappedTag<float, pixels_per_chunk>;
using Vector = hn::Vec<Floats>;
using Mask = hn::Mask<Floats>;
using Indices = hn::RebindToSigned<Floats>;
using Bytes = hn::Rebind<std::uint8_t, Indices>;

/// a b + c, rounded twice: the same with and without fused instructions.
HWY_INLINE Vector product_plus(Vector a, Vector b, Vector c) { return hn::Add(hn::Mul(a, b), c); }
HWY_INLINE Vector load(const float* row, int i) { return hn::LoadU(Floats(), row + i); }
HWY_INLINE Vector all(float value) { return hn::Set(Floats(), value); }
HWY_INLINE Vector unless(Mask is_so, Vector value) {
  return hn::IfThenElse(is_so, value, all(std::numeric_limits<float>::quiet_NaN()));
}

/// Stores the first `room` values of a vector, at most all.
template <typename Tag, typename Values, typename T>
HWY_INLINE void store_some(Tag tag, Values values, T* to, int room) {
  if (room >= static_cast<int>(hn::Lanes(tag))) return hn::StoreU(values, tag, to);
  alignas(64) T buffer[pixels_per_chunk];
  hn::StoreU(values, tag, buffer);
  std::memcpy(to, buffer, static_cast<std::size_t>(room) * sizeof(T));
}

#if HWY_TARGET == HWY_SCALAR || HWY_HAVE_SCALABLE
/// Fields [begin, end) of a vector of pixels from their records at `start`, as rows of fields.
/// `begin` is a multiple of four; up to three more fields are written.
HWY_INLINE void gather(const float* table, const std::uint32_t* start, int begin, int end,
                       float* rows) {
  for (int i = 0; i < static_cast<int>(hn::Lanes(Floats())); ++i)
    for (int f = begin; f < end; ++f) rows[f * pixels_per_chunk + i] = table[start[i] + f];
}
#else
/// Four fields of every fourth record, side by side.
template <typename Tag>
HWY_INLINE hn::Vec<Tag> load_blocks(Tag d, const float* table, const std::uint32_t* start) {
  constexpr int lanes = static_cast<int>(hn::MaxLanes(Tag()));
  if constexpr (lanes == 4) {
    return hn::Load(d, table + start[0]);
  } else if constexpr (lanes == 8) {
    const hn::Half<Tag> half;
    return hn::Combine(d, hn::Load(half, table + start[4]), hn::Load(half, table + start[0]));
  } else {
    // Masked loads of one block need no shuffle.
    hn::Vec<Tag> blocks = hn::LoadDup128(d, table + start[0]);
    for (int b = 4; b < lanes; b += 4)
      blocks = hn::IfThenElse(hn::FirstN(d, static_cast<std::size_t>(b)), blocks,
                              hn::LoadDup128(d, table + start[b]));
    return blocks;
  }
}

/// Fields [begin, end) of a vector of pixels from their records at `start`, as rows of fields.
/// `begin` is a multiple of four; up to three more fields are written. Pixel 4 b + v goes to block
/// b of part v, from where it need not leave block b.
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

/// Where the rows of a table with these numbers start; a chunk's further rows are row -1.
HWY_INLINE void find_rows(const RecordTable& table, const std::int32_t* numbers, int pixels,
                          std::uint32_t* start) {
  const auto stride = static_cast<std::uint32_t>(table.stride());
  for (int i = 0; i < pixels; ++i) start[i] = static_cast<std::uint32_t>(numbers[i] + 1) * stride;
  std::fill(start + pixels, start + pixels_per_chunk, 0u);
}

/// <q, vector> with a vector of the record.
HWY_INLINE Vector along(const OutputChunk& chunk, int rank, int field, int i) {
  Vector sum = hn::Mul(load(chunk.plane, i), load(chunk.field(field), i));
  for (int j = 1; j < rank; ++j)
    sum = product_plus(load(chunk.plane + j * pixels_per_tile, i), load(chunk.field(field + j), i),
                       sum);
  return sum;
}

/// Best point on the chords left and right. With x = <q, p> / |p|^2 and v = <q, w>, rising to the
/// side where it is > 0: S = x - v beta / c, t = v / (c S). Of two rising sides the steeper is
/// best.
HWY_INLINE void refine(const RecordLayout& layout, int rank, OutputChunk& chunk) {
  const Floats d;
  const Vector zero = hn::Zero(d);
  for (int i = 0; i < chunk.pixels; i += static_cast<int>(hn::Lanes(d))) {
    const Vector at_bin = along(chunk, rank, layout.point(), i);
    const Vector to_left = along(chunk, rank, layout.left(), i);
    const Vector to_right = along(chunk, rank, layout.right(), i);
    const Mask is_left = hn::Ge(to_left, to_right);
    const Vector rise = hn::Max(hn::Max(to_left, to_right), zero);
    const Vector turn = hn::IfThenElse(is_left, load(chunk.field(layout.turn()), i),
                                       load(chunk.field(layout.turn() + 1), i));
    const Vector reach = hn::IfThenElse(is_left, load(chunk.field(layout.reach()), i),
                                        load(chunk.field(layout.reach() + 1), i));
    const Vector inside = hn::Sub(at_bin, hn::Mul(rise, turn));
    const Mask has_depth = hn::And(hn::Gt(at_bin, zero), hn::Gt(inside, zero));
    const Vector t = hn::Min(hn::Div(hn::Mul(rise, reach), inside), all(1.0f));
    hn::StoreU(hn::IfThenElseZero(has_depth, inside), d, chunk.signal + i);
    hn::StoreU(hn::IfThenElseZero(has_depth, hn::IfThenElse(is_left, hn::Neg(t), t)), d,
               chunk.offset + i);
  }
}

/// The quarters of chords where the best points lie.
HWY_INLINE void find_chords(const RecordTable& chords, OutputChunk& chunk) {
  const Floats d;
  const Indices di;
  const hn::RebindToUnsigned<Floats> du;
  const auto last = hn::Set(di, ChordLayout::quarters - 1), one = hn::Set(di, 1);
  const auto at_bin = hn::Set(di, ChordLayout::at_bin), blocks = hn::Set(di, ChordLayout::blocks);
  alignas(64) std::uint32_t start[pixels_per_chunk];
  for (int i = 0; i < chunk.pixels; i += static_cast<int>(hn::Lanes(d))) {
    const Vector offset = load(chunk.offset, i);
    const auto is_left = hn::RebindMask(di, hn::Lt(offset, hn::Zero(d)));
    const auto is_at_bin = hn::RebindMask(di, hn::Eq(offset, hn::Zero(d)));
    const auto quarter =
        hn::ConvertTo(di, hn::Mul(hn::Abs(offset), all(static_cast<float>(ChordLayout::quarters))));
    const auto steps = hn::IfThenZeroElse(is_at_bin, hn::Add(hn::Min(quarter, last), one));
    const auto block = hn::IfThenElse(is_left, hn::Sub(at_bin, steps), hn::Add(at_bin, steps));
    const auto bin = hn::Add(hn::LoadU(di, chunk.bin + i), one);
    const auto row = hn::Add(hn::Mul(bin, blocks), block);
    hn::StoreU(hn::BitCast(du, hn::ShiftLeft<2>(row)), du, start + i);
    gather(chords.data(), start + i, 0, ChordLayout::fields, chunk.chord + i);
  }
}

HWY_INLINE void write_depth(const Constants& c, const OutputChunk& chunk, float* depth_m) {
  const Floats d;
  const Vector zero = hn::Zero(d);
  for (int i = 0; i < chunk.pixels; i += static_cast<int>(hn::Lanes(d))) {
    const Vector offset = load(chunk.offset, i);
    Vector bin = hn::ConvertTo(d, hn::LoadU(Indices(), chunk.bin + i));
    const Mask is_below = hn::And(hn::Eq(bin, zero), hn::Lt(offset, zero));
    bin = hn::IfThenElse(is_below, all(static_cast<float>(c.samples)), bin);
    const Vector rest = product_plus(offset, all(c.bin_m), hn::Mul(bin, all(c.bin_low_m)));
    Vector depth = product_plus(bin, all(c.bin_high_m), rest);
    depth = hn::IfThenZeroElse(hn::Ge(depth, all(c.range_m)), depth);
    store_some(d, unless(hn::Gt(load(chunk.signal, i), zero), depth), depth_m + i,
               chunk.pixels - i);
  }
}

HWY_INLINE void write_bins(const Constants& c, const OutputChunk& chunk, std::int32_t* bins) {
  const Floats d;
  const Indices di;
  const auto one = hn::Set(di, 1), end = hn::Set(di, c.samples);
  for (int i = 0; i < chunk.pixels; i += static_cast<int>(hn::Lanes(d))) {
    const Vector offset = load(chunk.offset, i);
    const auto bin = hn::LoadU(di, chunk.bin + i);
    const auto is_up = hn::RebindMask(di, hn::Ge(offset, all(0.5f)));
    const auto is_down = hn::RebindMask(di, hn::Lt(offset, all(-0.5f)));
    auto nearest = hn::Add(bin, hn::IfThenElseZero(is_up, one));
    nearest = hn::Sub(nearest, hn::IfThenElseZero(is_down, one));
    nearest = hn::IfThenZeroElse(hn::Eq(nearest, end), nearest);
    nearest = hn::IfThenElse(hn::Lt(nearest, hn::Zero(di)), hn::Sub(end, one), nearest);
    nearest = hn::IfThenElse(hn::Lt(bin, hn::Zero(di)), bin, nearest);
    store_some(di, nearest, bins + i, chunk.pixels - i);
  }
}

/// Copies values, NaN where there is no depth.
HWY_INLINE void write_values(const OutputChunk& chunk, const float* values, float* plane) {
  const Floats d;
  for (int i = 0; i < chunk.pixels; i += static_cast<int>(hn::Lanes(d))) {
    const Mask has_depth = hn::Gt(load(chunk.signal, i), hn::Zero(d));
    store_some(d, unless(has_depth, load(values, i)), plane + i, chunk.pixels - i);
  }
}

/// What signal leaves is ambient light; 0 where differences hide it.
HWY_INLINE void find_ambient(const Constants& c, const RecordLayout& layout, OutputChunk& chunk) {
  const Floats d;
  if (!c.sees_ambient) return static_cast<void>(std::fill_n(chunk.ambient, pixels_per_chunk, 0.0f));
  const int count = layout.measurements;
  for (int i = 0; i < chunk.pixels; i += static_cast<int>(hn::Lanes(d))) {
    Vector sum = hn::Mul(load(chunk.electrons, i), all(c.ambient_weight[0]));
    for (int k = 1; k < count; ++k)
      sum = product_plus(load(chunk.electrons + k * pixels_per_tile, i),
                         all(c.ambient_weight[static_cast<std::size_t>(k)]), sum);
    const Vector of_signal = product_plus(hn::Abs(load(chunk.offset, i)),
                                          load(chunk.chord_field(ChordLayout::ambient), i),
                                          load(chunk.field(layout.ambient()), i));
    hn::StoreU(hn::Sub(sum, hn::Mul(load(chunk.signal, i), of_signal)), d, chunk.ambient + i);
  }
}

HWY_INLINE void write_ambient(const Constants& c, const OutputChunk& chunk, float* plane) {
  if (c.sees_ambient) return write_values(chunk, chunk.ambient, plane);
  std::fill_n(plane, chunk.pixels, std::numeric_limits<float>::quiet_NaN());
}

/// Ambient light that makes noise.
HWY_INLINE Vector noisy_ambient(const OutputChunk& chunk, int i) {
  return hn::Max(load(chunk.ambient, i), hn::Zero(Floats()));
}

/// Per signal, per ambient light, and without light.
HWY_INLINE Vector variance_of(Vector signal, Vector ambient, Vector per_signal, Vector per_ambient,
                              Vector without) {
  const Vector sum = product_plus(signal, per_signal, product_plus(ambient, per_ambient, without));
  return hn::Max(sum, hn::Zero(Floats()));
}

HWY_INLINE void find_signal_noise(const RecordLayout& layout, OutputChunk& chunk) {
  const Floats d;
  const float* noise = chunk.field(layout.signal_noise());
  for (int i = 0; i < chunk.pixels; i += static_cast<int>(hn::Lanes(d)))
    hn::StoreU(
        variance_of(load(chunk.signal, i), noisy_ambient(chunk, i), load(noise, i),
                    load(noise + pixels_per_chunk, i), load(noise + 2 * pixels_per_chunk, i)),
        d, chunk.signal_variance + i);
}

HWY_INLINE void write_depth_noise(const OutputChunk& chunk, float* standard_deviation_m) {
  const Floats d;
  const float* noise = chunk.chord_field(ChordLayout::depth_noise);
  for (int i = 0; i < chunk.pixels; i += static_cast<int>(hn::Lanes(d))) {
    const Vector signal = load(chunk.signal, i);
    const Vector variance =
        variance_of(signal, noisy_ambient(chunk, i), load(noise, i),
                    load(noise + pixels_per_chunk, i), load(noise + 2 * pixels_per_chunk, i));
    const Vector deviation = hn::Div(hn::Sqrt(variance), signal);
    store_some(d, unless(hn::Gt(signal, hn::Zero(d)), deviation), standard_deviation_m + i,
               chunk.pixels - i);
  }
}

/// The normal distribution at z >= 0. Abramowitz and Stegun 26.2.19; errs by less than 2e-7.
HWY_INLINE Vector normal_probability(Vector z) {
  Vector power = product_plus(z, all(0.0000053830f), all(0.0000488906f));
  power = product_plus(z, power, all(0.0000380036f));
  power = product_plus(z, power, all(0.0032776263f));
  power = product_plus(z, power, all(0.0211410061f));
  power = product_plus(z, power, all(0.0498673470f));
  power = product_plus(z, power, all(1.0f));
  for (int twice = 0; twice < 4; ++twice) power = hn::Mul(power, power);
  return hn::Sub(all(1.0f), hn::Div(all(0.5f), power));
}

/// Difference d of the directions of bins and rivals, instead of the rivals'. Returns <d, q>, and
/// in `square` |d|^2.
HWY_INLINE Vector lead_of(const RecordLayout& layout, int rank, OutputChunk& chunk, int i,
                          Vector& square) {
  const Floats d;
  Vector lead = square = hn::Zero(d);
  for (int j = 0; j < rank; ++j) {
    float* const rival = chunk.rival_direction + j * pixels_per_chunk + i;
    const Vector apart = hn::Sub(load(chunk.field(layout.direction() + j), i), load(rival, 0));
    hn::StoreU(apart, d, rival);
    lead = product_plus(apart, load(chunk.plane + j * pixels_per_tile, i), lead);
    square = product_plus(apart, apart, square);
  }
  return lead;
}

/// Noise of the lead: sum_k (V d)_k^2 v_k.
HWY_INLINE Vector lead_variance(const Constants& c, const RecordLayout& layout, int rank,
                                const OutputChunk& chunk, int i) {
  const Vector signal = load(chunk.signal, i), ambient = noisy_ambient(chunk, i);
  Vector variance = hn::Zero(Floats());
  for (int k = 0; k < layout.measurements; ++k) {
    const float* const basis = c.basis.data() + k * rank;
    Vector weight = hn::Zero(Floats());
    for (int j = 0; j < rank; ++j)
      weight = product_plus(load(chunk.rival_direction + j * pixels_per_chunk, i), all(basis[j]),
                            weight);
    const Vector without_signal =
        product_plus(ambient, all(c.shot_ambient.data()[k]), all(c.floor_noise_e2.data()[k]));
    const Vector noise =
        product_plus(signal, load(chunk.field(layout.shot() + k), i), without_signal);
    variance =
        product_plus(hn::Mul(weight, weight), hn::Max(noise, all(least_variance_e2)), variance);
  }
  return variance;
}

/// Probability that the bin scores higher than its rival, for noise on the lead. Most leads are so
/// many deviations of the most noise there can be that their probability is 1 as a float: the noise
/// of others alone is computed.
HWY_INLINE void find_confidence(const Constants& c, const BinRecords& records, int rank,
                                OutputChunk& chunk) {
  const Floats d;
  const RecordLayout& layout = records.layout;
  const Vector zero = hn::Zero(d), one = all(1.0f);
  for (int i = 0; i < chunk.pixels; i += static_cast<int>(hn::Lanes(d))) {
    gather(records.directions.data(), chunk.rival_start + i, 0, rank, chunk.rival_direction + i);
    Vector square;
    const Vector lead = hn::Max(lead_of(layout, rank, chunk, i, square), zero);
    const Vector most_noise = product_plus(
        load(chunk.signal, i), all(c.most_shot),
        product_plus(noisy_ambient(chunk, i), all(c.most_shot_ambient), all(c.most_floor_e2)));
    const Mask is_sure =
        hn::Ge(hn::Mul(lead, lead), hn::Mul(hn::Mul(square, all(sure_sigma2)), most_noise));
    const auto has_rival = hn::Gt(hn::LoadU(Indices(), chunk.rival + i), hn::Set(Indices(), -1));
    const Mask is_open = hn::And(hn::And(hn::RebindMask(d, has_rival), hn::Not(is_sure)),
                                 hn::Gt(load(chunk.signal, i), zero));
    Vector confidence = one;
    if (!hn::AllFalse(d, is_open)) {
      gather(records.records.data(), chunk.start + i, layout.shot(), layout.end(),
             chunk.record + i);
      const Vector deviation = hn::Sqrt(lead_variance(c, layout, rank, chunk, i));
      confidence =
          hn::IfThenElse(is_open, normal_probability(hn::Div(lead, deviation)), confidence);
    }
    hn::StoreU(confidence, d, chunk.confidence + i);
  }
}

HWY_INLINE hn::Vec<Indices> status(PixelStatus value) {
  return hn::Set(Indices(), static_cast<std::int32_t>(value));
}

/// The first status in the order of PixelStatus that applies.
HWY_INLINE void write_status(const Constants& c, const OutputChunk& chunk,
                             const std::uint8_t* saturated, PixelStatus* to) {
  const Floats d;
  const Indices di;
  for (int i = 0; i < chunk.pixels; i += static_cast<int>(hn::Lanes(d))) {
    const Vector signal = load(chunk.signal, i);
    const Vector least2 = hn::Mul(all(c.low_signal_sigma2), load(chunk.signal_variance, i));
    const auto is_ambiguous =
        hn::RebindMask(di, hn::Lt(load(chunk.confidence, i), all(c.minimum_confidence)));
    const auto is_low = hn::RebindMask(di, hn::Lt(hn::Mul(signal, signal), least2));
    const auto is_nothing = hn::RebindMask(di, hn::Not(hn::Gt(signal, hn::Zero(d))));
    const auto is_saturated =
        hn::Gt(hn::PromoteTo(di, hn::LoadU(Bytes(), saturated + i)), hn::Zero(di));
    const auto is_invalid = hn::Lt(hn::LoadU(di, chunk.bin + i), hn::Zero(di));
    auto value =
        hn::IfThenElse(is_ambiguous, status(PixelStatus::ambiguous), status(PixelStatus::ok));
    value = hn::IfThenElse(is_low, status(PixelStatus::low_signal), value);
    value = hn::IfThenElse(is_nothing, status(PixelStatus::no_return), value);
    value = hn::IfThenElse(is_saturated, status(PixelStatus::saturated), value);
    value = hn::IfThenElse(is_invalid, status(PixelStatus::invalid), value);
    store_some(Bytes(), hn::DemoteTo(Bytes(), value), reinterpret_cast<std::uint8_t*>(to + i),
               chunk.pixels - i);
  }
}

/// One chunk, step by step. `Rank` 0 stands for any rank, known only when running.
template <int Rank>
HWY_INLINE void write_chunk(const BinRecords& records, const Constants& c, const OutputSteps& steps,
                            const std::uint8_t* saturated, OutputChunk& chunk,
                            const DecodedView& planes) {
  const RecordLayout& layout = records.layout;
  const int rank = Rank > 0 ? Rank : layout.rank;
  find_rows(records.records, chunk.bin, chunk.pixels, chunk.start);
  for (int i = 0; i < chunk.pixels; i += static_cast<int>(hn::Lanes(Floats())))
    gather(records.records.data(), chunk.start + i, 0, steps.fields, chunk.record + i);
  refine(layout, rank, chunk);
  if (planes.depth_m) write_depth(c, chunk, planes.depth_m);
  if (planes.bin) write_bins(c, chunk, planes.bin);
  if (planes.signal_e_per_s) write_values(chunk, chunk.signal, planes.signal_e_per_s);
  if (steps.ambient) {
    find_chords(records.chords, chunk);
    find_ambient(c, layout, chunk);
  }
  if (planes.ambient_e_per_s) write_ambient(c, chunk, planes.ambient_e_per_s);
  if (planes.predicted_standard_deviation_m)
    write_depth_noise(chunk, planes.predicted_standard_deviation_m);
  if (steps.confidence) {
    find_rows(records.directions, chunk.rival, chunk.pixels, chunk.rival_start);
    find_confidence(c, records, rank, chunk);
  }
  if (planes.confidence) write_values(chunk, chunk.confidence, planes.confidence);
  if (planes.status) {
    if (!steps.confidence) std::fill_n(chunk.confidence, pixels_per_chunk, 1.0f);
    find_signal_noise(layout, chunk);
    write_status(c, chunk, saturated, planes.status);
  }
}

/// Row numbers of a chunk: those of its pixels, then -1.
HWY_INLINE void copy_rows(const std::int32_t* numbers, int pixels, std::int32_t* to) {
  std::fill(std::copy_n(numbers, pixels, to), to + pixels_per_chunk, -1);
}

template <int Rank>
HWY_INLINE void write_tile(const BinRecords& records, const Constants& c, const OutputSteps& steps,
                           const MatchedTile& tile, const DecodedView& planes) {
  OutputChunk chunk;
  for (int first = 0; first < tile.pixels; first += pixels_per_chunk) {
    chunk.pixels = std::min(tile.pixels - first, pixels_per_chunk);
    copy_rows(tile.bin + first, chunk.pixels, chunk.bin);
    if (steps.confidence) copy_rows(tile.rival + first, chunk.pixels, chunk.rival);
    chunk.plane = tile.plane + first;
    chunk.electrons = tile.electrons ? tile.electrons + first : nullptr;
    write_chunk<Rank>(records, c, steps, tile.saturated ? tile.saturated + first : nullptr, chunk,
                      planes.from(static_cast<std::size_t>(first)));
  }
}

void write(const BinRecords& records, const Constants& c, const OutputSteps& steps,
           const MatchedTile& tile, const DecodedView& planes) {
  switch (records.layout.rank) {
    case 2:
      return write_tile<2>(records, c, steps, tile, planes);
    case 3:
      return write_tile<3>(records, c, steps, tile, planes);
    case 4:
      return write_tile<4>(records, c, steps, tile, planes);
    default:
      return write_tile<0>(records, c, steps, tile, planes);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tofsmith {

HWY_EXPORT(write);

namespace {

std::vector<float> in_floats(const Eigen::VectorXd& values) {
  return {values.begin(), values.end()};
}

/// What has so few digits that its product with any of so many integers is exact.
float with_room_for(double value, int integers) {
  int exponent = 0;
  const double mantissa = std::frexp(value, &exponent);
  const int digits = std::numeric_limits<float>::digits -
                     static_cast<int>(std::bit_width(static_cast<unsigned>(integers)));
  return static_cast<float>(
      std::ldexp(std::nearbyint(std::ldexp(mantissa, digits)), exponent - digits));
}

}  // namespace

OutputKernel::OutputKernel(const DecodingTable& table, const AmbientProjection& projection,
                           const DecodeOptions& options)
    : records_(table, projection) {
  const double bin_m = table.bin_m();
  const MeasurementNoise noise(table);
  const double ambient2 = projection.ambient.squaredNorm();
  constants_.samples = table.samples();
  constants_.bin_m = static_cast<float>(bin_m);
  constants_.bin_high_m = with_room_for(bin_m, table.samples());
  constants_.bin_low_m = static_cast<float>(bin_m - constants_.bin_high_m);
  constants_.range_m = static_cast<float>(table.range_m);
  constants_.sees_ambient = ambient2 > 0.0;
  if (constants_.sees_ambient) constants_.ambient_weight = in_floats(projection.ambient / ambient2);
  const RowMajorMatrix basis = projection.basis;
  constants_.basis.assign(basis.data(), basis.data() + basis.size());
  constants_.shot_ambient = in_floats(noise.per_ambient);
  constants_.floor_noise_e2 = in_floats(noise.without_light_e2);
  constants_.most_shot = static_cast<float>(std::max(0.0, noise.per_signal.maxCoeff()));
  constants_.most_shot_ambient = static_cast<float>(std::max(0.0, noise.per_ambient.maxCoeff()));
  constants_.most_floor_e2 =
      std::max(least_variance_e2, static_cast<float>(noise.without_light_e2.maxCoeff()));
  constants_.low_signal_sigma2 = static_cast<float>(std::min<double>(
      options.low_signal_sigma * options.low_signal_sigma, std::numeric_limits<float>::max()));
  constants_.minimum_confidence = static_cast<float>(options.minimum_confidence);
}

bool OutputKernel::needs_electrons(const DecodedView& planes) const {
  return constants_.sees_ambient && (planes.ambient_e_per_s || planes.confidence ||
                                     planes.predicted_standard_deviation_m || planes.status);
}

bool OutputKernel::needs_rivals(const DecodedView& planes) const {
  return planes.confidence || (planes.status && constants_.minimum_confidence > 0.0f);
}

void OutputKernel::write(const MatchedTile& tile, const DecodedView& planes) const {
  const RecordLayout& layout = records_.layout;
  OutputSteps steps;
  steps.confidence = needs_rivals(planes);
  steps.noise = steps.confidence || planes.predicted_standard_deviation_m || planes.status;
  steps.ambient = steps.noise || planes.ambient_e_per_s;
  steps.fields = steps.confidence ? layout.end_of_directions()
                 : steps.noise    ? layout.end_of_noise()
                 : steps.ambient  ? layout.end_of_light()
                                  : layout.end_of_depth();
  HWY_DYNAMIC_DISPATCH(write)(records_, constants_, steps, tile, planes);
}

}  // namespace tofsmith
#endif

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Noise, confidence and status.
#if defined(TOFSMITH_DECODE_OUTPUT_NOISE_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef TOFSMITH_DECODE_OUTPUT_NOISE_INL_HPP
#undef TOFSMITH_DECODE_OUTPUT_NOISE_INL_HPP
#else
#define TOFSMITH_DECODE_OUTPUT_NOISE_INL_HPP
#endif

#include "decode/ambient_projection.hpp"
#include "decode/output/lobe_posterior.hpp"
#include "decode/output/output_position-inl.hpp"
#include "decode/output/shared/output_vectors-inl.hpp"
#include "tofsmith/decode/depth_image.hpp"

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {
/// Ambient light that contributes shot noise.
HWY_INLINE Vector noisy_ambient(const OutputChunk& chunk, int i) {
  return hn::Max(load(chunk.ambient, i), hn::Zero(Floats()));
}

HWY_INLINE Vector variance_of(Vector signal, Vector ambient, Vector per_signal, Vector per_ambient,
                              Vector without) {
  const Vector sum = product_plus(signal, per_signal, product_plus(ambient, per_ambient, without));
  return hn::Max(sum, hn::Zero(Floats()));
}

HWY_INLINE void find_signal_noise(const RecordLayout& layout, OutputChunk& chunk) {
  const Floats d;
  const float* noise = chunk.field(layout.signal_noise());
  for (int i = 0; i < chunk.pixels; i += lanes_of(d))
    hn::StoreU(hn::Mul(variance_of(load(chunk.signal, i), noisy_ambient(chunk, i), load(noise, i),
                                   load(noise + pixels_per_chunk, i),
                                   load(noise + 2 * pixels_per_chunk, i)),
                       load(chunk.variance_share, i)),
               d, chunk.signal_variance + i);
}

HWY_INLINE void write_depth_noise(const OutputChunk& chunk, float* standard_deviation_m) {
  const Floats d;
  const float* noise = chunk.chord_field(ChordLayout::depth_noise);
  for (int i = 0; i < chunk.pixels; i += lanes_of(d)) {
    const Vector signal = load(chunk.signal, i);
    const Vector variance =
        variance_of(signal, noisy_ambient(chunk, i), load(noise, i),
                    load(noise + pixels_per_chunk, i), load(noise + 2 * pixels_per_chunk, i));
    const Vector deviation =
        hn::Div(hn::Sqrt(hn::Mul(variance, load(chunk.variance_share, i))), signal);
    store_some(d, unless(hn::Gt(signal, hn::Zero(d)), deviation), standard_deviation_m + i,
               chunk.pixels - i);
  }
}

/// Returns the pixels whose confidence is proven to be 1. With c = <q, u_b>, the length r of q
/// across u_b and scores of other places <= s = cosine c + sine r (LobeBound), their chi-square is
/// larger by (|q|^2 - s^2 - r^2) / v.
HWY_INLINE Mask is_sure(const OutputConstants& c, const RecordLayout& layout, int rank,
                        const OutputChunk& chunk, int i) {
  const Floats d;
  const float* const bound = chunk.field(layout.bound());
  Vector square = hn::Zero(d);
  for (int j = 0; j < rank; ++j) {
    const Vector q = load(chunk.plane + j * pixels_per_tile, i);
    square = product_plus(q, q, square);
  }
  const Vector score = hn::Mul(along(chunk, rank, layout.point(), i), load(bound, i));
  const Vector across2 = hn::Max(hn::Sub(square, hn::Mul(score, score)), hn::Zero(d));
  const Vector other =
      product_plus(score, load(bound + pixels_per_chunk, i),
                   hn::Mul(hn::Sqrt(across2), load(bound + 2 * pixels_per_chunk, i)));
  const Vector lead = hn::Sub(hn::Sub(square, hn::Mul(other, other)), across2);
  const Vector variance = product_plus(
      load(chunk.signal, i), load(bound + 3 * pixels_per_chunk, i),
      product_plus(noisy_ambient(chunk, i), all(c.typical_ambient), all(c.typical_floor_e2)));
  const Vector least = hn::Mul(all(sure_lead), hn::Mul(variance, load(chunk.lobe_share, i)));
  return hn::And(hn::Lt(other, score), hn::Ge(lead, least));
}

inline float posterior_of(const OutputConstants& c, const BinRecords& records,
                          const LobePosterior& posterior, int rank, const OutputChunk& chunk,
                          int i) {
  const float* const record = records.records.row(chunk.bin[i]);
  const float* const bound = record + records.layout.bound();
  const float lit = chunk.signal[i], dim = std::max(chunk.ambient[i], 0.0f);
  float q[max_measurements] = {}, score = 0.0f;
  for (int j = 0; j < rank; ++j) {
    q[j] = chunk.plane[j * pixels_per_tile + i];
    score += q[j] * record[records.layout.point() + j];
  }
  const float variance = lit * bound[3] + (dim * c.typical_ambient + c.typical_floor_e2);
  if (posterior.is_sure(q, score * bound[0], sure_lead * (variance * chunk.lobe_share[i]),
                        chunk.bin[i]))
    return 1.0f;

  double plane[max_measurements], variance_e2[max_measurements];
  std::copy_n(q, rank, plane);
  const double signal = lit, ambient = dim;
  const float* const shot = record + records.layout.shot();
  for (int k = 0; k < records.layout.measurements; ++k)
    variance_e2[k] =
        chunk.lobe_share[i] *
        std::max(min_variance_e2, signal * shot[k] + ambient * c.shot_ambient.data()[k] +
                                      c.floor_noise_e2.data()[k]);
  return static_cast<float>(posterior.probability(plane, variance_e2, chunk.bin[i]));
}

HWY_INLINE void find_confidence(const OutputConstants& c, const BinRecords& records,
                                const LobePosterior& posterior, int rank, OutputChunk& chunk) {
  const Floats d;
  for (int i = 0; i < chunk.pixels; i += lanes_of(d)) {
    const Vector one = all(1.0f);
    hn::StoreU(one, d, chunk.confidence + i);
    const Mask has_depth = hn::Gt(load(chunk.signal, i), hn::Zero(d));
    const Mask is_open = hn::AndNot(is_sure(c, records.layout, rank, chunk, i), has_depth);
    if (hn::AllFalse(d, is_open)) continue;
    alignas(64) float open[pixels_per_chunk];
    hn::StoreU(hn::IfThenElseZero(is_open, one), d, open);
    const int end = std::min(lanes_of(d), chunk.pixels - i);
    for (int lane = 0; lane < end; ++lane)
      if (open[lane] != 0.0f)
        chunk.confidence[i + lane] = posterior_of(c, records, posterior, rank, chunk, i + lane);
  }
}

HWY_INLINE hn::Vec<Indices> status(PixelStatus value) {
  return hn::Set(Indices(), static_cast<std::int32_t>(value));
}

HWY_INLINE void write_status(const OutputConstants& c, const OutputChunk& chunk,
                             const std::uint8_t* saturated, PixelStatus* to) {
  const Floats d;
  const Indices di;
  for (int i = 0; i < chunk.pixels; i += lanes_of(d)) {
    const Vector signal = load(chunk.signal, i);
    const Vector least2 = hn::Mul(all(c.low_signal_sigma2), load(chunk.signal_variance, i));
    const auto is_ambiguous =
        hn::RebindMask(di, hn::Lt(load(chunk.confidence, i), all(c.min_confidence)));
    const auto is_low = hn::RebindMask(di, hn::Lt(hn::Mul(signal, signal), least2));
    const auto is_nothing = hn::RebindMask(di, hn::Not(hn::Gt(signal, hn::Zero(d))));
    const auto is_saturated =
        hn::Gt(hn::PromoteTo(di, hn::LoadU(Bytes(), saturated + i)), hn::Zero(di));
    const auto is_invalid = hn::Lt(hn::LoadU(di, chunk.bin + i), hn::Zero(di));
    const auto is_inconsistent =
        hn::RebindMask(di, hn::Gt(load(chunk.inconsistent, i), hn::Zero(d)));
    auto value =
        hn::IfThenElse(is_ambiguous, status(PixelStatus::ambiguous), status(PixelStatus::ok));
    value = hn::IfThenElse(is_inconsistent, status(PixelStatus::inconsistent), value);
    value = hn::IfThenElse(is_low, status(PixelStatus::low_signal), value);
    value = hn::IfThenElse(is_nothing, status(PixelStatus::no_return), value);
    value = hn::IfThenElse(is_saturated, status(PixelStatus::saturated), value);
    value = hn::IfThenElse(is_invalid, status(PixelStatus::invalid), value);
    store_some(Bytes(), hn::DemoteTo(Bytes(), value), reinterpret_cast<std::uint8_t*>(to + i),
               chunk.pixels - i);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#endif

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// What is known of a pixel's noise: deviations, confidence and status. Compiled once for every
// instruction set.
#if defined(TOFSMITH_DECODE_OUTPUT_NOISE_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef TOFSMITH_DECODE_OUTPUT_NOISE_INL_HPP
#undef TOFSMITH_DECODE_OUTPUT_NOISE_INL_HPP
#else
#define TOFSMITH_DECODE_OUTPUT_NOISE_INL_HPP
#endif

#include "decode/output/shared/output_vectors-inl.hpp"
#include "tofsmith/decode/depth_image.hpp"

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {
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

/// 1 / (1 + exp(-x)) at x in [0, 80], to 2e-7.
HWY_INLINE Vector logistic(Vector x) {
  const Indices di;
  const Vector power = hn::Mul(x, all(-1.44269504f));
  const Vector whole = hn::Round(power), rest = hn::Sub(power, whole);
  Vector series = product_plus(rest, all(1.54035304e-4f), all(1.33335581e-3f));
  series = product_plus(rest, series, all(9.61812911e-3f));
  series = product_plus(rest, series, all(5.55041087e-2f));
  series = product_plus(rest, series, all(0.240226507f));
  series = product_plus(rest, series, all(0.693147181f));
  series = product_plus(rest, series, all(1.0f));
  const auto exponent = hn::Add(hn::ConvertTo(di, whole), hn::Set(di, 127));
  const Vector two_to_whole = hn::BitCast(Floats(), hn::ShiftLeft<23>(exponent));
  return hn::Div(all(1.0f), product_plus(series, two_to_whole, all(1.0f)));
}

/// How far the best bin leads its second peak.
struct Lead {
  Vector score;   ///< of the best bin, <b, q>
  Vector lead;    ///< <d, q>, with d the difference of both directions
  Vector square;  ///< |d|^2
};

/// Leaves the difference of directions of bins and second peaks instead of the second peaks'.
HWY_INLINE Lead lead_of(const RecordLayout& layout, int rank, OutputChunk& chunk, int i) {
  const Floats d;
  Vector score = hn::Zero(d), lead = score, square = score;
  for (int j = 0; j < rank; ++j) {
    float* const second_peak = chunk.second_peak_direction + j * pixels_per_chunk + i;
    const Vector best = load(chunk.field(layout.direction() + j), i);
    const Vector q = load(chunk.plane + j * pixels_per_tile, i);
    const Vector apart = hn::Sub(best, load(second_peak, 0));
    hn::StoreU(apart, d, second_peak);
    score = product_plus(best, q, score);
    lead = product_plus(apart, q, lead);
    square = product_plus(apart, apart, square);
  }
  return {score, hn::Max(lead, hn::Zero(d)), square};
}

/// Noise of the lead: sum_k (V d)_k^2 v_k.
HWY_INLINE Vector lead_variance(const OutputConstants& c, const RecordLayout& layout, int rank,
                                const OutputChunk& chunk, int i) {
  const Vector signal = load(chunk.signal, i), ambient = noisy_ambient(chunk, i);
  Vector variance = hn::Zero(Floats());
  for (int k = 0; k < layout.measurements; ++k) {
    const float* const basis = c.basis.data() + k * rank;
    Vector weight = hn::Zero(Floats());
    for (int j = 0; j < rank; ++j)
      weight = product_plus(load(chunk.second_peak_direction + j * pixels_per_chunk, i),
                            all(basis[j]), weight);
    const Vector without_signal =
        product_plus(ambient, all(c.shot_ambient.data()[k]), all(c.floor_noise_e2.data()[k]));
    const Vector noise =
        product_plus(signal, load(chunk.field(layout.shot() + k), i), without_signal);
    variance = product_plus(hn::Mul(weight, weight),
                            hn::Max(noise, all(static_cast<float>(min_variance_e2))), variance);
  }
  return variance;
}

/// Probability of the bin against its second peak, as confidence_of(): lead score |d|^2 / variance
/// are the log odds. For most leads they are such that the probability is 1 as a float even with
/// the most noise there can be: the noise of others alone is computed.
HWY_INLINE void find_confidence(const OutputConstants& c, const BinRecords& records, int rank,
                                OutputChunk& chunk) {
  const Floats d;
  const RecordLayout& layout = records.layout;
  const Vector zero = hn::Zero(d), one = all(1.0f);
  for (int i = 0; i < chunk.pixels; i += lanes_of(d)) {
    gather(records.directions.data(), chunk.second_peak_start + i, 0, rank,
           chunk.second_peak_direction + i);
    const Lead found = lead_of(layout, rank, chunk, i);
    const Vector product = hn::Mul(found.lead, found.score);
    const Vector max_noise = product_plus(
        load(chunk.signal, i), all(c.max_shot),
        product_plus(noisy_ambient(chunk, i), all(c.max_shot_ambient), all(c.max_floor_e2)));
    const Vector share = load(chunk.variance_share, i);
    const Mask is_sure = hn::Ge(product, hn::Mul(all(sure_log_odds), hn::Mul(max_noise, share)));
    const auto has_second_peak =
        hn::Gt(hn::LoadU(Indices(), chunk.second_peak + i), hn::Set(Indices(), -1));
    const Mask is_open = hn::And(hn::And(hn::RebindMask(d, has_second_peak), hn::Not(is_sure)),
                                 hn::Gt(load(chunk.signal, i), zero));
    Vector confidence = one;
    if (!hn::AllFalse(d, is_open)) {
      gather(records.records.data(), chunk.start + i, layout.shot(), layout.end(),
             chunk.record + i);
      const Vector variance = hn::Mul(lead_variance(c, layout, rank, chunk, i), share);
      const Vector log_odds =
          hn::Min(hn::Div(hn::Mul(product, found.square), variance), all(sure_log_odds));
      confidence = hn::IfThenElse(is_open, logistic(log_odds), confidence);
    }
    hn::StoreU(confidence, d, chunk.confidence + i);
  }
}

HWY_INLINE hn::Vec<Indices> status(PixelStatus value) {
  return hn::Set(Indices(), static_cast<std::int32_t>(value));
}

/// The first status in the order of PixelStatus that applies.
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

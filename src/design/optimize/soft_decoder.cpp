// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/optimize/soft_decoder.hpp"

#include <limits>
#include <span>
#include <type_traits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "design/optimize/soft_decoder.cpp"
#include <hwy/foreach_target.h>
// Highway requires its headers after foreach_target.
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "core/shared/vectors-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {

template <typename Value>
using Tag = hn::CappedTag<Value, widest_vector * sizeof(float) / sizeof(Value)>;

constexpr float smallest = 1e-30f;
/// Smaller shares of chords, relative to the largest, are 0. Their sums are rounding errors.
template <typename Value>
constexpr Value negligible_log_share = std::is_same_v<Value, float> ? -25 : -45;

/// <y, p_j> of a vector of points.
template <typename Value>
HWY_INLINE auto match_at(const DecodingCurveOf<Value>& curve, const Value* HWY_RESTRICT electrons,
                         int j) {
  const Tag<Value> d;
  auto sum = hn::Zero(d);
  for (int r = 0; r < curve.measurements; ++r)
    sum = hn::MulAdd(hn::Set(d, electrons[r]), hn::Load(d, curve.component(r) + j), sum);
  return sum;
}

template <typename Value>
HWY_INLINE void match_points(const DecodingCurveOf<Value>& curve,
                             const Value* HWY_RESTRICT electrons,
                             typename SoftDecoderOf<Value>::Scratch& scratch) {
  const Tag<Value> d;
  const int lanes = lanes_of(d);
  for (int j = 0; j <= curve.samples; j += lanes)
    hn::Store(match_at(curve, electrons, j), d, scratch.match.data() + j);
}

/// Finds the best point of each chord in [first, past); `first` is a multiple of the vector length,
/// and the last vector may extend beyond `past`. With u = Q11 b0 - Q01 b1 and v = Q00 b1 - Q01 b0
/// it is at t = v / (u + v) if both are > 0, otherwise at the better end. Scores are S_j, or -1 in
/// the padding; returns the largest.
template <typename Value>
HWY_INLINE Value score_chords(const DecodingCurveOf<Value>& curve, int first, int past,
                              typename SoftDecoderOf<Value>::Scratch& scratch) {
  const Tag<Value> d;
  const int lanes = lanes_of(d);
  const auto zero = hn::Zero(d), one = hn::Set(d, 1.0f), half = hn::Set(d, 0.5f);
  const auto min_square = hn::Set(d, smallest_square<Value>);
  auto largest = hn::Set(d, -1.0f);
  for (int j = first; j < past; j += lanes) {
    const auto b0 = hn::Load(d, scratch.match.data() + j);
    const auto b1 = hn::LoadU(d, scratch.match.data() + j + 1);
    const auto q00 = hn::Add(hn::Load(d, curve.squares.data() + j), min_square);
    const auto q11 = hn::Add(hn::LoadU(d, curve.squares.data() + j + 1), min_square);
    const auto q01 = hn::Load(d, curve.products.data() + j);
    const auto u = hn::NegMulAdd(q01, b1, hn::Mul(q11, b0));
    const auto v = hn::NegMulAdd(q01, b0, hn::Mul(q00, b1));
    const auto inside = hn::And(hn::Gt(u, zero), hn::Gt(v, zero));
    const auto inverse = hn::Div(one, hn::Max(hn::Add(u, v), hn::Set(d, smallest)));
    const auto upper_is_better =
        hn::Gt(hn::Mul(hn::Mul(b1, hn::Abs(b1)), q00), hn::Mul(hn::Mul(b0, hn::Abs(b0)), q11));
    const auto end = hn::IfThenElseZero(upper_is_better, one);
    const auto t = hn::IfThenElse(inside, hn::Mul(v, inverse), end);
    const auto s = hn::Sub(one, t);
    const auto match = hn::Max(zero, hn::MulAdd(s, b0, hn::Mul(t, b1)));
    const auto cross = hn::Mul(hn::Mul(hn::Add(q01, q01), s), t);
    const auto square =
        hn::Max(min_square, hn::MulAdd(hn::Mul(q00, s), s, hn::MulAdd(hn::Mul(q11, t), t, cross)));
    const auto ratio = hn::Div(match, square);
    const auto in_range =
        hn::Lt(hn::Iota(d, static_cast<Value>(j)), hn::Set(d, static_cast<Value>(curve.samples)));
    const auto score =
        hn::IfThenElse(in_range, hn::Mul(half, hn::Mul(match, ratio)), hn::Set(d, -1.0f));
    hn::Store(t, d, scratch.place.data() + j);
    hn::Store(ratio, d, scratch.ratio.data() + j);
    hn::Store(score, d, scratch.score.data() + j);
    hn::Store(hn::IfThenElseZero(inside, inverse), d, scratch.free.data() + j);
    largest = hn::Max(largest, score);
  }
  return hn::GetLane(hn::MaxOfLanes(d, largest));
}

/// Computes all matches and returns the bin with the best correlation, the lowest of equal ones.
template <typename Value>
HWY_INLINE int match_all(const DecodingCurveOf<Value>& curve, const Value* HWY_RESTRICT electrons,
                         typename SoftDecoderOf<Value>::Scratch& scratch) {
  const Tag<Value> d;
  const int lanes = lanes_of(d);
  const auto samples = hn::Set(d, static_cast<Value>(curve.samples));
  auto best = hn::Set(d, -std::numeric_limits<Value>::max());
  auto bin = hn::Sub(samples, hn::Set(d, 1.0f));
  for (int j = 0; j <= curve.samples; j += lanes) {
    const auto match = match_at(curve, electrons, j);
    hn::Store(match, d, scratch.match.data() + j);
    const auto score = hn::Mul(match, hn::Load(d, curve.inverse_lengths.data() + j));
    const auto index = hn::Iota(d, static_cast<Value>(j));
    const auto leads = hn::And(hn::Gt(score, best), hn::Lt(index, samples));
    best = hn::IfThenElse(leads, score, best);
    bin = hn::IfThenElse(leads, index, bin);
  }
  const auto is_best = hn::Eq(best, hn::MaxOfLanes(d, best));
  return static_cast<int>(hn::GetLane(hn::MinOfLanes(d, hn::IfThenElse(is_best, bin, samples))));
}

template <typename Value>
Value best_place(const DecodingCurveOf<Value>& curve, const Value* electrons,
                 typename SoftDecoderOf<Value>::Scratch& scratch) {
  const int right = match_all(curve, electrons, scratch);
  const int left = right > 0 ? right - 1 : curve.samples - 1;
  const int lanes = lanes_of(Tag<Value>());
  const int left_vector = left - left % lanes, right_vector = right - right % lanes;
  score_chords(curve, left_vector, left_vector + lanes, scratch);
  if (right_vector != left_vector) score_chords(curve, right_vector, right_vector + lanes, scratch);
  const auto score = [&](int chord) { return scratch.score[static_cast<std::size_t>(chord)]; };
  const int chord = score(left) > score(right) ? left : right;
  return static_cast<Value>(chord) + scratch.place[static_cast<std::size_t>(chord)];
}

template <typename D, typename V, typename Value>
HWY_INLINE V chord_error(D d, V place, Value true_bin, Value samples,
                         const SoftQuestion& question) {
  const auto beyond = hn::Sub(place, hn::Set(d, true_bin));
  const auto distance = hn::Abs(beyond), whole = hn::Set(d, samples);
  if (question.is_signed) {
    if (!question.circular) return beyond;
    const auto around = hn::Gt(hn::Add(distance, distance), whole);
    return hn::Sub(beyond, hn::IfThenElseZero(around, hn::CopySign(whole, beyond)));
  }
  if (!question.circular) return distance;
  return hn::Min(distance, hn::Sub(whole, distance));
}

/// Unnormalized weights of the chords. Writes {sum of weights, sum of weighted errors}.
template <typename Value>
HWY_INLINE void weigh_chords(const DecodingCurveOf<Value>& curve, const SoftQuestion& question,
                             Value largest, typename SoftDecoderOf<Value>::Scratch& scratch,
                             Value* sums) {
  const Tag<Value> d;
  const int lanes = lanes_of(d);
  const auto sharpness = hn::Set(d, static_cast<Value>(question.sharpness));
  const auto shift = hn::Set(d, largest);
  auto total = hn::Zero(d), error_total = hn::Zero(d);
  for (int j = 0; j < curve.samples; j += lanes) {
    const auto exponent = hn::Mul(sharpness, hn::Sub(hn::Load(d, scratch.score.data() + j), shift));
    const auto matters = hn::Gt(exponent, hn::Set(d, negligible_log_share<Value>));
    if (hn::AllFalse(d, matters)) {
      hn::Store(hn::Zero(d), d, scratch.share.data() + j);
      continue;
    }
    const auto index = hn::Iota(d, static_cast<Value>(j));
    const auto place = hn::Add(index, hn::Load(d, scratch.place.data() + j));
    const auto error = chord_error(d, place, static_cast<Value>(question.true_bin),
                                   static_cast<Value>(curve.samples), question);
    const auto in_range = hn::Lt(index, hn::Set(d, static_cast<Value>(curve.samples)));
    const auto share = hn::IfThenElseZero(hn::And(in_range, matters), hn::Exp(d, exponent));
    hn::Store(share, d, scratch.share.data() + j);
    hn::Store(error, d, scratch.error.data() + j);
    total = hn::Add(total, share);
    error_total = hn::MulAdd(share, error, error_total);
  }
  sums[0] = sum_of_lanes(d, total);
  sums[1] = sum_of_lanes(d, error_total);
}

/// Gradient of the expected error w.r.t. the matches b_j at both ends of every chord; adds the
/// weighted gradient w.r.t. the squares and products of the curve.
template <typename Value>
HWY_INLINE void differentiate_chords(const DecodingCurveOf<Value>& curve,
                                     const SoftQuestion& question, Value weight,
                                     Value normalization, Value expected,
                                     CurveGradientOf<Value>& gradient,
                                     typename SoftDecoderOf<Value>::Scratch& scratch) {
  const Tag<Value> d;
  const int lanes = lanes_of(d);
  const auto one = hn::Set(d, 1.0f), half = hn::Set(d, 0.5f), zero = hn::Zero(d);
  const auto min_square = hn::Set(d, smallest_square<Value>);
  const auto samples = hn::Set(d, static_cast<Value>(curve.samples));
  const auto truth = hn::Set(d, static_cast<Value>(question.true_bin));
  const auto scale = hn::Set(d, weight);
  for (int j = 0; j < curve.samples; j += lanes) {
    const auto share = hn::Mul(hn::Load(d, scratch.share.data() + j), hn::Set(d, normalization));
    if (hn::AllTrue(d, hn::Eq(share, zero))) {
      hn::Store(zero, d, scratch.by_match.data() + j);
      hn::StoreU(zero, d, scratch.by_next_match.data() + j + 1);
      continue;
    }
    const auto b0 = hn::Load(d, scratch.match.data() + j);
    const auto b1 = hn::LoadU(d, scratch.match.data() + j + 1);
    const auto q00 = hn::Add(hn::Load(d, curve.squares.data() + j), min_square);
    const auto q11 = hn::Add(hn::LoadU(d, curve.squares.data() + j + 1), min_square);
    const auto q01 = hn::Load(d, curve.products.data() + j);
    const auto t = hn::Load(d, scratch.place.data() + j);
    const auto s = hn::Sub(one, t);

    // Through the score S = match^2 / (2 square), stationary in free t.
    const auto by_score =
        hn::Mul(hn::Mul(hn::Set(d, static_cast<Value>(question.sharpness)), share),
                hn::Sub(hn::Load(d, scratch.error.data() + j), hn::Set(d, expected)));
    const auto ratio = hn::Load(d, scratch.ratio.data() + j);
    const auto by_match = hn::Mul(by_score, ratio);
    const auto by_square = hn::Neg(hn::Mul(half, hn::Mul(by_match, ratio)));
    auto by_b0 = hn::Mul(by_match, s);
    auto by_b1 = hn::Mul(by_match, t);
    auto by_q00 = hn::Mul(hn::Mul(by_square, s), s);
    auto by_q11 = hn::Mul(hn::Mul(by_square, t), t);
    auto by_q01 = hn::Mul(hn::Mul(hn::Add(by_square, by_square), s), t);

    // Through the position t = v / (u + v).
    const auto from_truth = hn::Sub(hn::Add(hn::Iota(d, static_cast<Value>(j)), t), truth);
    auto sign = hn::IfThenElse(hn::Gt(from_truth, zero), one, hn::Set(d, -1.0f));
    if (question.is_signed) sign = one;
    if (question.circular && !question.is_signed) {
      const auto around = hn::Gt(hn::Abs(from_truth), hn::Mul(half, samples));
      sign = hn::IfThenElse(around, hn::Neg(sign), sign);
    }
    const auto by_place = hn::Mul(hn::Mul(share, sign), hn::Load(d, scratch.free.data() + j));
    const auto by_u = hn::Neg(hn::Mul(by_place, t));
    const auto by_v = hn::Mul(by_place, s);
    by_b0 = hn::MulAdd(by_u, q11, hn::NegMulAdd(by_v, q01, by_b0));
    by_b1 = hn::MulAdd(by_v, q00, hn::NegMulAdd(by_u, q01, by_b1));
    by_q11 = hn::MulAdd(by_u, b0, by_q11);
    by_q00 = hn::MulAdd(by_v, b1, by_q00);
    by_q01 = hn::NegMulAdd(by_u, b1, hn::NegMulAdd(by_v, b0, by_q01));

    const auto add = [&](Aligned<Value>& sum, auto value) {
      hn::Store(hn::MulAdd(scale, value, hn::Load(d, sum.data() + j)), d, sum.data() + j);
    };
    add(gradient.squares, by_q00);
    add(gradient.next_squares, by_q11);
    add(gradient.products, by_q01);
    hn::Store(by_b0, d, scratch.by_match.data() + j);
    hn::StoreU(by_b1, d, scratch.by_next_match.data() + j + 1);
  }
  // Padding lanes are zero. Point N is point 0.
  scratch.by_next_match[0] = scratch.by_next_match[static_cast<std::size_t>(curve.samples)];
}

template <typename Value>
HWY_INLINE void differentiate_matches(const DecodingCurveOf<Value>& curve, const Value* electrons,
                                      Value weight, CurveGradientOf<Value>& gradient,
                                      typename SoftDecoderOf<Value>::Scratch& scratch,
                                      Value* by_electrons) {
  const Tag<Value> d;
  const int lanes = lanes_of(d);
  const auto active = std::span(scratch.active);
  std::size_t count = 0;
  for (int j = 0; j < curve.samples; j += lanes) {
    const auto sum = hn::Add(hn::Load(d, scratch.by_match.data() + j),
                             hn::Load(d, scratch.by_next_match.data() + j));
    const auto in_range =
        hn::Lt(hn::Iota(d, static_cast<Value>(j)), hn::Set(d, static_cast<Value>(curve.samples)));
    const auto by_match = hn::IfThenElseZero(in_range, sum);
    hn::Store(by_match, d, scratch.by_match.data() + j);
    if (!hn::AllTrue(d, hn::Eq(by_match, hn::Zero(d)))) active[count++] = j;
  }
  for (int r = 0; r < curve.measurements; ++r) {
    Value* HWY_RESTRICT by_points = gradient.points.data() + r * curve.stride;
    const Value* HWY_RESTRICT points = curve.component(r);
    const auto electron = hn::Set(d, weight * electrons[r]);
    auto sum = hn::Zero(d);
    for (const int j : active.first(count)) {
      const auto by_match = hn::Load(d, scratch.by_match.data() + j);
      sum = hn::MulAdd(by_match, hn::Load(d, points + j), sum);
      hn::Store(hn::MulAdd(by_match, electron, hn::Load(d, by_points + j)), d, by_points + j);
    }
    by_electrons[r] = sum_of_lanes(d, sum);
  }
}

template <typename Value>
Value soft_error(const DecodingCurveOf<Value>& curve, const Value* electrons,
                 const SoftQuestion& question, Value weight, CurveGradientOf<Value>* gradient,
                 typename SoftDecoderOf<Value>::Scratch& scratch, Value* by_electrons) {
  match_points(curve, electrons, scratch);
  const Value largest = score_chords(curve, 0, curve.samples, scratch);
  Value sums[2];
  weigh_chords(curve, question, largest, scratch, sums);
  const Value expected = sums[1] / sums[0];
  if (!gradient) return expected;
  differentiate_chords(curve, question, weight, 1.0f / sums[0], expected, *gradient, scratch);
  differentiate_matches(curve, electrons, weight, *gradient, scratch, by_electrons);
  return expected;
}

// Dispatched functions cannot be templates.
float decode_floats(const DecodingCurve& curve, const float* electrons,
                    SoftDecoder::Scratch& scratch) {
  return best_place(curve, electrons, scratch);
}
double decode_doubles(const DecodingCurveOf<double>& curve, const double* electrons,
                      SoftDecoderOf<double>::Scratch& scratch) {
  return best_place(curve, electrons, scratch);
}
float error_of_floats(const DecodingCurve& curve, const float* electrons,
                      const SoftQuestion& question, float weight, CurveGradient* gradient,
                      SoftDecoder::Scratch& scratch, float* by_electrons) {
  return soft_error(curve, electrons, question, weight, gradient, scratch, by_electrons);
}
double error_of_doubles(const DecodingCurveOf<double>& curve, const double* electrons,
                        const SoftQuestion& question, double weight,
                        CurveGradientOf<double>* gradient, SoftDecoderOf<double>::Scratch& scratch,
                        double* by_electrons) {
  return soft_error(curve, electrons, question, weight, gradient, scratch, by_electrons);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tofsmith {

HWY_EXPORT(decode_floats);
HWY_EXPORT(decode_doubles);
HWY_EXPORT(error_of_floats);
HWY_EXPORT(error_of_doubles);

template <typename Value>
SoftDecoderOf<Value>::Scratch::Scratch(int stride) : active(static_cast<std::size_t>(stride)) {
  for (Aligned<Value>* values :
       {&match, &ratio, &score, &place, &free, &share, &error, &by_match, &by_next_match})
    values->assign(static_cast<std::size_t>(stride), Value{0});
}

template <typename Value>
SoftDecoderOf<Value>::SoftDecoderOf(const DecodingCurveOf<Value>& curve) : scratch_(curve.stride) {}

template <typename Value>
double SoftDecoderOf<Value>::decode(const DecodingCurveOf<Value>& curve, const Value* electrons) {
  if constexpr (std::is_same_v<Value, float>)
    return HWY_DYNAMIC_DISPATCH(decode_floats)(curve, electrons, scratch_);
  else
    return HWY_DYNAMIC_DISPATCH(decode_doubles)(curve, electrons, scratch_);
}

template <typename Value>
double SoftDecoderOf<Value>::expected_error(const DecodingCurveOf<Value>& curve,
                                            const Value* electrons, const SoftQuestion& question,
                                            Value weight, CurveGradientOf<Value>* gradient,
                                            Value* by_electrons) {
  if constexpr (std::is_same_v<Value, float>)
    return HWY_DYNAMIC_DISPATCH(error_of_floats)(curve, electrons, question, weight, gradient,
                                                 scratch_, by_electrons);
  else
    return HWY_DYNAMIC_DISPATCH(error_of_doubles)(curve, electrons, question, weight, gradient,
                                                  scratch_, by_electrons);
}

template class SoftDecoderOf<float>;
template class SoftDecoderOf<double>;

}  // namespace tofsmith
#endif

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/soft_decoder.hpp"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "design/soft_decoder.cpp"
#include <hwy/foreach_target.h>
// Highway asks for its own headers after foreach_target.
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 16>;

constexpr float smallest_square = 1e-10f;  // |p|^2 of a point without contrast
constexpr float smallest = 1e-30f;

/// beta_j = <y, p_j>, j = 0 .. N.
HWY_INLINE void match_points(const DecodingCurve& curve, const float* HWY_RESTRICT electrons,
                             SoftDecoder::Scratch& scratch) {
  const Floats d;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  for (int j = 0; j <= curve.samples; j += lanes) {
    auto sum = hn::Zero(d);
    for (int r = 0; r < curve.measurements; ++r)
      sum = hn::MulAdd(hn::Set(d, electrons[r]), hn::Load(d, curve.component(r) + j), sum);
    hn::Store(sum, d, scratch.match.data() + j);
  }
}

/// Best point of every chord: with u = Q11 b0 - Q01 b1 and v = Q00 b1 - Q01 b0 it lies at
/// t = v / (u + v) where both are > 0, else at the better end. Scores are S_j, -1 in the padding.
/// @return the largest
HWY_INLINE float score_chords(const DecodingCurve& curve, SoftDecoder::Scratch& scratch) {
  const Floats d;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const auto zero = hn::Zero(d), one = hn::Set(d, 1.0f), half = hn::Set(d, 0.5f);
  const auto least = hn::Set(d, smallest_square);
  auto largest = hn::Set(d, -1.0f);
  for (int j = 0; j < curve.samples; j += lanes) {
    const auto b0 = hn::Load(d, scratch.match.data() + j);
    const auto b1 = hn::LoadU(d, scratch.match.data() + j + 1);
    const auto q00 = hn::Add(hn::Load(d, curve.squares.data() + j), least);
    const auto q11 = hn::Add(hn::LoadU(d, curve.squares.data() + j + 1), least);
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
        hn::Max(least, hn::MulAdd(hn::Mul(q00, s), s, hn::MulAdd(hn::Mul(q11, t), t, cross)));
    const auto ratio = hn::Div(match, square);
    const auto in_range =
        hn::Lt(hn::Iota(d, static_cast<float>(j)), hn::Set(d, static_cast<float>(curve.samples)));
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

float decode_best(const DecodingCurve& curve, const float* electrons,
                  SoftDecoder::Scratch& scratch) {
  match_points(curve, electrons, scratch);
  const float largest = score_chords(curve, scratch);
  int best = 0;
  while (best + 1 < curve.samples && scratch.score[static_cast<std::size_t>(best)] != largest)
    ++best;
  return static_cast<float>(best) + scratch.place[static_cast<std::size_t>(best)];
}

/// What a vector of chords is off by.
template <typename V>
HWY_INLINE V chord_error(Floats d, V place, float true_bin, float samples, bool circular) {
  const auto distance = hn::Abs(hn::Sub(place, hn::Set(d, true_bin)));
  if (!circular) return distance;
  return hn::Min(distance, hn::Sub(hn::Set(d, samples), distance));
}

/// Shares of the chords (unnormalized) and their errors. Returns {sum of shares, sum of shares
/// times errors}.
HWY_INLINE void weigh_chords(const DecodingCurve& curve, const SoftQuestion& question,
                             float largest, SoftDecoder::Scratch& scratch, float* sums) {
  const Floats d;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const auto sharpness = hn::Set(d, static_cast<float>(question.sharpness));
  const auto shift = hn::Set(d, largest);
  auto total = hn::Zero(d), error_total = hn::Zero(d);
  for (int j = 0; j < curve.samples; j += lanes) {
    const auto index = hn::Iota(d, static_cast<float>(j));
    const auto place = hn::Add(index, hn::Load(d, scratch.place.data() + j));
    const auto error = chord_error(d, place, static_cast<float>(question.true_bin),
                                   static_cast<float>(curve.samples), question.circular);
    const auto exponent =
        hn::Max(hn::Set(d, -80.0f),
                hn::Mul(sharpness, hn::Sub(hn::Load(d, scratch.score.data() + j), shift)));
    const auto in_range = hn::Lt(index, hn::Set(d, static_cast<float>(curve.samples)));
    const auto share = hn::IfThenElseZero(in_range, hn::Exp(d, exponent));
    hn::Store(share, d, scratch.share.data() + j);
    hn::Store(error, d, scratch.error.data() + j);
    total = hn::Add(total, share);
    error_total = hn::MulAdd(share, error, error_total);
  }
  sums[0] = hn::GetLane(hn::SumOfLanes(d, total));
  sums[1] = hn::GetLane(hn::SumOfLanes(d, error_total));
}

/// Gradient of the expected error by the matches b_j of every chord's two ends (scratch) and, added
/// with its weight, by the squares and products of the curve.
HWY_INLINE void differentiate_chords(const DecodingCurve& curve, const SoftQuestion& question,
                                     float weight, float normalization, float expected,
                                     CurveGradient& gradient, SoftDecoder::Scratch& scratch) {
  const Floats d;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const auto one = hn::Set(d, 1.0f), half = hn::Set(d, 0.5f), zero = hn::Zero(d);
  const auto least = hn::Set(d, smallest_square);
  const auto samples = hn::Set(d, static_cast<float>(curve.samples));
  const auto truth = hn::Set(d, static_cast<float>(question.true_bin));
  const auto scale = hn::Set(d, weight);
  for (int j = 0; j < curve.samples; j += lanes) {
    const auto b0 = hn::Load(d, scratch.match.data() + j);
    const auto b1 = hn::LoadU(d, scratch.match.data() + j + 1);
    const auto q00 = hn::Add(hn::Load(d, curve.squares.data() + j), least);
    const auto q11 = hn::Add(hn::LoadU(d, curve.squares.data() + j + 1), least);
    const auto q01 = hn::Load(d, curve.products.data() + j);
    const auto t = hn::Load(d, scratch.place.data() + j);
    const auto s = hn::Sub(one, t);
    const auto share = hn::Mul(hn::Load(d, scratch.share.data() + j), hn::Set(d, normalization));

    // By the score: S = match^2 / (2 square), stationary in t where t is free.
    const auto by_score =
        hn::Mul(hn::Mul(hn::Set(d, static_cast<float>(question.sharpness)), share),
                hn::Sub(hn::Load(d, scratch.error.data() + j), hn::Set(d, expected)));
    const auto ratio = hn::Load(d, scratch.ratio.data() + j);
    const auto by_match = hn::Mul(by_score, ratio);
    const auto by_square = hn::Neg(hn::Mul(half, hn::Mul(by_match, ratio)));
    auto by_b0 = hn::Mul(by_match, s);
    auto by_b1 = hn::Mul(by_match, t);
    auto by_q00 = hn::Mul(hn::Mul(by_square, s), s);
    auto by_q11 = hn::Mul(hn::Mul(by_square, t), t);
    auto by_q01 = hn::Mul(hn::Mul(hn::Add(by_square, by_square), s), t);

    // By the place of the best point, t = v / (u + v).
    const auto from_truth = hn::Sub(hn::Add(hn::Iota(d, static_cast<float>(j)), t), truth);
    auto sign = hn::IfThenElse(hn::Gt(from_truth, zero), one, hn::Set(d, -1.0f));
    if (question.circular) {
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

    const auto add = [&](AlignedFloats& sum, auto value) {
      hn::Store(hn::MulAdd(scale, value, hn::Load(d, sum.data() + j)), d, sum.data() + j);
    };
    add(gradient.squares, by_q00);
    add(gradient.next_squares, by_q11);
    add(gradient.products, by_q01);
    hn::Store(by_b0, d, scratch.by_match.data() + j);
    hn::StoreU(by_b1, d, scratch.by_next_match.data() + j + 1);
  }
  // Padding lanes are zero: their share is. Point N is point 0.
  scratch.by_next_match[0] = scratch.by_next_match[static_cast<std::size_t>(curve.samples)];
}

/// From the matches b_j = <y, p_j> to the points, with the weight, and to y.
HWY_INLINE void differentiate_matches(const DecodingCurve& curve, const float* electrons,
                                      float weight, CurveGradient& gradient,
                                      SoftDecoder::Scratch& scratch, float* by_electrons) {
  const Floats d;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  for (int j = 0; j < curve.samples; j += lanes) {
    const auto sum = hn::Add(hn::Load(d, scratch.by_match.data() + j),
                             hn::Load(d, scratch.by_next_match.data() + j));
    const auto in_range =
        hn::Lt(hn::Iota(d, static_cast<float>(j)), hn::Set(d, static_cast<float>(curve.samples)));
    hn::Store(hn::IfThenElseZero(in_range, sum), d, scratch.by_match.data() + j);
  }
  for (int r = 0; r < curve.measurements; ++r) {
    float* HWY_RESTRICT by_points = gradient.points.data() + r * curve.stride;
    const float* HWY_RESTRICT points = curve.component(r);
    const auto electron = hn::Set(d, weight * electrons[r]);
    auto sum = hn::Zero(d);
    for (int j = 0; j < curve.samples; j += lanes) {
      const auto by_match = hn::Load(d, scratch.by_match.data() + j);
      sum = hn::MulAdd(by_match, hn::Load(d, points + j), sum);
      hn::Store(hn::MulAdd(by_match, electron, hn::Load(d, by_points + j)), d, by_points + j);
    }
    by_electrons[r] = hn::GetLane(hn::SumOfLanes(d, sum));
  }
}

/// @param gradient  null: the error alone
float soft_error(const DecodingCurve& curve, const float* electrons, const SoftQuestion& question,
                 float weight, CurveGradient* gradient, SoftDecoder::Scratch& scratch,
                 float* by_electrons) {
  match_points(curve, electrons, scratch);
  const float largest = score_chords(curve, scratch);
  float sums[2];
  weigh_chords(curve, question, largest, scratch, sums);
  const float expected = sums[1] / sums[0];
  if (!gradient) return expected;
  differentiate_chords(curve, question, weight, 1.0f / sums[0], expected, *gradient, scratch);
  differentiate_matches(curve, electrons, weight, *gradient, scratch, by_electrons);
  return expected;
}

}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tofsmith {

HWY_EXPORT(decode_best);
HWY_EXPORT(soft_error);

namespace {

constexpr int widest_vector = 16;

/// Whole vectors for N + 1 points, and one more for what reads a point ahead.
int padded_stride(int samples) {
  return (samples + 1 + widest_vector - 1) / widest_vector * widest_vector + widest_vector;
}

/// g_i of DecodingCurve.
Eigen::VectorXd relative_exposure(const SampledCamera& camera) {
  return camera.exposure_s() / camera.exposure_s().mean();
}

/// The unit vector along g o kappa; zeros where ambient light need not be reckoned with.
Eigen::VectorXd ambient_direction(const SampledCamera& camera, const MeasurementTable& table) {
  const Eigen::VectorXd ambient = relative_exposure(camera).cwiseProduct(table.ambient_gain);
  const double length = ambient.norm();
  if (!camera.ambient_unknown() || length == 0.0) return Eigen::VectorXd::Zero(ambient.size());
  return ambient / length;
}

}  // namespace

DecodingCurve::DecodingCurve(const SampledCamera& camera, const MeasurementTable& table)
    : samples(table.samples()), measurements(table.measurements()), stride(padded_stride(samples)) {
  const Eigen::VectorXd direction = ambient_direction(camera, table);
  exact_points = table.correlation * relative_exposure(camera).asDiagonal();
  exact_points -= (exact_points * direction) * direction.transpose();
  const auto size = static_cast<std::size_t>(stride);
  points.assign(size * static_cast<std::size_t>(measurements), 0.0f);
  squares.assign(size, 0.0f);
  products.assign(size, 0.0f);
  for (int j = 0; j <= samples; ++j) {
    const int at = j % samples, next = (at + 1) % samples;
    for (int r = 0; r < measurements; ++r)
      points[static_cast<std::size_t>(r * stride + j)] = static_cast<float>(exact_points(at, r));
    squares[static_cast<std::size_t>(j)] = static_cast<float>(exact_points.row(at).squaredNorm());
    products[static_cast<std::size_t>(j)] =
        static_cast<float>(exact_points.row(at).dot(exact_points.row(next)));
  }
}

CurveGradient::CurveGradient(const DecodingCurve& curve)
    : points(curve.points.size(), 0.0f),
      squares(curve.squares.size(), 0.0f),
      next_squares(curve.squares.size(), 0.0f),
      products(curve.squares.size(), 0.0f) {}

void CurveGradient::clear() {
  for (AlignedFloats* values : {&points, &squares, &next_squares, &products})
    std::fill(values->begin(), values->end(), 0.0f);
}

void CurveGradient::pull_back(const SampledCamera& camera, const MeasurementTable& table,
                              const DecodingCurve& curve, MeasurementTable& gradient) const {
  const int samples = curve.samples;
  Eigen::MatrixXd by_points(samples, curve.measurements);
  for (int j = 0; j < samples; ++j) {
    const auto at = static_cast<std::size_t>(j);
    const int next = (j + 1) % samples, last = (j + samples - 1) % samples;
    const double by_square = squares[at] + next_squares[static_cast<std::size_t>(last)];
    for (int r = 0; r < curve.measurements; ++r)
      by_points(j, r) = points[static_cast<std::size_t>(r * curve.stride + j)] +
                        2.0 * by_square * curve.exact_points(j, r) +
                        products[at] * curve.exact_points(next, r) +
                        products[static_cast<std::size_t>(last)] * curve.exact_points(last, r);
  }
  // p_j = x_j - a (a . x_j) / |a|^2, with a / |a| = n: by x_j it is P G_j; by a, it is
  // -sum_j [P G_j (n . x_j) + p_j (n . G_j)] / |a|.
  const Eigen::VectorXd exposure = relative_exposure(camera);
  const Eigen::VectorXd direction = ambient_direction(camera, table);
  const Eigen::VectorXd along = by_points * direction;
  by_points -= along * direction.transpose();
  gradient.correlation += by_points * exposure.asDiagonal();
  if (direction.isZero(0.0)) return;
  const Eigen::VectorXd curve_along = (table.correlation * exposure.asDiagonal()) * direction;
  const double length = exposure.cwiseProduct(table.ambient_gain).norm();
  const Eigen::VectorXd by_ambient =
      -(by_points.transpose() * curve_along + curve.exact_points.transpose() * along) / length;
  gradient.ambient_gain += by_ambient.cwiseProduct(exposure);
}

SoftDecoder::Scratch::Scratch(int stride) {
  for (AlignedFloats* values :
       {&match, &ratio, &score, &place, &free, &share, &error, &by_match, &by_next_match})
    values->assign(static_cast<std::size_t>(stride), 0.0f);
}

SoftDecoder::SoftDecoder(const DecodingCurve& curve) : scratch_(curve.stride) {}

double SoftDecoder::decode(const DecodingCurve& curve, const float* electrons) {
  return HWY_DYNAMIC_DISPATCH(decode_best)(curve, electrons, scratch_);
}

double SoftDecoder::expected_error(const DecodingCurve& curve, const float* electrons,
                                   const SoftQuestion& question) {
  return HWY_DYNAMIC_DISPATCH(soft_error)(curve, electrons, question, 0.0f, nullptr, scratch_,
                                          nullptr);
}

double SoftDecoder::expected_error(const DecodingCurve& curve, const float* electrons,
                                   const SoftQuestion& question, float weight,
                                   CurveGradient& gradient, float* by_electrons) {
  return HWY_DYNAMIC_DISPATCH(soft_error)(curve, electrons, question, weight, &gradient, scratch_,
                                          by_electrons);
}

}  // namespace tofsmith
#endif

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/optimize/soft_two_return_decoder.hpp"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "design/optimize/soft_two_return_decoder.cpp"
#include <hwy/foreach_target.h>
// Highway requires its headers after foreach_target.
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "core/shared/vectors-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {
using Pairs = SoftTwoReturnDecoder::Pairs;

/// Computes strengths and scores of all pairs (-1 in the padding); returns the largest score.
float score_all_pairs(Pairs& pairs) {
  constexpr float min_square = 1e-10f;      // of pairs whose points cancel
  constexpr float min_determinant = 1e-6f;  // relative; closer pairs are one return
  const Floats d;
  const int lanes = lanes_of(d);
  const auto zero = hn::Zero(d), one = hn::Set(d, 1.0f), half = hn::Set(d, 0.5f);
  const auto bins = hn::Set(d, static_cast<float>(pairs.bins));
  auto largest = hn::Set(d, -1.0f);
  for (int delay = pairs.delays.shortest; delay <= pairs.delays.longest; ++delay) {
    const std::size_t at = pairs.of(delay);
    for (int j = 0; j < pairs.bins; j += lanes) {
      const std::size_t pair = at + static_cast<std::size_t>(j);
      const auto b1 = hn::Load(d, pairs.match.data() + j);
      const auto b2 = hn::LoadU(d, pairs.match.data() + j + delay);
      const auto q11 = hn::Load(d, pairs.squares.data() + j);
      const auto q22 = hn::LoadU(d, pairs.squares.data() + j + delay);
      const auto q12 = hn::Load(d, pairs.products.data() + pair);
      const auto square = hn::Mul(q11, q22);
      const auto inverse = hn::Div(one, hn::Max(hn::NegMulAdd(q12, q12, square),
                                                hn::MulAdd(hn::Set(d, min_determinant), square,
                                                           hn::Set(d, min_square * min_square))));
      const auto free1 = hn::Mul(inverse, hn::NegMulAdd(q12, b2, hn::Mul(q22, b1)));
      const auto free2 = hn::Mul(inverse, hn::NegMulAdd(q12, b1, hn::Mul(q11, b2)));
      // If free strengths violate s1 >= s2 >= 0, the optimum has s2 = 0 or s1 = s2.
      const auto match = hn::Max(hn::Add(b1, b2), zero), match1 = hn::Max(b1, zero);
      const auto alone = hn::Div(match1, q11);
      const auto equal = hn::Div(
          match, hn::Max(hn::Add(hn::Add(q11, q22), hn::Add(q12, q12)), hn::Set(d, min_square)));
      const auto in_order = hn::And(hn::Ge(free2, zero), hn::Ge(free1, free2));
      const auto are_equal = hn::Gt(hn::Mul(equal, match), hn::Mul(alone, match1));
      const auto s1 = hn::IfThenElse(in_order, free1, hn::IfThenElse(are_equal, equal, alone));
      const auto s2 = hn::IfThenElse(in_order, free2, hn::IfThenElse(are_equal, equal, zero));
      const auto direct =
          hn::Mul(s1, hn::NegMulAdd(s2, q12, hn::NegMulAdd(hn::Mul(half, s1), q11, b1)));
      const auto both = hn::MulAdd(s2, hn::NegMulAdd(hn::Mul(half, s2), q22, b2), direct);
      const auto in_range = hn::Lt(hn::Iota(d, static_cast<float>(j)), bins);
      const auto score = hn::IfThenElse(in_range, both, hn::Set(d, -1.0f));
      hn::Store(s1, d, pairs.strength.data() + pair);
      hn::Store(s2, d, pairs.later.data() + pair);
      hn::Store(score, d, pairs.score.data() + pair);
      largest = hn::Max(largest, score);
    }
  }
  return hn::GetLane(hn::MaxOfLanes(d, largest));
}

void weigh_all_pairs(float sharpness, float largest, Pairs& pairs) {
  const Floats d;
  const int lanes = lanes_of(d);
  const auto shift = hn::Set(d, largest), scale = hn::Set(d, sharpness);
  const auto bins = hn::Set(d, static_cast<float>(pairs.bins));
  std::fill(pairs.row.begin(), pairs.row.end(), 0.0f);
  for (int delay = pairs.delays.shortest; delay <= pairs.delays.longest; ++delay) {
    const std::size_t at = pairs.of(delay);
    for (int j = 0; j < pairs.bins; j += lanes) {
      const std::size_t pair = at + static_cast<std::size_t>(j);
      const auto exponent =
          hn::Max(hn::Set(d, -80.0f),
                  hn::Mul(scale, hn::Sub(hn::Load(d, pairs.score.data() + pair), shift)));
      const auto in_range = hn::Lt(hn::Iota(d, static_cast<float>(j)), bins);
      const auto share = hn::IfThenElseZero(in_range, hn::Exp(d, exponent));
      hn::Store(share, d, pairs.share.data() + pair);
      hn::Store(hn::Add(share, hn::Load(d, pairs.row.data() + j)), d, pairs.row.data() + j);
    }
  }
}

template <typename V>
HWY_INLINE void add_to(Floats d, V value, float* values) {
  hn::StoreU(hn::Add(hn::LoadU(d, values), value), d, values);
}

/// Gradient w.r.t. matches and, weighted, w.r.t. squares and products. pairs.row is the derivative
/// of the expected error w.r.t. the scores of each bin, divided by the weight of the pair.
void differentiate_all_pairs(float weight, Pairs& pairs) {
  const Floats d;
  const int lanes = lanes_of(d);
  const auto scale = hn::Set(d, weight), half = hn::Set(d, -0.5f * weight);
  std::fill(pairs.by_match.begin(), pairs.by_match.end(), 0.0f);
  for (int delay = pairs.delays.shortest; delay <= pairs.delays.longest; ++delay) {
    const std::size_t at = pairs.of(delay);
    for (int j = 0; j < pairs.bins; j += lanes) {
      const std::size_t pair = at + static_cast<std::size_t>(j);
      const auto s1 = hn::Load(d, pairs.strength.data() + pair);
      const auto s2 = hn::Load(d, pairs.later.data() + pair);
      // Scores are stationary in free strengths; others are constant.
      const auto by_score =
          hn::Mul(hn::Load(d, pairs.share.data() + pair), hn::Load(d, pairs.row.data() + j));
      const auto direct = hn::Mul(by_score, s1), later = hn::Mul(by_score, s2);
      add_to(d, direct, pairs.by_match.data() + j);
      add_to(d, later, pairs.by_match.data() + j + delay);
      add_to(d, hn::Mul(half, hn::Mul(direct, s1)), pairs.by_squares.data() + j);
      add_to(d, hn::Mul(half, hn::Mul(later, s2)), pairs.by_squares.data() + j + delay);
      add_to(d, hn::Neg(hn::Mul(scale, hn::Mul(direct, s2))), pairs.by_products.data() + pair);
    }
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tofsmith {

HWY_EXPORT(score_all_pairs);
HWY_EXPORT(weigh_all_pairs);
HWY_EXPORT(differentiate_all_pairs);

namespace {

Eigen::MatrixXf points_on_grid(const DecodingCurve& curve, int step) {
  Eigen::MatrixXf points(curve.samples / step, curve.measurements);
  for (Eigen::Index j = 0; j < points.rows(); ++j)
    points.row(j) = curve.exact_points.row(j * step).cast<float>();
  return points;
}

void repeat(const Eigen::VectorXf& values, AlignedFloats& twice) {
  std::copy(values.begin(), values.end(), twice.begin());
  std::copy(values.begin(), values.end(), twice.begin() + values.size());
}

}  // namespace

SoftTwoReturnDecoder::Pairs::Pairs(int bin_count, DelayBins delay_bins)
    : bins(bin_count), delays(delay_bins), stride(whole_vectors(bin_count)) {
  const auto one = static_cast<std::size_t>(stride);
  const std::size_t all = one * static_cast<std::size_t>(delays.longest - delays.shortest + 1);
  for (AlignedFloats* values : {&squares, &match, &by_match, &by_squares})
    values->assign(2 * one, 0.0f);
  for (AlignedFloats* values : {&products, &strength, &later, &score, &share, &by_products})
    values->assign(all, 0.0f);
  for (AlignedFloats* values : {&row, &error}) values->assign(one, 0.0f);
}

SoftTwoReturnDecoder::SoftTwoReturnDecoder(const DecodingCurve& curve, int step, DelayBins delays)
    : step_(step),
      curve_stride_(curve.stride),
      points_(points_on_grid(curve, step)),
      pairs_(curve.samples / step, delays),
      by_points_(Eigen::MatrixXf::Zero(points_.rows(), points_.cols())) {
  constexpr float min_square = 1e-10f;
  repeat((points_.rowwise().squaredNorm().array() + min_square).matrix(), pairs_.squares);
  const Eigen::MatrixXf gram = points_ * points_.transpose();
  for (int delay = delays.shortest; delay <= delays.longest; ++delay)
    for (int j = 0; j < pairs_.bins; ++j)
      pairs_.products[pairs_.of(delay) + static_cast<std::size_t>(j)] =
          gram(j, (j + delay) % pairs_.bins);
}

void SoftTwoReturnDecoder::set_match(const float* electrons) {
  const Eigen::Map<const Eigen::VectorXf> y(electrons, points_.cols());
  repeat(points_ * y, pairs_.match);
}

double SoftTwoReturnDecoder::decode(const float* electrons) {
  set_match(electrons);
  const float largest = HWY_DYNAMIC_DISPATCH(score_all_pairs)(pairs_);
  const auto best = std::find(pairs_.score.begin(), pairs_.score.end(), largest);
  return static_cast<double>((best - pairs_.score.begin()) % pairs_.stride) * step_;
}

SoftTwoReturnDecoder::Shares SoftTwoReturnDecoder::weigh(const float* electrons,
                                                         const SoftQuestion& question) {
  set_match(electrons);
  const float largest = HWY_DYNAMIC_DISPATCH(score_all_pairs)(pairs_);
  HWY_DYNAMIC_DISPATCH(weigh_all_pairs)(static_cast<float>(question.sharpness), largest, pairs_);
  const double samples = static_cast<double>(pairs_.bins) * step_;
  double total = 0.0, error_total = 0.0;
  for (int j = 0; j < pairs_.bins; ++j) {
    const auto bin = static_cast<std::size_t>(j);
    const double distance = std::abs(static_cast<double>(j) * step_ - question.true_bin);
    const double error = std::min(distance, samples - distance);
    pairs_.error[bin] = static_cast<float>(error);
    total += pairs_.row[bin];
    error_total += pairs_.row[bin] * error;
  }
  return {total, error_total / total};
}

double SoftTwoReturnDecoder::expected_error(const float* electrons, const SoftQuestion& question,
                                            float weight, float* by_electrons) {
  const auto [total, expected] = weigh(electrons, question);
  if (!by_electrons) return expected;
  const auto by_share = static_cast<float>(question.sharpness / total);
  for (std::size_t j = 0; j < pairs_.row.size(); ++j)
    pairs_.row[j] = by_share * (pairs_.error[j] - static_cast<float>(expected));
  HWY_DYNAMIC_DISPATCH(differentiate_all_pairs)(weight, pairs_);
  const Eigen::Map<const Eigen::VectorXf> twice(pairs_.by_match.data(), 2 * pairs_.bins);
  const Eigen::VectorXf by_match = twice.head(pairs_.bins) + twice.tail(pairs_.bins);
  const Eigen::Map<const Eigen::VectorXf> y(electrons, points_.cols());
  Eigen::Map<Eigen::VectorXf>(by_electrons, points_.cols()) = points_.transpose() * by_match;
  by_points_ += weight * by_match * y.transpose();
  return expected;
}

void SoftTwoReturnDecoder::pull_back(CurveGradient& gradient) const {
  const int bins = pairs_.bins;
  const Eigen::Map<const Eigen::VectorXf> twice(pairs_.by_squares.data(), 2 * bins);
  const Eigen::VectorXf by_squares = twice.head(bins) + twice.tail(bins);
  Eigen::MatrixXf by_points = by_points_;
  by_points += 2.0f * (by_squares.asDiagonal() * points_);
  for (int delay = pairs_.delays.shortest; delay <= pairs_.delays.longest; ++delay)
    for (int j = 0; j < bins; ++j) {
      const int k = (j + delay) % bins;
      const float by_product = pairs_.by_products[pairs_.of(delay) + static_cast<std::size_t>(j)];
      by_points.row(j) += by_product * points_.row(k);
      by_points.row(k) += by_product * points_.row(j);
    }
  for (Eigen::Index r = 0; r < points_.cols(); ++r)
    for (int j = 0; j < bins; ++j)
      gradient.points[static_cast<std::size_t>(r * curve_stride_ + j * step_)] += by_points(j, r);
}

}  // namespace tofsmith
#endif

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/output/lobe_posterior.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "decode/ambient_projection.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "decode/output/lobe_posterior.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "decode/output/shared/output_vectors-inl.hpp"

#ifndef TOFSMITH_DECODE_OUTPUT_LOBE_SUM
#define TOFSMITH_DECODE_OUTPUT_LOBE_SUM
namespace tofsmith {

/// Inputs of the sum over the nodes of a curve.
struct LobeSum {
  const LobePosterior::Nodes* nodes;
  int rank;
  const float* along;   ///< C^-1 q (rank)
  const float* metric;  ///< C^-1: lower triangle row by row, off-diagonal entries doubled
  float samples;
  float centre, half_width;  ///< of the main lobe [place]
};

}  // namespace tofsmith
#endif

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {

constexpr int nodes_per_chunk = 1024;

/// Without vectors, hn::Round() rounds half-way cases differently.
HWY_INLINE Vector nearest(Vector x) { return hn::Floor(hn::Add(x, all(0.5f))); }

/// Returns exp(x) for -80 <= x <= 0 with a relative error of 2e-7.
HWY_INLINE Vector exp_of(Vector x) {
  const Indices di;
  const Vector power = hn::Mul(hn::Max(x, all(-80.0f)), all(1.44269504f));
  const Vector whole = nearest(power), rest = hn::Sub(power, whole);
  Vector series = product_plus(rest, all(1.54035304e-4f), all(1.33335581e-3f));
  series = product_plus(rest, series, all(9.61812911e-3f));
  series = product_plus(rest, series, all(5.55041087e-2f));
  series = product_plus(rest, series, all(0.240226507f));
  series = product_plus(rest, series, all(0.693147181f));
  series = product_plus(rest, series, all(1.0f));
  const auto exponent = hn::Add(hn::ConvertTo(di, whole), hn::Set(di, 127));
  return hn::Mul(series, hn::BitCast(Floats(), hn::ShiftLeft<23>(exponent)));
}

/// Returns p(z) exp(-peak) for signals c in standard deviations with an error of 0.5 %: a rational
/// function of -c for c < 0, and for c >= 0, with h rational and h(c) -> 1 / c,
///   ln 10 + sqrt(2 pi) h(c) exp(c^2 / 2).
/// @param no_light  exp(-peak)
HWY_INLINE Vector density(Vector c, Vector peak, Vector no_light) {
  const Floats d;
  const Vector above = hn::Max(c, hn::Zero(d));
  Vector top = product_plus(above, all(0.147033687f), all(-0.519655376f));
  top = product_plus(above, top, all(1.14880103f));
  top = product_plus(above, top, all(0.0604626321f));
  Vector bottom = product_plus(above, all(0.05865796f), all(-0.21910124f));
  bottom = product_plus(above, bottom, all(0.59510042f));
  bottom = product_plus(above, bottom, all(-0.76033963f));
  bottom = product_plus(above, bottom, all(1.0f));
  const Vector exponent = hn::Sub(hn::Mul(hn::Mul(above, above), all(0.5f)), peak);
  const Vector lit =
      product_plus(hn::Div(top, bottom), exp_of(exponent), hn::Mul(no_light, all(2.30258509f)));

  const Vector below = hn::Min(hn::Sub(hn::Zero(d), c), all(30.0f));
  Vector fall = product_plus(below, all(1.54977e-3f), all(1.445549e-2f));
  fall = product_plus(below, fall, all(0.4700333f));
  fall = product_plus(below, fall, all(1.0f));
  const Vector dark = hn::Div(product_plus(below, all(-0.0490053f), all(2.3647778f)), fall);
  return hn::IfThenElse(hn::Lt(c, hn::Zero(d)), hn::Mul(dark, no_light), lit);
}

HWY_INLINE float find_signals(const LobeSum& sum, int first, int count, float* signal) {
  const Floats d;
  const int stride = sum.nodes->stride;
  const float* const direction = sum.nodes->direction.data() + first;
  Vector largest = hn::Zero(d);
  for (int i = 0; i < count; i += lanes_of(d)) {
    Vector along = hn::Zero(d), square = hn::Zero(d);
    const float* metric = sum.metric;
    for (int j = 0; j < sum.rank; ++j) {
      const Vector u = load(direction + static_cast<std::ptrdiff_t>(j) * stride, i);
      along = product_plus(u, all(sum.along[j]), along);
      Vector row = hn::Mul(u, all(metric[j]));
      for (int k = 0; k < j; ++k)
        row = product_plus(load(direction + static_cast<std::ptrdiff_t>(k) * stride, i),
                           all(metric[k]), row);
      square = product_plus(u, row, square);
      metric += j + 1;
    }
    const Vector c = hn::Div(along, hn::Sqrt(hn::Max(square, all(1e-30f))));
    hn::StoreU(c, d, signal + i);
    largest = hn::Max(largest, c);
  }
  return hn::GetLane(hn::MaxOfLanes(d, largest));
}

float node_signals(const LobeSum& sum, float* signal) {
  float largest = 0.0f;
  for (int first = 0; first < sum.nodes->stride; first += nodes_per_chunk)
    largest = std::max(
        largest, find_signals(sum, first, std::min(nodes_per_chunk, sum.nodes->stride - first),
                              signal + first));
  return largest;
}

template <int Rank>
HWY_INLINE bool leads_of_rank(const LobePosterior::Nodes& nodes, int any_rank, const float* plane,
                              float samples, float centre, float half_width, float limit) {
  const Floats d;
  const int rank = Rank > 0 ? Rank : any_rank;
  const Vector all_samples = all(samples), per_turn = hn::Div(all(1.0f), all_samples);
  for (int i = 0; i < nodes.stride; i += lanes_of(d)) {
    Vector score = hn::Zero(d);
    for (int j = 0; j < rank; ++j)
      score = product_plus(
          load(nodes.direction.data() + static_cast<std::ptrdiff_t>(j) * nodes.stride, i),
          all(plane[j]), score);
    const Mask is_high = hn::Gt(score, all(limit));
    if (hn::AllFalse(d, is_high)) continue;
    Vector away = hn::Sub(load(nodes.centre.data(), i), all(centre));
    away = hn::Abs(hn::Sub(away, hn::Mul(all_samples, nearest(hn::Mul(away, per_turn)))));
    const Vector end = product_plus(load(nodes.width.data(), i), all(0.5f), away);
    if (!hn::AllFalse(d, hn::And(is_high, hn::Gt(end, all(half_width))))) return false;
  }
  return true;
}

/// Returns true if no node outside the main lobe scores more than `limit`.
bool leads(const LobePosterior::Nodes& nodes, int rank, const float* plane, float samples,
           float centre, float half_width, float limit) {
  switch (rank) {
    case 2:
      return leads_of_rank<2>(nodes, rank, plane, samples, centre, half_width, limit);
    case 3:
      return leads_of_rank<3>(nodes, rank, plane, samples, centre, half_width, limit);
    case 4:
      return leads_of_rank<4>(nodes, rank, plane, samples, centre, half_width, limit);
    default:
      return leads_of_rank<0>(nodes, rank, plane, samples, centre, half_width, limit);
  }
}

struct LobeMass {
  alignas(64) float inside[nodes_per_block] = {};
  alignas(64) float outside[nodes_per_block] = {};

  void scale(float by) {
    for (float& mass : inside) mass *= by;
    for (float& mass : outside) mass *= by;
  }
};

/// Adds nodes relative to exp(peak).
HWY_INLINE void add_nodes(const LobeSum& sum, int first, int count, const float* signal, float peak,
                          LobeMass& mass) {
  constexpr float negligible = 30.0f;
  const Floats d;
  const bool skips = peak > negligible;
  const auto no_light = all(static_cast<float>(std::exp(-static_cast<double>(peak))));
  const Vector samples = all(sum.samples), per_turn = hn::Div(all(1.0f), samples);
  const Vector least = all(std::sqrt(2 * std::max(peak - negligible, 0.0f)));
  const float* const centre = sum.nodes->centre.data() + first;
  const float* const width = sum.nodes->width.data() + first;
  for (int i = 0; i < count; i += lanes_of(d)) {
    const Vector c = load(signal, i);
    const Mask counts = hn::Ge(c, least);
    if (skips && hn::AllFalse(d, counts)) continue;
    Vector w = load(width, i);
    if (skips) w = hn::IfThenElseZero(counts, w);
    Vector away = hn::Sub(load(centre, i), all(sum.centre));
    away = hn::Abs(hn::Sub(away, hn::Mul(samples, nearest(hn::Mul(away, per_turn)))));
    // Part of the node that lies inside the lobe.
    const Vector share = hn::Div(hn::Sub(all(sum.half_width), away), hn::Max(w, all(1e-6f)));
    const Vector within = hn::Min(hn::Max(hn::Add(share, all(0.5f)), hn::Zero(d)), all(1.0f));
    const Vector whole = hn::Mul(density(c, all(peak), no_light), w);
    const Vector inside = hn::Mul(whole, within);
    float* const to_inside = mass.inside + i % nodes_per_block;
    float* const to_outside = mass.outside + i % nodes_per_block;
    hn::StoreU(hn::Add(load(to_inside, 0), inside), d, to_inside);
    hn::StoreU(hn::Add(load(to_outside, 0), hn::Sub(whole, inside)), d, to_outside);
  }
}

double lobe_share(const LobeSum& sum) {
  alignas(64) float signal[nodes_per_chunk];
  LobeMass mass;
  float peak = 0.0f;
  for (int first = 0; first < sum.nodes->stride; first += nodes_per_chunk) {
    const int count = std::min(nodes_per_chunk, sum.nodes->stride - first);
    const float largest = find_signals(sum, first, count, signal);
    const float here = 0.5f * largest * largest;
    if (here > peak) {
      mass.scale(static_cast<float>(std::exp(static_cast<double>(peak) - here)));
      peak = here;
    }
    add_nodes(sum, first, count, signal, peak, mass);
  }
  double inside = 0.0, outside = 0.0;
  for (const float part : mass.inside) inside += part;
  for (const float part : mass.outside) outside += part;
  return inside / (inside + outside);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tofsmith {

HWY_EXPORT(leads);
HWY_EXPORT(lobe_share);
HWY_EXPORT(node_signals);

namespace {

/// Maximum step [standard deviations] for a sum to approximate the integral of a Gaussian to 1e-5.
constexpr double max_step_deviations = 1.25;

struct SumInput {
  SumInput(const NoiseMetric& noise, int rank) {
    for (int i = 0, at = 0; i < rank; ++i) {
      along[static_cast<std::size_t>(i)] = static_cast<float>(noise.along()[i]);
      for (int j = 0; j <= i; ++j, ++at)
        metric[static_cast<std::size_t>(at)] =
            static_cast<float>((i == j ? 1.0 : 2.0) * noise.metric()[at]);
    }
  }
  std::array<float, max_measurements> along;
  std::array<float, NoiseMetric::max_pairs> metric;
};

}  // namespace

double typical_variance(const Eigen::MatrixXd& noise_basis, const Eigen::VectorXd& variance) {
  const Eigen::MatrixXd covariance = noise_basis.transpose() * variance.asDiagonal() * noise_basis;
  const auto rank = static_cast<double>(covariance.rows());
  const double mean = covariance.trace() / rank;
  const double square = covariance.squaredNorm() / rank;
  return mean + 0.5 * std::sqrt(std::max(0.0, square - mean * mean));
}

float LobePosterior::score_beside(const float* plane, float score, std::int32_t row) const {
  for (std::int32_t after = 1 - places_per_row_; after < places_per_row_; ++after) {
    if (after == 0) continue;
    const double* unit = unit_.row((row * places_per_row_ + after + places_) % places_).data();
    float here = 0.0f;
    for (int j = 0; j < rank_; ++j) here += plane[j] * static_cast<float>(unit[j]);
    score = std::max(score, here);
  }
  return score;
}

bool LobePosterior::is_sure(const float* plane, float score, float least_lead_e2,
                            std::int32_t row) const {
  const float best = score_beside(plane, score, row);
  const float square = best * best - least_lead_e2;
  if (!(best > 0.0f) || !(square > 0.0f)) return false;
  const Lobe& own = lobe(row);
  const auto leads_by = [&](const Nodes& nodes, float limit) {
    return HWY_DYNAMIC_DISPATCH(leads)(
        nodes, rank_, plane, static_cast<float>(places_),
        static_cast<float>(row * places_per_row_ + 0.5 * (own.right - own.left)),
        static_cast<float>(0.5 * (own.left + own.right + 1)), limit);
  };
  // A place half a step from a node scores at most `limit` if the node scores at most
  // |q| cos(arccos(limit / |q|) + step / 2).
  const float limit = std::sqrt(square);
  float across2 = -square;
  for (int j = 0; j < rank_; ++j) across2 += plane[j] * plane[j];
  constexpr float sparse_turn = 0.5f * static_cast<float>(sparse_step_rad);
  if (leads_by(sparse_, limit * std::cos(sparse_turn) -
                            std::sqrt(std::max(across2, 0.0f)) * std::sin(sparse_turn)))
    return true;
  // Between close nodes the score exceeds both nodes' by at most a factor of 1 / cos(step / 2).
  constexpr auto between = static_cast<float>(1.0 - 0.125 * coarse_step_rad * coarse_step_rad);
  return leads_by(coarse_, limit * between);
}

bool LobePosterior::is_certain(const double* plane, const double* variance_e2,
                               std::int32_t row) const {
  std::array<float, max_measurements> q;
  std::transform(plane, plane + rank_, q.begin(),
                 [](double value) { return static_cast<float>(value); });
  const double* unit = unit_.row(row * places_per_row_).data();
  double score = 0.0, square = 0.0;
  for (int j = 0; j < rank_; ++j) {
    score += plane[j] * unit[j];
    square += plane[j] * plane[j];
  }
  const double least =
      sure_lead * typical_variance(noise_basis_, Eigen::Map<const Eigen::VectorXd>(
                                                     variance_e2, noise_basis_.rows()));
  const double across2 = std::max(0.0, square - score * score);
  const double other = score * bound(row).cosine + std::sqrt(across2) * bound(row).sine;
  if (other < score && score * score - other * other >= least) return true;
  return is_sure(q.data(), static_cast<float>(score), static_cast<float>(least), row);
}

double LobePosterior::probability(const double* plane, const double* variance_e2,
                                  std::int32_t row) const {
  return share_of(lobe_window(row), NoiseMetric(noise_basis_, plane, variance_e2));
}

std::optional<double> LobePosterior::confidence(const double* plane, const double* variance_e2,
                                                std::int32_t row, const RangePart* part) const {
  constexpr double surely_outside = 0.9;
  if (is_certain(plane, variance_e2, row)) return 1.0;
  if (!part || part->is_whole()) return probability(plane, variance_e2, row);
  const NoiseMetric noise(noise_basis_, plane, variance_e2);
  const Window allowed = window_of(*part);
  const double inside = share_of(allowed, noise), outside = outside_prior * (1.0 - inside);
  if (outside >= surely_outside * (inside + outside)) return std::nullopt;
  return std::min(1.0, share_of(lobe_within(row, allowed), noise) / (inside + outside));
}

double LobePosterior::share_of(const Window& window, const NoiseMetric& noise) const {
  for (const Nodes* nodes : {&coarse_, &fine_})
    if (noise.length() * nodes->step <= max_step_deviations)
      return sum_over_nodes(*nodes, noise, window);
  return sum_over_chords(noise, window);
}

double LobePosterior::sum_over_nodes(const Nodes& nodes, const NoiseMetric& noise,
                                     const Window& window) const {
  const SumInput input(noise, rank_);
  return HWY_DYNAMIC_DISPATCH(lobe_share)(
      {.nodes = &nodes,
       .rank = rank_,
       .along = input.along.data(),
       .metric = input.metric.data(),
       .samples = static_cast<float>(places_),
       .centre = static_cast<float>(window.begin + 0.5 * window.length),
       .half_width = static_cast<float>(0.5 * (window.length + 1))});
}

/// In bright light the density consists of a few narrow peaks on chords. Chords are skipped if the
/// signals of nodes prove them negligible.
double LobePosterior::sum_over_chords(const NoiseMetric& noise, const Window& window) const {
  constexpr double negligible = 40.0;
  const SumInput input(noise, rank_);
  thread_local std::vector<float> signal;
  signal.resize(static_cast<std::size_t>(coarse_.stride));
  const float largest = HWY_DYNAMIC_DISPATCH(node_signals)({.nodes = &coarse_,
                                                            .rank = rank_,
                                                            .along = input.along.data(),
                                                            .metric = input.metric.data()},
                                                           signal.data());
  const double least2 = std::max(0.0, static_cast<double>(largest) * largest - 2 * negligible);
  const double away = std::acos(std::min(1.0, std::sqrt(least2) / noise.length())) +
                      0.5 * coarse_.step * noise.stretch();
  const double least = away < std::numbers::pi ? noise.length() * std::cos(away)
                                               : -std::numeric_limits<double>::infinity();

  ChordMass mass;
  const auto add = [&](std::int32_t n) {
    const std::int32_t next = n + 1 < places_ ? n + 1 : 0;
    const double *u = unit_.row(n).data(), *w = unit_.row(next).data();
    const double from_length = std::sqrt(noise.product(u, u));
    const double to_length = std::sqrt(noise.product(w, w));
    const double from = from_length > 0.0 ? noise.signal(u) / from_length : 0.0;
    const double to = to_length > 0.0 ? noise.signal(w) / to_length : 0.0;
    const bool is_inside = (n - window.begin + places_) % places_ < window.length;
    if (std::isinf(turn_rad_[n]))
      mass.add_ends(from, to, is_inside);
    else
      mass.add_chord(from, to, noise.product(u, w) / (from_length * to_length), is_inside);
  };
  const auto begin_of = [&](std::size_t i) {
    return static_cast<std::int32_t>(std::floor(coarse_.centre[i] - 0.5f * coarse_.width[i])) - 1;
  };
  // Stop before the first chord of the cyclic range is added again.
  std::int32_t next = begin_of(0), end_of_all = std::numeric_limits<std::int32_t>::max();
  for (std::size_t i = 0; i < static_cast<std::size_t>(coarse_.count); ++i) {
    if (signal[i] < least) continue;
    const std::int32_t begin = std::max(begin_of(i), next);
    const auto end =
        static_cast<std::int32_t>(std::ceil(coarse_.centre[i] + 0.5f * coarse_.width[i])) + 1;
    end_of_all = std::min(end_of_all, begin + places_);
    for (next = begin; next < std::min(end, end_of_all); ++next) add((next + places_) % places_);
  }
  return mass.share_inside();
}

}  // namespace tofsmith
#endif

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/multipath/multipath_search.hpp"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "decode/multipath/multipath_search.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "decode/multipath/multipath_fit-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {

constexpr int max_coarse = 240;
constexpr int max_starts = 3;
constexpr int max_single_steps = 6, max_pair_steps = 14;

/// Whitened coarse points, with <g, g> and <g, target>.
struct CoarsePoints {
  alignas(64) Row point[max_coarse * max_span];
  alignas(64) Row own[max_coarse];
  alignas(64) Row along[max_coarse];

  template <int Span>
  HWY_INLINE void make(const MultipathCurve& curve, const std::vector<float>& table,
                       const White& white) {
    const int span = curve.span;
    for (int j = 0; j < curve.coarse; ++j) {
      Row* row = point + j * span;
      white.whiten(table.data() + j * span, row);
      store(dot<Span>(row, row, span), own[j]);
      store(dot<Span>(row, white.target, span), along[j]);
    }
  }
};

/// Returns the part of |target|^2 that a pair explains; 0 if one return is as good.
HWY_INLINE Vector pair_score(Vector b1, Vector b2, Vector g11, Vector g12, Vector g22) {
  const Vector zero = hn::Zero(Floats());
  const Vector det = hn::MulSub(g11, g22, hn::Mul(g12, g12));
  const Vector n1 = hn::MulSub(g22, b1, hn::Mul(g12, b2));
  const Vector n2 = hn::MulSub(g11, b2, hn::Mul(g12, b1));
  const Vector sum = hn::Max(hn::Add(b1, b2), zero);
  const Mask are_equal = hn::Gt(n2, n1);
  const Vector both = hn::Add(hn::Add(g11, g22), hn::Add(g12, g12));
  const Vector top = choose(are_equal, hn::Mul(sum, sum), hn::MulAdd(n1, b1, hn::Mul(n2, b2)));
  // Nearly equal places do not count as two.
  const Vector apart = hn::Max(det, hn::Mul(all(1e-5f), hn::Mul(g11, g22)));
  const Vector below = hn::Add(choose(are_equal, both, apart), all(1e-30f));
  return hn::IfThenElseZero(hn::Gt(hn::Max(n1, n2), zero),
                            hn::IfThenElseZero(hn::Ge(n2, zero), hn::Div(top, below)));
}

/// The highest local maxima of the scores.
struct Starts {
  alignas(64) Row score[max_starts], place[max_starts], lag[max_starts];

  HWY_INLINE Starts() {
    for (int i = 0; i < max_starts; ++i) {
      store(all(-1.0f), score[i]);
      store(hn::Zero(Floats()), place[i]);
      store(all(1.0f), lag[i]);
    }
  }
  HWY_INLINE void add(Mask is_top, Vector value, int at, Vector by) {
    Vector v = choose(is_top, value, all(-1.0f)), p = all(static_cast<float>(at)), l = by;
    for (int i = 0; i < max_starts; ++i) {
      const Vector s = load(score[i]), q = load(place[i]), m = load(lag[i]);
      const Mask above = hn::Gt(v, s);
      store(choose(above, v, s), score[i]);
      store(choose(above, p, q), place[i]);
      store(choose(above, l, m), lag[i]);
      v = choose(above, s, v), p = choose(above, q, p), l = choose(above, m, l);
    }
  }
};

template <Fitted What, int Span>
HWY_INLINE void score_coarse(const MultipathCurve& curve, const DelayBounds& delays,
                             const CoarsePoints& direct, const CoarsePoints& behind, Row* best,
                             Row* best_lag) {
  const int span = curve.span, coarse = curve.coarse;
  const float step = static_cast<float>(curve.points) / static_cast<float>(coarse);
  const int least = std::max(1, static_cast<int>(std::ceil(delays.shortest / step)));
  const int most = std::clamp(static_cast<int>(delays.longest / step), least, coarse - 1);
  for (int j = 0; j < coarse; ++j) {
    const Vector g11 = load(direct.own[j]), b1 = load(direct.along[j]);
    const Row* row = direct.point + j * span;
    Vector top = all(-1.0f), at = all(1.0f);
    if constexpr (What == Fitted::tail) {
      const Vector g12 = dot<Span>(row, behind.point + j * span, span);
      top = pair_score(b1, load(behind.along[j]), g11, g12, load(behind.own[j]));
    } else {
      for (int lag = least; lag <= most; ++lag) {
        const int k = j + lag < coarse ? j + lag : j + lag - coarse;
        const Vector g12 = dot<Span>(row, direct.point + k * span, span);
        const Vector score = pair_score(b1, load(direct.along[k]), g11, g12, load(direct.own[k]));
        const Mask better = hn::Gt(score, top);
        top = choose(better, score, top);
        at = choose(better, all(static_cast<float>(lag)), at);
      }
    }
    store(top, best[j]);
    store(at, best_lag[j]);
  }
}

HWY_INLINE Vector fine_position(const MultipathCurve& curve, Vector place) {
  return hn::Floor(hn::Div(hn::MulAdd(place, all(static_cast<float>(curve.points)), all(0.5f)),
                           all(static_cast<float>(curve.coarse))));
}

/// Refines the guess and the best coarse place.
template <int Span>
HWY_INLINE Place best_single(const MultipathCurve& curve, const White& white,
                             const CoarsePoints& points, Vector guess) {
  Vector top = hn::Zero(Floats()), place = top;
  for (int j = 0; j < curve.coarse; ++j) {
    const Vector b = hn::Max(load(points.along[j]), hn::Zero(Floats()));
    const Vector score = hn::Div(hn::Mul(b, b), hn::Add(load(points.own[j]), all(1e-20f)));
    const Mask better = hn::Gt(score, top);
    top = choose(better, score, top);
    place = choose(better, all(static_cast<float>(j)), place);
  }
  const Vector zero = hn::Zero(Floats());
  const Place from_guess =
      downhill<Fitted::single, Span>(curve, {}, white, guess, zero, max_single_steps);
  const Place from_coarse = downhill<Fitted::single, Span>(
      curve, {}, white, fine_position(curve, place), zero, max_single_steps);
  return choose(hn::Lt(from_coarse.chi2, from_guess.chi2), from_coarse, from_guess);
}

template <Fitted What, int Span>
HWY_INLINE void search_lanes(const MultipathCurve& curve, const DelayBounds& delays,
                             const PixelGroup& pixels, int lane, PairFits& fits) {
  White white;
  white.make(curve, pixels, lane);
  CoarsePoints direct, behind;
  direct.make<Span>(curve, curve.coarse_row, white);
  if constexpr (What == Fitted::tail) behind.make<Span>(curve, curve.coarse_tail, white);
  const Place single = best_single<Span>(curve, white, direct, load(pixels.guess + lane));

  alignas(64) Row score[max_coarse], lag[max_coarse];
  score_coarse<What, Span>(curve, delays, direct, behind, score, lag);
  const Vector step = all(static_cast<float>(curve.points) / static_cast<float>(curve.coarse));
  const Vector excluded_from = hn::Add(load(pixels.excluded_from + lane), step);
  const Vector excluded_length = hn::Sub(load(pixels.excluded_length + lane), hn::Add(step, step));
  Starts starts;
  for (int j = 0; j < curve.coarse; ++j) {
    const Vector here = load(score[j]);
    const int before = j > 0 ? j - 1 : curve.coarse - 1, after = j + 1 < curve.coarse ? j + 1 : 0;
    const Mask is_top =
        hn::And(hn::Ge(here, load(score[before])), hn::Gt(here, load(score[after])));
    const Vector place = fine_position(curve, all(static_cast<float>(j)));
    const Mask is_allowed =
        hn::Ge(wrapped(hn::Sub(place, excluded_from), curve.points), excluded_length);
    starts.add(hn::And(is_top, is_allowed), here, j, load(lag[j]));
  }

  const auto start_from = [&](int i) {
    const Vector delay =
        What == Fitted::tail
            ? hn::Zero(Floats())
            : hn::Min(hn::Max(hn::Mul(load(starts.lag[i]), step), all(delays.shortest)),
                      all(delays.longest));
    return downhill<What, Span>(curve, delays, white, fine_position(curve, load(starts.place[i])),
                                delay, max_pair_steps);
  };
  Place best = start_from(0);
  Vector second_best = single.chi2;
  const Vector half = all(0.5f * static_cast<float>(curve.points));
  for (int i = 1; i < max_starts; ++i) {
    const Place other = start_from(i);
    const Mask better = hn::Lt(other.chi2, best.chi2);
    const Vector apart = hn::Abs(
        hn::Sub(wrapped(hn::Add(hn::Sub(other.first, best.first), half), curve.points), half));
    const Vector worse = hn::Max(other.chi2, best.chi2);
    second_best = choose(hn::Gt(apart, step), hn::Min(second_best, worse), second_best);
    best = choose(better, other, best);
  }
  const Place free = look<What, Span>(curve, white, best.first, best.second, true);
  Vector information = free.h11;
  if constexpr (What == Fitted::pair)
    information =
        hn::Sub(information, hn::Div(hn::Mul(free.h12, free.h12), hn::Add(free.h22, all(1e-20f))));
  store(best.first, fits.position + lane);
  store(best.second, fits.delay + lane);
  store(best.s1, fits.signal_e_per_s + lane);
  store(best.s2, fits.second_e_per_s + lane);
  store(best.chi2, fits.chi2 + lane);
  store(single.chi2, fits.single_chi2 + lane);
  store(second_best, fits.second_best_chi2 + lane);
  const Vector least =
      all(12.0f / static_cast<float>(curve.points) / static_cast<float>(curve.points));
  store(hn::Div(all(1.0f), hn::Sqrt(hn::Max(information, least))), fits.deviation + lane);
}

template <Fitted What, int Span>
void search_group(const MultipathCurve& curve, const DelayBounds& delays, const PixelGroup& pixels,
                  PairFits& fits) {
  for (int lane = 0; lane < pixels_per_group; lane += lanes_of())
    search_lanes<What, Span>(curve, delays, pixels, lane, fits);
}

void pair(const MultipathCurve& curve, const DelayBounds& delays, const PixelGroup& pixels,
          PairFits& fits) {
  if (!curve.tail.empty()) return search_group<Fitted::tail, 0>(curve, delays, pixels, fits);
  // Two buckets and five exposures span five dimensions.
  if (curve.span == 5) return search_group<Fitted::pair, 5>(curve, delays, pixels, fits);
  search_group<Fitted::pair, 0>(curve, delays, pixels, fits);
}

void single(const MultipathCurve& curve, const PixelGroup& pixels, SingleFits& fits) {
  for (int lane = 0; lane < pixels_per_group; lane += lanes_of()) {
    White white;
    white.make(curve, pixels, lane);
    const Place best = downhill<Fitted::single, 0>(curve, {}, white, load(pixels.guess + lane),
                                                   hn::Zero(Floats()), max_single_steps);
    store(best.first, fits.position + lane);
    store(best.chi2, fits.chi2 + lane);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tofsmith {

HWY_EXPORT(pair);
HWY_EXPORT(single);

void fit_pair(const MultipathCurve& curve, const DelayBounds& delays, const PixelGroup& pixels,
              PairFits& fits) {
  HWY_DYNAMIC_DISPATCH(pair)(curve, delays, pixels, fits);
}

void fit_single(const MultipathCurve& curve, const PixelGroup& pixels, SingleFits& fits) {
  HWY_DYNAMIC_DISPATCH(single)(curve, pixels, fits);
}

}  // namespace tofsmith
#endif

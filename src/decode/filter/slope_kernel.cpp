// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/filter/slope_kernel.hpp"

#include <array>
#include <iterator>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "decode/filter/slope_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "decode/filter/pair_weight-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {

/// Wraps a difference of depths [bin] to half a period.
HWY_INLINE Vector nearest(Vector difference, Vector samples, Vector per_sample) {
  return hn::NegMulAdd(hn::Round(hn::Mul(difference, per_sample)), samples, difference);
}

void weigh_along_slopes(const SlopeTest& test, const FilterGrid& grid, const FilterStrip& strip,
                        const PairWeights& weights) {
  const Vector samples = all(test.samples), per_sample = all(1.0f / test.samples);
  const Vector inverse_max = all(1.0f / test.max_difference_sigma);
  const int rows = strip.rows + strip.rows_above();
  for (std::size_t i = 0; i < half_window.size(); ++i) {
    const int down = half_window[i].rows * strip.step, right = half_window[i].columns * strip.step;
    const std::ptrdiff_t away = down * grid.stride + right;
    const Vector half_down = all(0.5f * static_cast<float>(down));
    const Vector half_right = all(0.5f * static_cast<float>(right));
    for (int r = strip.rows_above() - down; r < rows; ++r) {
      const std::ptrdiff_t row = (static_cast<std::ptrdiff_t>(i) * rows + r) * weights.stride;
      clear_margins(grid, weights.weight + row);
      clear_margins(grid, weights.shifted + row);
      const std::ptrdiff_t first = (strip.first_row - strip.rows_above() + r) * grid.stride;
      for (int x = 0; x < grid.width; x += lanes_of()) {
        const std::ptrdiff_t p = first + x, q = p + away;
        const Vector across = hn::Add(load(test.slope_x + p), load(test.slope_x + q));
        const Vector along = hn::Add(load(test.slope_y + p), load(test.slope_y + q));
        const Vector expected = hn::MulAdd(across, half_right, hn::Mul(along, half_down));
        const Vector difference =
            hn::Sub(hn::Sub(load(test.depth + q), load(test.depth + p)), expected);
        const Vector beyond = nearest(difference, samples, per_sample);
        const Vector variance = hn::Max(hn::Add(load(test.variance + p), load(test.variance + q)),
                                        all(min_depth_variance));
        const Vector squares =
            hn::Div(hn::Mul(beyond, beyond), hn::Mul(all(test.same_depth_sigma2), variance));
        const Vector both = hn::Mul(load(test.usable + p), load(test.usable + q));
        const Vector w = hn::Mul(weight_of(hn::Sub(squares, all(1.0f)), inverse_max), both);
        store(w, weights.weight + row + grid.margin + x);
        store(hn::Mul(w, beyond), weights.shifted + row + grid.margin + x);
      }
    }
  }
}

struct RingPlace {
  std::ptrdiff_t away = 0;
  float x = 0.0f, y = 0.0f, xx = 0.0f, xy = 0.0f, yy = 0.0f;

  RingPlace(const WindowStep& step, int sign, std::ptrdiff_t stride)
      : away(sign * (step.rows * stride + step.columns)),
        x(static_cast<float>(sign * step.columns)),
        y(static_cast<float>(sign * step.rows)),
        xx(x * x),
        xy(x * y),
        yy(y * y) {}
};

/// Returns the neighbours ahead, each followed by the opposite one.
std::array<RingPlace, 2 * std::size(half_rings)> ring_places(std::ptrdiff_t stride) {
  return [&]<std::size_t... I>(std::index_sequence<I...>) {
    return std::array{RingPlace(half_rings.data()[I / 2], I % 2 == 0 ? 1 : -1, stride)...};
  }
  (std::make_index_sequence<2 * std::size(half_rings)>());
}

/// Sums for fitting slopes: x^2, x y, y^2, x d, y d.
struct SlopeSums {
  Vector xx, xy, yy, xd, yd;
  HWY_INLINE SlopeSums() : xx(hn::Zero(Floats())), xy(xx), yy(xx), xd(xx), yd(xx) {}
  HWY_INLINE void add(Vector weight, const RingPlace& place, Vector difference) {
    const Vector d = hn::Mul(weight, difference);
    xx = hn::MulAdd(weight, all(place.xx), xx);
    xy = hn::MulAdd(weight, all(place.xy), xy);
    yy = hn::MulAdd(weight, all(place.yy), yy);
    xd = hn::MulAdd(d, all(place.x), xd);
    yd = hn::MulAdd(d, all(place.y), yd);
  }
  /// Regularized, because neighbours may lie on one line.
  HWY_INLINE void solve(Vector& slope_x, Vector& slope_y) const {
    const Vector little = hn::MulAdd(hn::Add(xx, yy), all(1e-4f), all(1e-20f));
    const Vector a = hn::Add(xx, little), b = hn::Add(yy, little);
    const Vector inverse = hn::Div(all(1.0f), hn::NegMulAdd(xy, xy, hn::Mul(a, b)));
    slope_x = hn::Mul(hn::NegMulAdd(xy, yd, hn::Mul(b, xd)), inverse);
    slope_y = hn::Mul(hn::NegMulAdd(xy, xd, hn::Mul(a, yd)), inverse);
  }
};

void find_slopes(const SlopeTest& test, const FilterGrid& grid, int row, float* slope_x,
                 float* slope_y, float* excess) {
  const auto places = ring_places(grid.stride);
  const Vector samples = all(test.samples), per_sample = all(1.0f / test.samples);
  const Vector tiny = all(min_depth_variance), zero = hn::Zero(Floats());
  const Vector inverse_max = all(1.0f / (4 * test.same_depth_sigma2)),
               inverse_max_pair = all(1.0f / (2 * test.same_depth_sigma2));
  for (int x = 0; x < grid.width; x += lanes_of()) {
    const std::ptrdiff_t p = row * grid.stride + x;
    const Vector depth = load(test.depth + p), variance = load(test.variance + p);
    const auto neighbour = [&](std::ptrdiff_t away, Vector& difference, Vector& noise) {
      difference = nearest(hn::Sub(load(test.depth + p + away), depth), samples, per_sample);
      noise = hn::Max(load(test.variance + p + away), tiny);
      return load(test.usable + p + away);
    };
    // First, use opposite neighbours whose differences from the pixel are opposite.
    SlopeSums pairs;
    for (std::size_t i = 0; i < std::size(half_rings); ++i) {
      const RingPlace& place = places.data()[2 * i];
      const std::ptrdiff_t away = place.away;
      Vector ahead, behind, noise_ahead, noise_behind;
      const Vector both =
          hn::Mul(neighbour(away, ahead, noise_ahead), neighbour(-away, behind, noise_behind));
      const Vector bend = hn::Add(ahead, behind), noise = hn::Add(noise_ahead, noise_behind);
      const Vector all_noise = hn::MulAdd(variance, all(4.0f), noise);
      const Vector w = hn::Div(
          hn::Mul(weight_of(hn::Div(hn::Mul(bend, bend), all_noise), inverse_max_pair), both),
          noise);
      pairs.add(w, place, hn::Mul(hn::Sub(ahead, behind), all(0.5f)));
    }
    Vector across, along;
    pairs.solve(across, along);
    // Then, use all neighbours that agree with this plane.
    SlopeSums singles;
    Vector chi2 = zero, count = zero;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const RingPlace& place = places.data()[i];
      Vector difference, noise;
      const Vector usable = neighbour(place.away, difference, noise);
      const Vector expected = hn::MulAdd(across, all(place.x), hn::Mul(along, all(place.y)));
      const Vector beyond = hn::Sub(difference, expected);
      const Vector squares = hn::Div(hn::Mul(beyond, beyond), hn::Add(noise, variance));
      const Vector w = hn::Div(hn::Mul(weight_of(squares, inverse_max), usable), noise);
      singles.add(w, place, difference);
      if (i < 2 * first_far_ring) continue;
      const Vector robust_weight =
          hn::Mul(weight_of(squares, hn::Mul(inverse_max, all(0.25f))), usable);
      chi2 = hn::MulAdd(robust_weight, squares, chi2);
      count = hn::Add(count, robust_weight);
    }
    singles.solve(across, along);
    store(hn::Max(hn::Div(chi2, hn::Max(count, all(1e-6f))), all(1.0f)), excess + p);
    const Mask usable = hn::Gt(load(test.usable + p), zero);
    store(hn::IfThenElseZero(usable, across), slope_x + p);
    store(hn::IfThenElseZero(usable, along), slope_y + p);
  }
}

struct CurvePlaces {
  IndexVector from, to;
  Vector share;  // of `to`

  /// @param bin  in [-N, 2 N)
  HWY_INLINE CurvePlaces(const CurvePoints& curve, Vector bin) {
    const Indices di;
    const Vector samples = all(static_cast<float>(curve.samples)), zero = hn::Zero(Floats());
    bin = hn::Add(bin, hn::IfThenElseZero(hn::Lt(bin, zero), samples));
    bin = hn::Sub(bin, hn::IfThenElseZero(hn::Ge(bin, samples), samples));
    const auto last = hn::Set(di, curve.samples - 1), one = hn::Set(di, 1);
    auto at = hn::ConvertTo(di, bin);
    at = hn::Max(hn::Min(at, last), hn::Zero(di));
    share = hn::Sub(bin, hn::ConvertTo(Floats(), at));
    const auto next = hn::IfThenElse(hn::Lt(at, last), hn::Add(at, one), hn::Zero(di));
    const auto size = hn::Set(di, curve.coordinates);
    from = hn::Mul(at, size), to = hn::Mul(next, size);
  }
  HWY_INLINE Vector per_bin(const CurvePoints& curve, int k) const {
    return hn::Sub(hn::GatherIndex(Floats(), curve.points + k, to),
                   hn::GatherIndex(Floats(), curve.points + k, from));
  }
  HWY_INLINE Vector on(const CurvePoints& curve, int k) const {
    const Vector a = hn::GatherIndex(Floats(), curve.points + k, from);
    const Vector b = hn::GatherIndex(Floats(), curve.points + k, to);
    return hn::MulAdd(share, hn::Sub(b, a), a);
  }
};

void split_row(const CurvePoints& curve, const SplitRow& row, int width) {
  const Vector zero = hn::Zero(Floats());
  for (int x = 0; x < width; x += lanes_of()) {
    const CurvePlaces places(curve, load(row.depth + x));
    Vector point[max_measurements];
    Vector along = zero, own = all(1e-30f);
    for (int k = 0; k < curve.coordinates; ++k) {
      point[k] = places.on(curve, k);
      if (k >= curve.rank) continue;
      along = hn::MulAdd(point[k], load(row.in.data()[k] + x), along);
      own = hn::MulAdd(point[k], point[k], own);
    }
    const Mask is_guided = hn::Gt(load(row.guided + x), zero);
    const Vector signal = hn::IfThenElseZero(is_guided, hn::Div(along, own));
    store(signal, row.signal + x);
    for (int k = 0; k < curve.coordinates; ++k)
      store(hn::NegMulAdd(signal, point[k], load(row.in.data()[k] + x)), row.out.data()[k] + x);
  }
}

void join_row(const CurvePoints& curve, const JoinRow& row, int width) {
  const Vector zero = hn::Zero(Floats());
  for (int x = 0; x < width; x += lanes_of()) {
    const Vector signal = load(row.signal + x), shift = row.shift ? load(row.shift + x) : zero;
    // Without signal, the shift is meaningless.
    const Mask can_move = hn::Gt(signal, hn::Mul(hn::Abs(shift), all(0.25f)));
    const Vector beyond = hn::IfThenElseZero(can_move, hn::Div(shift, signal));
    const CurvePlaces places(curve, hn::Add(load(row.depth + x), beyond));
    const Mask is_guided = hn::Gt(load(row.guided + x), zero);
    const Vector added = hn::IfThenElseZero(is_guided, signal);
    for (int k = 0; k < curve.coordinates; ++k) {
      float* const light = row.light.data()[k] + x;
      store(hn::MulAdd(added, places.on(curve, k), load(light)), light);
    }
  }
}

void compare_sums(const CurvePoints& curve, const NearAndFar& sums, const FilterGrid& grid,
                  int row) {
  const Vector zero = hn::Zero(Floats()), tiny = all(1e-30f);
  for (int x = 0; x < grid.width; x += lanes_of()) {
    const std::ptrdiff_t at = row * grid.stride + x;
    const CurvePlaces places(curve, load(sums.depth + at));
    Vector per_bin[max_measurements];
    Vector far2 = zero, dot = zero;
    for (int j = 0; j < curve.rank; ++j) {
      const Vector far = load(sums.far.data()[j] + at);
      per_bin[j] = places.per_bin(curve, j);
      far2 = hn::MulAdd(far, far, far2);
      dot = hn::MulAdd(per_bin[j], far, dot);
    }
    // Project the near sum on the direction in which the far sum moves with its depth.
    const Vector along = hn::Div(dot, hn::Max(far2, tiny));
    Vector moved = zero, move2 = tiny;
    for (int j = 0; j < curve.rank; ++j) {
      const Vector move = hn::NegMulAdd(along, load(sums.far.data()[j] + at), per_bin[j]);
      moved = hn::MulAdd(move, load(sums.near.data()[j] + at), moved);
      move2 = hn::MulAdd(move, move, move2);
    }
    // The far sum includes the near one, so the difference has less noise than the near sum.
    const Vector near_variance = hn::Max(load(sums.near_variance + at), all(1e-12f));
    const Vector noise = hn::Max(hn::Sub(near_variance, load(sums.far_variance + at)),
                                 hn::Mul(near_variance, all(least_noise_share)));
    const Vector difference = hn::Div(moved, hn::Sqrt(hn::Mul(move2, noise)));
    const Mask is_known = hn::And(hn::Gt(load(sums.usable + at), zero),
                                  hn::Gt(far2, hn::Mul(near_variance, all(least_energy))));
    store(hn::IfThenElseZero(is_known, difference), sums.difference + at);
  }
}

/// Replaces a share of the far sum by the near sum. The covariance of both sums equals the variance
/// of the far sum, which is the mean of all pixels.
HWY_INLINE void keep_share(const NearAndFar& sums, std::ptrdiff_t at, Vector kept, Vector share2,
                           Vector near_variance) {
  for (int k = 0; k < sums.planes; ++k) {
    float* const light = sums.far.data()[k] + at;
    const Vector far = load(light);
    store(hn::MulAdd(kept, hn::Sub(load(sums.near.data()[k] + at), far), far), light);
  }
  const Vector far = load(sums.far_variance + at);
  const Vector beyond = hn::Max(hn::Sub(near_variance, far), hn::Zero(Floats()));
  store(hn::MulAdd(share2, beyond, far), sums.far_variance + at);
}

/// Share of the near sum that minimizes bias and noise.
HWY_INLINE Vector kept_of(Vector excess, float half) {
  return hn::Div(excess, hn::Add(excess, all(half)));
}

void keep_near(const NearAndFar& sums, const FilterGrid& grid, int row) {
  const Vector zero = hn::Zero(Floats()), one = all(1.0f);
  for (int x = 0; x < grid.width; x += lanes_of()) {
    const std::ptrdiff_t at = row * grid.stride + x;
    Vector squares = zero, sum_around = zero, count = zero;
    for (int dy = -compared_reach; dy <= compared_reach; dy += compared_step)
      for (int dx = -compared_reach; dx <= compared_reach; dx += compared_step) {
        const std::ptrdiff_t pixel = at + dy * grid.stride + dx;
        const Vector usable = load(sums.usable + pixel), d = load(sums.difference + pixel);
        squares = hn::MulAdd(hn::Mul(usable, d), d, squares);
        sum_around = hn::MulAdd(usable, d, sum_around);
        count = hn::Add(count, usable);
      }
    const Vector per_pixel = hn::Div(one, hn::Max(count, one));
    const Vector around = hn::Sub(hn::Div(squares, hn::Max(count, one)), all(explained_by_noise));
    // On uniformly curved surfaces all pixels differ slightly, with the same sign.
    const Vector mean_around = hn::Mul(sum_around, per_pixel);
    const Vector bent =
        hn::NegMulAdd(per_pixel, all(explained_in_patch), hn::Mul(mean_around, mean_around));
    // At a silhouette or a crease, only the pixels along a thin line differ, with the same sign.
    Vector best = zero;
    for (std::size_t i = 0; i < std::size(line_directions); ++i) {
      const WindowStep& step = line_directions.data()[i];
      const std::ptrdiff_t away = line_step * (step.rows * grid.stride + step.columns);
      Vector sum = zero, on_line = zero;
      for (int place = -line_side; place <= line_side; ++place) {
        const std::ptrdiff_t pixel = at + place * away;
        const Vector usable = load(sums.usable + pixel);
        sum = hn::MulAdd(usable, load(sums.difference + pixel), sum);
        on_line = hn::Add(on_line, usable);
      }
      const Vector inverse = hn::Div(one, hn::Max(on_line, one));
      const Vector mean = hn::Mul(sum, inverse);
      best = hn::Max(best, hn::NegMulAdd(inverse, all(explained_along_lines), hn::Mul(mean, mean)));
    }
    const Vector near_variance = load(sums.near_variance + at);
    const Vector bright = hn::Mul(near_variance, all(bright_sigma * bright_sigma));
    best = hn::Max(
        best, hn::IfThenElseZero(hn::Gt(square_of(sums.near.data(), sums.rank, at), bright), bent));
    const Vector kept =
        hn::Max(kept_of(hn::Max(around, zero), half_kept), kept_of(best, half_kept_along_lines));
    store(kept, sums.kept + at);
    if (hn::AllTrue(Floats(), hn::Le(kept, zero))) continue;
    // If noise alone causes `kept` > 0, the near sum has more noise than usual.
    keep_share(sums, at, kept, hn::Mul(hn::Mul(kept, kept), all(kept_noise)), near_variance);
  }
}

void keep_bright(const NearAndFar& sums, const FilterGrid& grid, int row) {
  const Vector zero = hn::Zero(Floats()), one = all(1.0f);
  for (int x = 0; x < grid.width; x += lanes_of()) {
    const std::ptrdiff_t at = row * grid.stride + x;
    const Vector near_variance = hn::Max(load(sums.near_variance + at), all(1e-12f));
    const Vector sigmas =
        hn::Sqrt(hn::Div(square_of(sums.near.data(), sums.rank, at), near_variance));
    const Vector kept =
        hn::Min(hn::Max(hn::MulSub(sigmas, all(1.0f / bright_sigma), one), zero), one);
    if (!hn::AllTrue(Floats(), hn::Le(kept, zero)))
      keep_share(sums, at, kept, hn::Mul(kept, kept), near_variance);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tofsmith {

HWY_EXPORT(weigh_along_slopes);
HWY_EXPORT(find_slopes);
HWY_EXPORT(split_row);
HWY_EXPORT(join_row);
HWY_EXPORT(compare_sums);
HWY_EXPORT(keep_near);
HWY_EXPORT(keep_bright);

void weigh_along_slopes(const SlopeTest& test, const FilterGrid& grid, const FilterStrip& strip,
                        const PairWeights& weights) {
  HWY_DYNAMIC_DISPATCH(weigh_along_slopes)(test, grid, strip, weights);
}

void find_slopes(const SlopeTest& test, const FilterGrid& grid, int row, float* slope_x,
                 float* slope_y, float* excess) {
  HWY_DYNAMIC_DISPATCH(find_slopes)(test, grid, row, slope_x, slope_y, excess);
}

void split_row(const CurvePoints& curve, const SplitRow& row, int width) {
  HWY_DYNAMIC_DISPATCH(split_row)(curve, row, width);
}

void join_row(const CurvePoints& curve, const JoinRow& row, int width) {
  HWY_DYNAMIC_DISPATCH(join_row)(curve, row, width);
}

void compare_sums(const CurvePoints& curve, const NearAndFar& sums, const FilterGrid& grid,
                  int row) {
  HWY_DYNAMIC_DISPATCH(compare_sums)(curve, sums, grid, row);
}

void keep_near(const NearAndFar& sums, const FilterGrid& grid, int row) {
  HWY_DYNAMIC_DISPATCH(keep_near)(sums, grid, row);
}

void keep_bright(const NearAndFar& sums, const FilterGrid& grid, int row) {
  HWY_DYNAMIC_DISPATCH(keep_bright)(sums, grid, row);
}

}  // namespace tofsmith
#endif

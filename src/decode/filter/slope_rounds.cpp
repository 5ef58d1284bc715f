// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Passes of a Filter along slopes. The light of a neighbour q is split into signal and remainder,
// y_q = S_q x(z_q) + e_q. Signals are moved to the depth z of the pixel plus the neighbour's
// distance d_q from the plane:
//   sum_q w_q e_q + (sum_q w_q S_q) x(z + sum_q w_q S_q d_q / sum_q w_q S_q).
#include <algorithm>
#include <cmath>

#include "decode/filter/filter_plan.hpp"
#include "decode/filter/slope_kernel.hpp"

namespace tofsmith {

namespace {

/// By number of windows: energy of the impulse response of all steps on a plane with equal weights,
/// inside and at its border.
constexpr SlopeNoise first_slope_noise[] = {
    {0.005f, 0.1f, 0.003f, 0.065f}, {0.27f, 0.3f, 0.03f, 0.085f}, {0.44f, 0.65f, 0.05f, 0.19f}};
/// Later passes use slopes from sums along slopes.
constexpr SlopeNoise later_slope_noise[] = {
    {0.005f, 0.1f, 0.003f, 0.065f}, {0.31f, 0.45f, 0.03f, 0.085f}, {0.62f, 1.48f, 0.05f, 0.19f}};

}  // namespace

SlopeNoise slope_noise_of(int windows, int round) {
  return (round == 0 ? first_slope_noise : later_slope_noise)[windows - 1];
}

float deviation_factor(float rejected, float averaged) {
  const float near =
      std::clamp((rejected - edge_bias.from) / (edge_bias.full - edge_bias.from), 0.0f, 1.0f);
  const float alone = std::max(rejected - edge_bias.full, 0.0f) * std::max(averaged - 1.0f, 0.0f);
  return std::sqrt(1.0f + edge_bias.near * near + alone);
}

/// The noise of slopes affects the depth only, not the residual. Neighbours with the same wrong
/// lobe support each other, because slopes are fitted to the depths of one lobe; the ratio 1.3 was
/// determined with benchmarks/reliability.py. After two passes the residual has no ratio: errors in
/// bright light would cause false alarms.
NoiseRatios Filter::Plan::noise_ratios() const {
  if (options.slope_rounds == 0) return {};
  NoiseRatios ratios{.of_lobes = 1.3f};
  if (options.slope_rounds == 1)
    ratios.of_residual = 1.0f / (1.0f + slope_noise_of(options.windows, 0).sum);
  return ratios;
}

void Filter::Plan::find_depth(const RawView& raw, FilterPlanes& frame, int from, int into) const {
  const FilterGrid& grid = frame.grid;
  float* const averaged = frame.scalar(FilterPlanes::shift);
  for_each_row(frame, [&](int row) {
    float* const here = averaged + row * grid.stride;
    std::fill_n(here - grid.margin, grid.stride, 1.0f);
    write_raw_row(raw, frame, from, into, row, here);
    std::copy_n(frame.scalar(last_variance()) + row * grid.stride, grid.width,
                &frame.averaged(row, 0));
  });
  // Include margins, because decoders write whole rows.
  float* const depth = frame.scalar(FilterPlanes::depth);
  float* const variance = frame.scalar(FilterPlanes::depth_variance);
  const RawView filtered{.data = static_cast<const float*>(frame.light(into, 0) - grid.margin),
                         .height = grid.height,
                         .width = static_cast<int>(grid.stride),
                         .measurements = measurements,
                         .row_stride = grid.stride,
                         .column_stride = 1,
                         .measurement_stride = grid.plane_floats(),
                         .averaged = averaged - grid.margin,
                         .is_marked = true};
  decoder.decode(filtered, {.depth_m = depth - grid.margin, .deviation_m = variance - grid.margin});
  const auto per_bin = static_cast<float>(1.0 / decoder.table().row_m());
  for_each_row(frame, [&](int row) {
    const std::ptrdiff_t first = row * grid.stride - grid.margin;
    for (std::ptrdiff_t at = first; at < first + grid.stride; ++at) {
      const float deviation = variance[at] * per_bin;
      const bool is_known = frame.scalar(FilterPlanes::usable)[at] > 0.0f &&
                            std::isfinite(depth[at]) && std::isfinite(deviation);
      frame.scalar(FilterPlanes::usable)[at] = is_known ? 1.0f : 0.0f;
      depth[at] = is_known ? depth[at] * per_bin : 0.0f;
      variance[at] = is_known ? deviation * deviation : 1.0f;
    }
  });
}

void Filter::Plan::split(FilterPlanes& frame, int from, int to, int row) const {
  const std::ptrdiff_t at = row * frame.grid.stride;
  SplitRow split{.depth = frame.scalar(FilterPlanes::depth) + at,
                 .guided = frame.scalar(FilterPlanes::usable) + at,
                 .signal = frame.scalar(FilterPlanes::signal) + at};
  frame.list_light(from, measurements, split.in, at);
  frame.list_light(to, measurements, split.out, at);
  split_row(points(), split, frame.grid.width);
}

void Filter::Plan::join(FilterPlanes& frame, int set, FilterPlanes::Scalar signal, bool is_shifted,
                        int row) const {
  const std::ptrdiff_t at = row * frame.grid.stride;
  JoinRow join{.depth = frame.scalar(FilterPlanes::depth) + at,
               .guided = frame.scalar(FilterPlanes::usable) + at,
               .signal = frame.scalar(signal) + at,
               .shift = is_shifted ? frame.scalar(FilterPlanes::shift) + at : nullptr};
  frame.list_light(set, measurements, join.light, at);
  join_row(points(), join, frame.grid.width);
}

void Filter::Plan::keep_near_sums(FilterPlanes& frame, int rest, int to, int window) const {
  const NearAndFar sums = near_and_far(frame, rest, to, window);
  for_each_row(frame, [&](int row) {
    join(frame, rest, FilterPlanes::signal, /*is_shifted=*/false, row);
    compare_sums(points(), sums, frame.grid, row);
  });
  for_each_row(frame, [&](int row) { keep_near(sums, frame.grid, row); });
}

void Filter::Plan::add_slope_noise(FilterPlanes& frame, int round) const {
  const int window = options.windows - 1;
  const SlopeNoise noise = slope_noise_of(options.windows, round);
  // Later passes test depths by their noise alone.
  const bool is_last = round + 1 == options.slope_rounds;
  for_each_row(frame, [&](int row) {
    const std::ptrdiff_t at = row * frame.grid.stride;
    const float* const guided = frame.scalar(FilterPlanes::usable) + at;
    const float* const offset2 = frame.scalar(FilterPlanes::signal_next) + at;
    const float* const near_share = frame.scalar(FilterPlanes::signal) + at;
    const float* const before = &frame.averaged(row, 0);
    const float* const near = frame.scalar(WindowVariances(window).in) + at;
    float* const variance = frame.scalar(last_variance()) + at;
    for (int x = 0; x < frame.grid.width; ++x) {
      if (!(guided[x] > 0.0f)) continue;
      const float far_share = window > 0 ? 1.0f - near_share[x] : 1.0f;
      const float d2 = is_last ? offset2[x] : 0.0f;
      const float of_sum = noise.sum + noise.sum_offset * d2;
      // Depths of near sums share less noise with the depths that determine the slope.
      const float of_near = slope_noise_of_near * std::min(1.0f, before[x] / near[x]);
      const float of_before =
          is_last ? noise.before * (1.0f - of_near) + noise.before_offset * d2 : 0.0f;
      variance[x] += far_share * far_share * (of_sum * variance[x] + of_before * before[x]);
    }
  });
}

void Filter::Plan::add_along_slopes(FilterPlanes& frame, int light, int rest, int to,
                                    int window) const {
  const SlopeTest test{
      .depth = frame.scalar(FilterPlanes::depth),
      .variance = frame.scalar(FilterPlanes::depth_variance),
      .slope_x = frame.scalar(FilterPlanes::energy),
      .slope_y = frame.scalar(FilterPlanes::inverse_sigma),
      .usable = frame.scalar(FilterPlanes::usable),
      .samples = static_cast<float>(samples()),
      .same_depth_sigma2 = static_cast<float>(options.same_depth_sigma * options.same_depth_sigma),
      .max_difference_sigma = static_cast<float>(options.max_difference_sigma)};
  for_each_row(frame, [&](int row) {
    if (window == 0) {
      find_slopes(test, frame.grid, row, frame.scalar(FilterPlanes::energy),
                  frame.scalar(FilterPlanes::inverse_sigma), frame.scalar(FilterPlanes::shift));
      const float* const excess = frame.scalar(FilterPlanes::shift) + row * frame.grid.stride;
      for (int x = 0; x < frame.grid.width; ++x) frame.averaged(row, x) *= excess[x];
    }
    split(frame, light, rest, row);
  });
  WeightedSums sums = sums_of(frame, rest, to, window);
  sums.in[static_cast<std::size_t>(sums.planes)] = frame.scalar(FilterPlanes::signal);
  sums.out[static_cast<std::size_t>(sums.planes++)] = frame.scalar(FilterPlanes::signal_next);
  sums.shifted_in = frame.scalar(FilterPlanes::signal);
  sums.shifted_out = frame.scalar(FilterPlanes::shift);
  if (window == 0) sums.rejected = frame.scalar(FilterPlanes::rejected);
  const LightBalance balance{.depth = test.depth,
                             .slope_x = test.slope_x,
                             .slope_y = test.slope_y,
                             .squares = squares.data(),
                             .samples = samples(),
                             .step = window_step(window)};
  if (window > 0) sums.balance = &balance;
  for_each_strip(
      frame, window_step(window), true, [&](const FilterStrip& strip, const PairWeights& weights) {
        weigh_along_slopes(test, frame.grid, strip, weights);
        for (int r = 0; r < strip.rows; ++r) {
          add_weighted(sums, frame.grid, strip, weights, r);
          join(frame, to, FilterPlanes::signal_next, /*is_shifted=*/true, strip.first_row + r);
          if (window + 1 == options.windows)
            find_offsets(sums, frame.grid, strip, weights, r,
                         frame.scalar(FilterPlanes::signal_next));
        }
      });
  if (window > 0) keep_near_sums(frame, rest, to, window);
}

}  // namespace tofsmith

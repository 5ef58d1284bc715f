// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "decode/filter/filter_planes.hpp"
#include "decode/filter/lit_kernel.hpp"
#include "decode/filter/slope_kernel.hpp"
#include "decode/raw_scale.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/decode/decoder.hpp"

namespace tofsmith {

/// Rows that one thread processes at a time.
inline constexpr int filter_rows = 32;
inline constexpr int window_side = 2 * window_reach + 1;

int window_step(int window);

struct WindowVariances {
  FilterPlanes::Scalar in, out;

  explicit WindowVariances(int window);
};

struct Filter::Plan {
  Plan(DecodingTable table, const FilterOptions& options_, const AmbientProjection& projection);

  FilterOptions options;
  Decoder decoder;
  RawScale scale;
  int measurements = 0, rank = 0;
  std::vector<float> to_coordinates;   // (K, K): coordinate j of measurement k at j * K + k
  std::vector<float> to_measurements;  // inverse, k * K + j
  std::vector<float> curve;            // x = T o chi in coordinates (N, K)
  std::vector<float> squares;          // of LightBalance (N, 2)
  HiddenSignal hidden;
  bool has_own_shot_noise = false;  // from light that cancels in the measurements

  int samples() const { return decoder.table().samples(); }
  float lit_bar_sigma() const {
    const bool is_near = options.windows == 1 && options.slope_rounds == 0;
    return is_near ? lit_bar_sigma_near : lit_bar_sigma_far;
  }
  FilterPlanes::Scalar last_variance() const { return WindowVariances(options.windows - 1).out; }

  /// Bias that the variance of a window of similar pixels includes: that of the result. Passes
  /// along slopes include none, since it would hide mixed pixels from mark_mixed_pixels().
  BiasBound bias_of(int window) const {
    return window + 1 == options.windows && options.slope_rounds == 0 ? similar_bias : BiasBound{};
  }

  NoiseRatios noise_ratios() const;

  /// Reads the first set of light, with variances and usable flags.
  void read(const RawView& raw, FilterPlanes& frame) const;
  /// Reads another set of light, with usable flags in another plane.
  void read_again(const RawView& raw, FilterPlanes& frame, int set,
                  FilterPlanes::Scalar usable) const;
  /// Applies a window of the first pass, which averages neighbours with parallel vectors.
  void add_similar(FilterPlanes& frame, int from, int to, int window) const;
  /// Marks pixels that fail find_own_light() as unusable. Overwrites the other set.
  void leave_dark(const RawView& raw, FilterPlanes& frame, int set, int other) const;
  /// Computes the depth of a set of light; overwrites another set.
  void find_depth(const RawView& raw, FilterPlanes& frame, int from, int into) const;
  /// Applies a window of a pass along slopes. `light` is split into signal along the depth and a
  /// remainder, stored in `rest`; the result is stored in `to`.
  void add_along_slopes(FilterPlanes& frame, int light, int rest, int to, int window) const;
  /// Adds the noise of slopes to the variances of a pass.
  void add_slope_noise(FilterPlanes& frame, int round) const;
  /// Converts a set of light to raw numbers. Pixels that fail find_own_light() keep their
  /// measurements, and `averaged` is multiplied by find_lit_share(). Overwrites the other set.
  void finish(const RawView& raw, FilterPlanes& frame, int set, int other) const;

 private:
  WeightedSums sums_of(FilterPlanes& frame, int from, int to, int window) const;
  NearAndFar near_and_far(FilterPlanes& frame, int near, int far, int window) const;
  OwnLightTest own_light_test(FilterPlanes& frame, int added, int measured) const;
  void read_row(const RawView& raw, FilterPlanes& frame, int row, int set, float* usable,
                float* variance) const;
  void find_hidden_noise(const RawView& raw, FilterPlanes& frame, int row) const;
  void write_raw_row(const RawView& raw, FilterPlanes& frame, int from, int to, int row,
                     float* averaged) const;
  void write_deviation_factors(FilterPlanes& frame, int row, const float* is_filtered) const;
  CurvePoints points() const { return {curve.data(), samples(), measurements, rank}; }
  void split(FilterPlanes& frame, int from, int to, int row) const;
  void join(FilterPlanes& frame, int set, FilterPlanes::Scalar signal, bool is_shifted,
            int row) const;
  /// Restores in `to` the values before a window where it averaged pixels of another surface.
  void keep_near_sums(FilterPlanes& frame, int rest, int to, int window) const;
};

template <typename Work>
void for_each_row(const FilterPlanes& frame, const Work& work) {
  parallel_for_blocks(frame.grid.height, filter_rows, [&](IndexRange rows) {
    for (std::int64_t row = rows.begin; row < rows.end; ++row) work(static_cast<int>(row));
  });
}

template <typename Work>
void for_each_strip(FilterPlanes& frame, int step, bool with_shifts, const Work& work) {
  parallel_for_blocks(frame.grid.height, filter_rows, [&](IndexRange rows) {
    const FilterStrip strip{.first_row = static_cast<int>(rows.begin),
                            .rows = static_cast<int>(rows.end - rows.begin),
                            .step = step};
    std::unique_ptr<StripBuffers> buffers = frame.buffers.take();
    work(strip, buffers->weights(frame.grid, strip, with_shifts));
    frame.buffers.give_back(std::move(buffers));
  });
}

}  // namespace tofsmith

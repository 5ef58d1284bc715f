// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "decode/filter/filter_planes.hpp"
#include "decode/filter/hidden_signal.hpp"
#include "decode/filter/lit_kernel.hpp"
#include "decode/filter/slope_kernel.hpp"
#include "decode/raw_scale.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/decode/decoder.hpp"

namespace tofsmith {

/// Rows of a frame that one thread works on at a time.
inline constexpr int filter_rows = 32;
inline constexpr int window_side = 2 * window_reach + 1;

/// Pixels that the windows of a round are apart.
int window_step(int window);

/// The variances that go into a window and come out of it.
struct WindowVariances {
  FilterPlanes::Scalar in, out;

  explicit WindowVariances(int window);
};

/// What a Filter knows, and its steps over a frame.
struct Filter::Plan {
  Plan(DecodingTable table, const FilterOptions& options_, const AmbientProjection& projection);

  FilterOptions options;
  Decoder decoder;
  RawScale scale;
  int measurements = 0, rank = 0;
  std::vector<float> to_coordinates;   // (K, K): coordinate j of measurement k at j * K + k
  std::vector<float> to_measurements;  // and back, k * K + j
  std::vector<float> curve;            // x = T o chi in coordinates (N, K)
  std::vector<float> squares;          // of LightBalance (N, 2)
  HiddenSignal hidden;
  bool has_own_shot_noise = false;  // light that cancels in the measurements still makes noise

  int samples() const { return decoder.table().samples(); }
  /// The variance that the last window leaves.
  FilterPlanes::Scalar last_variance() const { return WindowVariances(options.windows - 1).out; }

  /// Noise of filtered numbers, relative to that which their `averaged` states.
  NoiseRatios noise_ratios() const;

  /// Raw numbers into the first set of light, with their variances and where they are usable.
  void read(const RawView& raw, FilterPlanes& frame) const;
  /// Raw numbers into a set of light again, and where they are usable into a plane.
  void read_again(const RawView& raw, FilterPlanes& frame, int set,
                  FilterPlanes::Scalar usable) const;
  /// One window of the round that adds neighbours whose vectors are parallel.
  void add_similar(FilterPlanes& frame, int from, int to, int window) const;
  /// Marks pixels that fail find_own_light() as unusable, because they do not determine slopes.
  /// Overwrites the other set.
  void leave_dark(const RawView& raw, FilterPlanes& frame, int set, int other) const;
  /// Depth of a set of light, by way of raw numbers in another set.
  void find_depth(const RawView& raw, FilterPlanes& frame, int from, int into) const;
  /// One window of a round that adds neighbours of the same surface: `light` is split into signal
  /// along the depth and the rest, in `rest`; the sum goes to `to`.
  void add_along_slopes(FilterPlanes& frame, int light, int rest, int to, int window) const;
  /// What the noise of slopes adds to the variance of the sums of a round.
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
  CurvePoints points() const { return {curve.data(), samples(), measurements, rank}; }
  void split(FilterPlanes& frame, int from, int to, int row) const;
  void join(FilterPlanes& frame, int set, int row) const;
  /// Gives `to` back what was there before a window, of which `rest` holds the rest, where that
  /// window added what is of another surface.
  void keep_near_sums(FilterPlanes& frame, int rest, int to, int window) const;
};

/// Calls work(row) for all rows of a frame, on all threads.
template <typename Work>
void for_each_row(const FilterPlanes& frame, const Work& work) {
  parallel_for_blocks(frame.grid.height, filter_rows, [&](IndexRange rows) {
    for (std::int64_t row = rows.begin; row < rows.end; ++row) work(static_cast<int>(row));
  });
}

/// Calls work(strip, room for its weights) for all strips of a frame, on all threads.
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

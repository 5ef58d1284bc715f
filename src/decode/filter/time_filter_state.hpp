// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "decode/filter/compared_rows.hpp"
#include "decode/filter/filter_planes.hpp"
#include "decode/filter/hidden_signal.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/decode/filter.hpp"

namespace tofsmith {

/// Rows of a frame that one thread compares at a time.
inline constexpr int compared_strip_rows = 32;

/// What a TimeFilter knows, what it keeps, and its steps over a frame.
struct TimeFilter::State {
  /// Pixels of a row that are worked on at a time.
  static constexpr int block_pixels = 256;
  using BlockOfPixels = std::array<float, block_pixels>;

  State(const DecodingTable& table_, const TimeFilterOptions& options_,
        const AmbientProjection& projection);

  DecodingTable table;
  TimeFilterOptions options;
  int measurements;
  float clipped;
  HiddenSignal hidden;
  bool has_own_shot_noise;
  std::vector<float> floor_variance_e2;  // of each measurement, without light (K)
  std::vector<float> shot_per_signal;    // over all depths (K)
  std::vector<float> dark_raw, gain;     // electrons = (raw - dark_raw) gain (K)
  std::vector<float> to_plane;           // V^T (rank, K)
  ChangeTest pixel_test, patch_test, shared_test;

  bool is_empty = true;
  int height = 0, width = 0;
  std::vector<float> means;    // raw numbers (K, H, W)
  std::vector<float> weights;  // of what was added to a pixel, in the next mean (H, W)
  Image<float> averaged;       // n
  int cell_columns = 0;
  std::vector<float> cells;         // sums of differences and how many they are of (cell, K + 1)
  std::vector<float> cell_changes;  // how much a cell changed beyond noise, in chi^2 over K
  StripBufferPool buffers;

  /// Of `cells` and `cell_changes`.
  static std::size_t cell_floats(int height, int width, int measurements);
  void resize(const RawView& raw);
  /// How much of what was added to the pixels of some rows counts, into `weights`.
  void compare(const RawView& raw, IndexRange rows);
  /// What cells share that single patches do not show.
  void find_cell_changes();
  /// The next means of a row.
  void add_row(const RawView& raw, int row);

 private:
  using Numbers = std::array<float, max_measurements * block_pixels>;

  std::ptrdiff_t pixel(int row, int column) const { return std::ptrdiff_t{row} * width + column; }
  float* mean(int k, std::ptrdiff_t pixel) {
    return means.data() + std::ptrdiff_t{k} * height * width + pixel;
  }
  void read(const RawView& raw, std::ptrdiff_t first, int pixels, Numbers& numbers,
            BlockOfPixels& averaged_now) const;
  void find_usable(const Numbers& numbers, const BlockOfPixels& averaged_now, std::ptrdiff_t first,
                   int pixels, float* usable);
  void find_signal(const Numbers& numbers, const BlockOfPixels& averaged_now, std::ptrdiff_t first,
                   int pixels, BlockOfPixels& signal);
  void compare_row(const RawView& raw, int row, ComparedRows& compared, int compared_row);
  void weigh_row(const RawView& raw, int row, ComparedRows& compared, int compared_row);
  void add_to_cells(int row, int column, int pixels, const BlockOfPixels& stays,
                    ComparedRows& compared, int compared_row);
};

}  // namespace tofsmith

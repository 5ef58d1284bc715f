// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "decode/filter/filter_kernel.hpp"
#include "decode/filter/filter_planes.hpp"
#include "decode/shared/marked_raw.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/decode/filter.hpp"

namespace tofsmith {

inline constexpr int compared_strip_rows = 32;

/// Side of the cells that detect changes common to many pixels, and their neighbourhood.
inline constexpr int cell_side = 8, cell_reach = 1;
static_assert(compared_strip_rows % cell_side == 0, "a strip is of whole cells");

/// Weight of an invalid pixel until its neighbours have been compared.
inline constexpr float tells_nothing = -1.0f;
/// Smaller shares of the past also lower the weights of adjacent pixels; larger ones count as
/// random.
inline constexpr float telling_share = 0.5f;

struct AddedFrames {
  bool is_empty = true;
  std::vector<float> means;    ///< raw values (K, H, W)
  std::vector<float> weights;  ///< of the average in the next mean (H, W)
  Image<float> averaged;

  void resize(const RawView& raw);
};

class WaitingFrames {
 public:
  int count() const { return count_; }
  void push(const RawView& raw);
  /// Returns frame `index` (0: oldest), which remains valid after pop() until the next push().
  RawView view(int index) const;
  void pop();
  void clear() { count_ = 0; }

 private:
  struct Slot {
    std::vector<float> values;    // interleaved
    std::vector<float> averaged;  // empty: 1
  };
  std::size_t slot(int index) const;

  std::vector<Slot> slots_;
  std::size_t first_ = 0;
  int count_ = 0;
  int height_ = 0, width_ = 0, measurements_ = 0;
};

struct TimeFilter::State {
  static constexpr int block_pixels = 256;
  using BlockOfPixels = std::array<float, block_pixels>;

  State(const DecodingTable& table_, const TimeFilterOptions& options_,
        const AmbientProjection& projection);

  DecodingTable table;
  TimeFilterOptions options;
  int measurements;
  SaturationLevels levels;
  HiddenSignal hidden;
  bool has_own_shot_noise;
  std::vector<float> floor_variance_e2;  // without light (K)
  std::vector<float> shot_per_signal;    // averaged over all depths (K)
  std::vector<float> dark_raw, gain;     // electrons = (raw - dark_raw) gain (K)
  std::vector<float> to_plane;           // V^T (rank, K)
  ChangeTest pixel_test, patch_test, shared_test;

  int height = 0, width = 0;
  AddedFrames past, future;
  WaitingFrames waiting;
  std::vector<float> shares;  // of the past, if before_filter (H, W)
  int cell_columns = 0;
  std::vector<float> cells;         // sums of differences, and number of pixels (cell, K + 1)
  std::vector<float> cell_changes;  // beyond noise, chi^2 divided by K
  StripBufferPool buffers;

  static std::size_t cell_floats(int height, int width, int measurements);
  bool is_empty() const { return past.is_empty && waiting.count() == 0; }
  void resize(const RawView& raw);
  void weigh(const RawView& raw, AddedFrames& added);
  void add(const RawView& raw, AddedFrames& added);
  void join(const RawView& raw);
  /// Returns the average of the oldest waiting frame and the frames before and after it.
  RawView finish_oldest();
  float* mean(AddedFrames& added, int k, std::ptrdiff_t pixel) const {
    return added.means.data() + std::ptrdiff_t{k} * height * width + pixel;
  }
  const float* mean(const AddedFrames& added, int k, std::ptrdiff_t pixel) const {
    return added.means.data() + std::ptrdiff_t{k} * height * width + pixel;
  }
  RawView view(const AddedFrames& added) const;

 private:
  using Numbers = std::array<float, max_measurements * block_pixels>;

  std::ptrdiff_t pixel(int row, int column) const { return std::ptrdiff_t{row} * width + column; }
  void read(const RawView& raw, std::ptrdiff_t first, int pixels, Numbers& numbers,
            BlockOfPixels& averaged_now) const;
  void compare(const RawView& raw, AddedFrames& added, IndexRange rows);
  void compare_row(const RawView& raw, const AddedFrames& added, int row, ComparedRows& compared,
                   int compared_row) const;
  void weigh_row(const RawView& raw, AddedFrames& added, int row, ComparedRows& compared,
                 int compared_row);
  void add_to_cells(int row, int column, int pixels, const BlockOfPixels& stays,
                    ComparedRows& compared, int compared_row);
  void find_cell_changes();
  template <typename Work>
  void for_each_row(const Work& work) const {
    parallel_for_blocks(height, compared_strip_rows, [&](IndexRange rows) {
      for (std::int64_t row = rows.begin; row < rows.end; ++row) work(static_cast<int>(row));
    });
  }
  float most_weight(const RawView& raw, const AddedFrames& added, std::ptrdiff_t pixel) const {
    const float n = raw.averaged ? raw.averaged[pixel] : 1.0f;
    return std::min(added.averaged.pixels[static_cast<std::size_t>(pixel)],
                    static_cast<float>(options.max_frames - 1) * n);
  }
  void find_shares_of_row(const RawView& raw, const AddedFrames& added, int row);
  void weigh_row_by_shares(const RawView& raw, AddedFrames& added, int row) const;
  void weigh_row_by_cells(const RawView& raw, AddedFrames& added, int row) const;
  void add_row(const RawView& raw, AddedFrames& added, int row) const;
  void join_row(const RawView& raw, int row);
};

}  // namespace tofsmith

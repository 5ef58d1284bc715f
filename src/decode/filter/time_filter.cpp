// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/shared/pixel_runs.hpp"
#include "decode/filter/compared_rows.hpp"
#include "decode/filter/filter_planes.hpp"
#include "decode/filter/hidden_signal.hpp"
#include "decode/raw_scale.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/decode/filter.hpp"

namespace tofsmith {

namespace {

constexpr int strip_rows = 32;
constexpr int block_pixels = 256;

using BlockOfPixels = std::array<float, block_pixels>;

/// Sums over the columns of a patch around `pixels` pixels.
void add_columns(const float* values, int pixels, float* sums) {
  for (int i = 0; i < pixels; ++i) {
    float sum = values[i - patch_reach];
    for (int x = 1 - patch_reach; x <= patch_reach; ++x) sum += values[i + x];
    sums[i] = sum;
  }
}

}  // namespace

struct TimeFilter::State {
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
  StripBufferPool buffers;

  void resize(const RawView& raw);
  /// How much of what was added to the pixels of some rows counts, into `weights`.
  void compare(const RawView& raw, IndexRange rows);
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
};

TimeFilter::State::State(const DecodingTable& table_, const TimeFilterOptions& options_,
                         const AmbientProjection& projection)
    : table(table_),
      options(options_),
      measurements(table.measurements()),
      clipped(table.saturation_level.value_or(std::numeric_limits<float>::infinity())),
      hidden(ExpectedNoise(table), projection),
      has_own_shot_noise(table.shot_correlation.size() > 0),
      pixel_test(measurements, options.max_difference_sigma),
      patch_test(patch_pixels * measurements, options.max_difference_sigma),
      shared_test(measurements, options.max_difference_sigma) {
  const ExpectedNoise noise(table);
  const RawScale scale(table);
  for (int k = 0; k < measurements; ++k) {
    floor_variance_e2.push_back(
        static_cast<float>(std::max(min_variance_e2, noise.floor_variance_e2[k])));
    shot_per_signal.push_back(static_cast<float>(noise.shot_gated.col(k).mean()));
    dark_raw.push_back(static_cast<float>(scale.raw(0.0, k)));
    gain.push_back(static_cast<float>(table.gain_e_per_raw[k]));
  }
  for (int j = 0; j < projection.rank(); ++j)
    for (int k = 0; k < measurements; ++k)
      to_plane.push_back(static_cast<float>(projection.basis(k, j)));
}

void TimeFilter::State::resize(const RawView& raw) {
  height = raw.height;
  width = raw.width;
  const auto pixels = static_cast<std::size_t>(raw.pixels());
  means.assign(pixels * static_cast<std::size_t>(measurements), 0.0f);
  weights.assign(pixels, 0.0f);
  averaged = Image<float>(height, width, 1.0f);
}

/// Raw numbers of some pixels of a row, [K][block_pixels], and of how many they are the mean.
void TimeFilter::State::read(const RawView& raw, std::ptrdiff_t first, int pixels, Numbers& numbers,
                             BlockOfPixels& averaged_now) const {
  for_each_run(raw, first, pixels, [&](const auto* pixel, std::int64_t length, std::int64_t) {
    for (int k = 0; k < measurements; ++k) {
      const auto* number = pixel + k * raw.measurement_stride;
      float* const to = numbers.data() + k * block_pixels;
      for (std::int64_t i = 0; i < length; ++i, number += raw.column_stride)
        to[i] = static_cast<float>(*number);
    }
  });
  if (raw.averaged)
    std::copy_n(raw.averaged + first, pixels, averaged_now.data());
  else
    std::fill_n(averaged_now.data(), pixels, 1.0f);
}

/// 1 where both the mean and what is new are measurements of light, else 0.
void TimeFilter::State::find_usable(const Numbers& numbers, const BlockOfPixels& averaged_now,
                                    std::ptrdiff_t first, int pixels, float* usable) {
  constexpr float lowest = std::numeric_limits<float>::lowest();
  const float* const past = averaged.pixels.data() + first;
  for (int i = 0; i < pixels; ++i)
    usable[i] = averaged_now.data()[i] > 0.0f && past[i] > 0.0f ? 1.0f : 0.0f;
  for (int k = 0; k < measurements; ++k) {
    const float* const now = numbers.data() + k * block_pixels;
    const float* const before = mean(k, first);
    for (int i = 0; i < pixels; ++i) {
      const float least = std::min(now[i], before[i]), most = std::max(now[i], before[i]);
      const bool is_number = now[i] == now[i] && before[i] == before[i];
      usable[i] = is_number && least >= lowest && most < clipped ? usable[i] : 0.0f;
    }
  }
}

/// Where light cancels in the measurements, their noise is that of the signal seen in both.
void TimeFilter::State::find_signal(const Numbers& numbers, const BlockOfPixels& averaged_now,
                                    std::ptrdiff_t first, int pixels, BlockOfPixels& signal) {
  BlockOfPixels squares{}, along;
  const float* const past = averaged.pixels.data() + first;
  for (int j = 0; j < static_cast<int>(hidden.rank); ++j) {
    along.fill(0.0f);
    for (int k = 0; k < measurements; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const float by = to_plane[static_cast<std::size_t>(j * measurements + k)] * gain[at];
      const float* const now = numbers.data() + k * block_pixels;
      const float* const before = mean(k, first);
      for (int i = 0; i < pixels; ++i) {
        const float n = averaged_now.data()[i];
        const float both = (before[i] * past[i] + now[i] * n) / (past[i] + n);
        along.data()[i] += by * (both - dark_raw[at]);
      }
    }
    for (int i = 0; i < pixels; ++i) squares.data()[i] += along.data()[i] * along.data()[i];
  }
  for (int i = 0; i < pixels; ++i)
    signal.data()[i] = hidden.of(squares.data()[i], past[i] + averaged_now.data()[i]);
}

void TimeFilter::State::compare_row(const RawView& raw, int row, ComparedRows& compared,
                                    int compared_row) {
  compared.clear(compared_row, static_cast<float>(measurements));
  if (row < 0 || row >= height) return;
  Numbers numbers;
  BlockOfPixels averaged_now, signal, chi2;
  for (int column = 0; column < width; column += block_pixels) {
    const int pixels = std::min(block_pixels, width - column);
    const std::ptrdiff_t first = pixel(row, column);
    read(raw, first, pixels, numbers, averaged_now);
    float* const usable = compared.counts(compared_row) + column;
    find_usable(numbers, averaged_now, first, pixels, usable);
    if (has_own_shot_noise) find_signal(numbers, averaged_now, first, pixels, signal);
    const float* const past = averaged.pixels.data() + first;
    chi2.fill(0.0f);
    for (int k = 0; k < measurements; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const float* const now = numbers.data() + k * block_pixels;
      const float* const before = mean(k, first);
      float* const difference = compared.difference(compared_row, k) + column;
      for (int i = 0; i < pixels; ++i) {
        const float n = averaged_now.data()[i];
        const float both = (before[i] * past[i] + now[i] * n) / (past[i] + n);
        const float light = has_own_shot_noise ? signal.data()[i] * shot_per_signal[at]
                                               : std::max(0.0f, (both - dark_raw[at]) * gain[at]);
        const float variance = (floor_variance_e2[at] + light) * (1.0f / past[i] + 1.0f / n);
        const float d = (now[i] - before[i]) * gain[at] / std::sqrt(variance);
        difference[i] = usable[i] > 0.0f ? d : 0.0f;
        chi2.data()[i] += difference[i] * difference[i];
      }
    }
    float* const row_chi2 = compared.chi2(compared_row) + column;
    for (int i = 0; i < pixels; ++i)
      if (usable[i] > 0.0f) row_chi2[i] = chi2.data()[i];
  }
}

/// @param compared_row  of the pixel itself
void TimeFilter::State::weigh_row(const RawView& raw, int row, ComparedRows& compared,
                                  int compared_row) {
  const int sums = compared.add_rows(compared_row - patch_reach);
  const auto freedom = static_cast<float>(measurements);
  const auto max_weight = static_cast<float>(options.max_frames - 1);
  BlockOfPixels patch_chi2, counts, sum, shared;
  for (int column = 0; column < width; column += block_pixels) {
    const int pixels = std::min(block_pixels, width - column);
    const std::ptrdiff_t first = pixel(row, column);
    add_columns(compared.chi2(sums) + column, pixels, patch_chi2.data());
    add_columns(compared.counts(sums) + column, pixels, counts.data());
    shared.fill(0.0f);
    for (int k = 0; k < measurements; ++k) {
      add_columns(compared.difference(sums, k) + column, pixels, sum.data());
      for (int i = 0; i < pixels; ++i) shared.data()[i] += sum.data()[i] * sum.data()[i];
    }
    const float* const own_chi2 = compared.chi2(compared_row) + column;
    const float* const usable = compared.counts(compared_row) + column;
    const float* const past = averaged.pixels.data() + first;
    float* const weight = weights.data() + first;
    for (int i = 0; i < pixels; ++i) {
      const float n = raw.averaged ? raw.averaged[first + i] : 1.0f;
      const float patch = patch_chi2.data()[i];
      const float common = shared.data()[i] / std::max(counts.data()[i], 1.0f);
      const float share = std::min(
          {pixel_test.share(own_chi2[i]), patch_test.share(patch), shared_test.share(common)});
      // Of one measurement, relative to its variance.
      const float changed =
          (1.0f / past[i] + 1.0f / n) / freedom *
          std::max({pixel_test.beyond(own_chi2[i]), patch_test.beyond(patch) / patch_pixels,
                    shared_test.beyond(common) / patch_pixels});
      const float stays = share * past[i] / (1.0f + past[i] * changed);
      weight[i] = usable[i] > 0.0f ? std::min(stays, max_weight * n) : 0.0f;
    }
  }
}

void TimeFilter::State::compare(const RawView& raw, IndexRange rows) {
  const auto first = static_cast<int>(rows.begin), count = static_cast<int>(rows.end - rows.begin);
  std::unique_ptr<StripBuffers> buffer = buffers.take();
  ComparedRows compared(strip_rows + 2 * patch_reach, width, measurements, buffer->scratch);
  for (int row = 0; row < count + 2 * patch_reach; ++row)
    compare_row(raw, first + row - patch_reach, compared, row);
  for (int row = 0; row < count; ++row) weigh_row(raw, first + row, compared, row + patch_reach);
  buffers.give_back(std::move(buffer));
}

void TimeFilter::State::add_row(const RawView& raw, int row) {
  Numbers numbers;
  BlockOfPixels averaged_now;
  for (int column = 0; column < width; column += block_pixels) {
    const int pixels = std::min(block_pixels, width - column);
    const std::ptrdiff_t first = pixel(row, column);
    read(raw, first, pixels, numbers, averaged_now);
    const float* const weight = weights.data() + first;
    for (int k = 0; k < measurements; ++k) {
      const float* const now = numbers.data() + k * block_pixels;
      float* const next = mean(k, first);
      for (int i = 0; i < pixels; ++i) {
        const float past_share = weight[i] / (weight[i] + averaged_now.data()[i]);
        const float both = now[i] + (next[i] - now[i]) * past_share;
        next[i] = weight[i] > 0.0f ? both : now[i];
      }
    }
    float* const past = averaged.pixels.data() + first;
    for (int i = 0; i < pixels; ++i) {
      const float w = weight[i], n = averaged_now.data()[i];
      const float both = (w + n) * (w + n) / (w * w / past[i] + n);
      past[i] = w > 0.0f ? both : n;
    }
  }
}

void TimeFilterOptions::validate() const { check_fields(*this, "TimeFilterOptions::"); }

TimeFilter::TimeFilter(const DecodingTable& table, const TimeFilterOptions& options) {
  options.validate();
  table.validate();
  state_ = std::make_unique<State>(table, options, AmbientProjection(table));
}
TimeFilter::~TimeFilter() = default;
TimeFilter::TimeFilter(TimeFilter&&) noexcept = default;
TimeFilter& TimeFilter::operator=(TimeFilter&&) noexcept = default;

const DecodingTable& TimeFilter::table() const { return state_->table; }
const TimeFilterOptions& TimeFilter::options() const { return state_->options; }

std::size_t TimeFilter::memory_bytes(int height, int width, int measurements, int threads) {
  const auto strips =
      static_cast<std::size_t>(std::min(threads, (height + strip_rows - 1) / strip_rows));
  return sizeof(float) *
         (static_cast<std::size_t>(height) * static_cast<std::size_t>(width) *
              static_cast<std::size_t>(measurements + 2) +
          strips * ComparedRows::floats(strip_rows + 2 * patch_reach, width, measurements));
}

RawView TimeFilter::add(const RawView& raw) {
  State& state = *state_;
  require(raw.measurements == state.measurements, "raw measurements", raw.measurements,
          "must equal the code's " + std::to_string(state.measurements));
  require(raw.height > 0 && raw.width > 0, "raw height and width", std::min(raw.height, raw.width),
          "must be > 0");
  if (state.is_empty) {
    state.resize(raw);
  } else {
    require(raw.height == state.height, "raw height", raw.height,
            "must equal that of the frames before, " + std::to_string(state.height));
    require(raw.width == state.width, "raw width", raw.width,
            "must equal that of the frames before, " + std::to_string(state.width));
    parallel_for_blocks(state.height, strip_rows,
                        [&](IndexRange rows) { state.compare(raw, rows); });
  }
  state.is_empty = false;
  parallel_for_blocks(state.height, strip_rows, [&](IndexRange rows) {
    for (std::int64_t row = rows.begin; row < rows.end; ++row)
      state.add_row(raw, static_cast<int>(row));
  });
  RawView view = RawView::planar(state.means.data(), state.height, state.width, state.measurements);
  view.averaged = state.averaged.pixels.data();
  return view;
}

void TimeFilter::forget() { state_->is_empty = true; }

}  // namespace tofsmith

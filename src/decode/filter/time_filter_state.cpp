// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/filter/time_filter_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/shared/pixel_runs.hpp"
#include "decode/raw_scale.hpp"

namespace tofsmith {

namespace {

/// Side of the cells whose sums show what many pixels share, and how far cells around one count.
constexpr int cell_side = 8, cell_reach = 1;
static_assert(compared_strip_rows % cell_side == 0, "a strip is of whole cells");

int cells_of(int pixels) { return (pixels + cell_side - 1) / cell_side; }

/// Sums over the columns of a patch around `pixels` pixels.
void add_columns(const float* values, int pixels, float* sums) {
  for (int i = 0; i < pixels; ++i) {
    float sum = values[i - patch_reach];
    for (int x = 1 - patch_reach; x <= patch_reach; ++x) sum += values[i + x];
    sums[i] = sum;
  }
}

}  // namespace

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

std::size_t TimeFilter::State::cell_floats(int height, int width, int measurements) {
  return static_cast<std::size_t>(cells_of(height) * cells_of(width)) *
         static_cast<std::size_t>(measurements + 2);
}

void TimeFilter::State::resize(const RawView& raw) {
  height = raw.height;
  width = raw.width;
  const auto pixels = static_cast<std::size_t>(raw.pixels());
  means.assign(pixels * static_cast<std::size_t>(measurements), 0.0f);
  weights.assign(pixels, 0.0f);
  averaged = Image<float>(height, width, 1.0f);
  if (!options.before_filter) return;
  cell_columns = cells_of(width);
  cell_changes.assign(static_cast<std::size_t>(cells_of(height) * cell_columns), 0.0f);
  cells.assign(cell_changes.size() * static_cast<std::size_t>(measurements + 1), 0.0f);
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
  BlockOfPixels patch_chi2, counts, sum, shared, unchanged;
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
      unchanged.data()[i] = changed > 0.0f ? 0.0f : usable[i];
    }
    if (options.before_filter) add_to_cells(row, column, pixels, unchanged, compared, compared_row);
  }
}

void TimeFilter::State::compare(const RawView& raw, IndexRange rows) {
  const auto first = static_cast<int>(rows.begin), count = static_cast<int>(rows.end - rows.begin);
  std::unique_ptr<StripBuffers> buffer = buffers.take();
  ComparedRows compared(compared_strip_rows + 2 * patch_reach, width, measurements,
                        buffer->scratch);
  for (int row = 0; row < count + 2 * patch_reach; ++row)
    compare_row(raw, first + row - patch_reach, compared, row);
  for (int row = 0; row < count; ++row) weigh_row(raw, first + row, compared, row + patch_reach);
  buffers.give_back(std::move(buffer));
}

/// @param unchanged  1 where no test has shown a change, else 0: only those tell of smaller ones
void TimeFilter::State::add_to_cells(int row, int column, int pixels,
                                     const BlockOfPixels& unchanged, ComparedRows& compared,
                                     int compared_row) {
  for (int first = 0; first < pixels; first += cell_side) {
    const int end = std::min(first + cell_side, pixels);
    float* const cell = cells.data() + std::ptrdiff_t{row / cell_side * cell_columns +
                                                      (column + first) / cell_side} *
                                           (measurements + 1);
    for (int k = 0; k < measurements; ++k) {
      const float* const difference = compared.difference(compared_row, k) + column;
      for (int i = first; i < end; ++i) cell[k] += unchanged.data()[i] * difference[i];
    }
    for (int i = first; i < end; ++i) cell[measurements] += unchanged.data()[i];
  }
}

void TimeFilter::State::find_cell_changes() {
  const int rows = cells_of(height), stride = measurements + 1;
  std::array<float, max_measurements + 1> sums;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < cell_columns; ++column) {
      sums.fill(0.0f);
      for (int y = std::max(row - cell_reach, 0); y <= std::min(row + cell_reach, rows - 1); ++y)
        for (int x = std::max(column - cell_reach, 0);
             x <= std::min(column + cell_reach, cell_columns - 1); ++x) {
          const float* const cell = cells.data() + std::ptrdiff_t{y * cell_columns + x} * stride;
          for (int k = 0; k < stride; ++k) sums.data()[k] += cell[k];
        }
      float squares = 0.0f;
      for (int k = 0; k < measurements; ++k) squares += sums.data()[k] * sums.data()[k];
      const float chi2 = squares / std::max(sums.data()[measurements], 1.0f);
      cell_changes[static_cast<std::size_t>(row * cell_columns + column)] =
          shared_test.beyond(chi2) / static_cast<float>(measurements);
    }
  std::fill(cells.begin(), cells.end(), 0.0f);
}

void TimeFilter::State::add_row(const RawView& raw, int row) {
  Numbers numbers;
  BlockOfPixels averaged_now;
  for (int column = 0; column < width; column += block_pixels) {
    const int pixels = std::min(block_pixels, width - column);
    const std::ptrdiff_t first = pixel(row, column);
    read(raw, first, pixels, numbers, averaged_now);
    float* const weight = weights.data() + first;
    if (options.before_filter) {
      const float* const changes = cell_changes.data() + row / cell_side * cell_columns;
      for (int i = 0; i < pixels; ++i) {
        // What so many pixels share is not less after they are added: their sum's noise counts.
        const float changed = changes[(column + i) / cell_side] *
                              (1.0f / averaged.pixels[static_cast<std::size_t>(first + i)] +
                               1.0f / averaged_now.data()[i]);
        weight[i] /= 1.0f + weight[i] * changed;
      }
    }
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

}  // namespace tofsmith

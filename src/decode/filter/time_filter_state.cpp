// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/filter/time_filter_state.hpp"

#include <algorithm>
#include <utility>

#include "core/shared/pixel_runs.hpp"
#include "decode/filter/time_kernel.hpp"
#include "decode/raw_scale.hpp"
#include "decode/shared/marked_raw.hpp"

namespace tofsmith {

namespace {

int cells_of(int pixels) { return (pixels + cell_side - 1) / cell_side; }

}  // namespace

TimeFilter::State::State(const DecodingTable& table_, const TimeFilterOptions& options_,
                         const AmbientProjection& projection)
    : table(table_),
      options(options_),
      measurements(table.measurements()),
      levels(table),
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
  past.resize(raw);
  if (options.look_ahead > 0) future.resize(raw);
  waiting.clear();
  if (!options.before_filter) return;
  shares.assign(static_cast<std::size_t>(raw.pixels()), 0.0f);
  cell_columns = cells_of(width);
  cell_changes.assign(
      static_cast<std::size_t>(cells_of(height)) * static_cast<std::size_t>(cell_columns), 0.0f);
  cells.assign(cell_changes.size() * static_cast<std::size_t>(measurements + 1), 0.0f);
}

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

void TimeFilter::State::compare_row(const RawView& raw, const AddedFrames& added, int row,
                                    ComparedRows& compared, int compared_row) const {
  compared.clear(compared_row, static_cast<float>(measurements));
  if (row < 0 || row >= height) return;
  Numbers numbers;
  BlockOfPixels averaged_now;
  for (int column = 0; column < width; column += block_pixels) {
    const int pixels = std::min(block_pixels, width - column);
    const std::ptrdiff_t first = pixel(row, column);
    read(raw, first, pixels, numbers, averaged_now);
    compare_pixels(*this, added,
                   {.now = numbers.data(),
                    .averaged_now = averaged_now.data(),
                    .first = first,
                    .pixels = pixels,
                    .usable = compared.counts(compared_row) + column,
                    .difference = compared.difference(compared_row, 0) + column,
                    .difference_stride = compared.pitch(),
                    .chi2 = compared.chi2(compared_row) + column});
  }
}

void TimeFilter::State::weigh_row(const RawView& raw, AddedFrames& added, int row,
                                  ComparedRows& compared, int compared_row) {
  const int sums = compared.add_rows(compared_row - patch_reach);
  BlockOfPixels unchanged;
  for (int column = 0; column < width; column += block_pixels) {
    const int pixels = std::min(block_pixels, width - column);
    const std::ptrdiff_t first = pixel(row, column);
    weigh_pixels(*this, {.patch_chi2 = compared.chi2(sums) + column,
                         .counts = compared.counts(sums) + column,
                         .difference = compared.difference(sums, 0) + column,
                         .difference_stride = compared.pitch(),
                         .own_chi2 = compared.chi2(compared_row) + column,
                         .usable = compared.counts(compared_row) + column,
                         .past = added.averaged.pixels.data() + first,
                         .averaged_now = raw.averaged ? raw.averaged + first : nullptr,
                         .pixels = pixels,
                         // find_shares_of_row() handles invalid pixels.
                         .none = options.before_filter ? tells_nothing : 0.0f,
                         .weight = added.weights.data() + first,
                         .unchanged = unchanged.data()});
    if (options.before_filter) add_to_cells(row, column, pixels, unchanged, compared, compared_row);
  }
}

void TimeFilter::State::compare(const RawView& raw, AddedFrames& added, IndexRange rows) {
  const auto first = static_cast<int>(rows.begin), count = static_cast<int>(rows.end - rows.begin);
  std::unique_ptr<StripBuffers> buffer = buffers.take();
  ComparedRows compared(compared_strip_rows + 2 * patch_reach, width, measurements,
                        buffer->scratch);
  for (int row = 0; row < count + 2 * patch_reach; ++row)
    compare_row(raw, added, first + row - patch_reach, compared, row);
  for (int row = 0; row < count; ++row)
    weigh_row(raw, added, first + row, compared, row + patch_reach);
  buffers.give_back(std::move(buffer));
}

/// @param unchanged  1 if no test detected a change, else 0
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
      cell_changes.data()[std::ptrdiff_t{row} * cell_columns + column] =
          shared_test.beyond(chi2) / static_cast<float>(measurements);
    }
  std::fill(cells.begin(), cells.end(), 0.0f);
}

void TimeFilter::State::weigh_row_by_cells(const RawView& raw, AddedFrames& added, int row) const {
  const float* const changes = cell_changes.data() + row / cell_side * cell_columns;
  const std::ptrdiff_t first = pixel(row, 0);
  const float* const past = added.averaged.pixels.data() + first;
  float* const weight = added.weights.data() + first;
  for (int i = 0; i < width; ++i) {
    const float n = raw.averaged ? raw.averaged[first + i] : 1.0f;
    // A change common to many pixels does not decrease with averaging: compare it with the noise of
    // the average.
    const float changed = changes[i / cell_side] * (1.0f / past[i] + 1.0f / n);
    if (weight[i] > 0.0f) weight[i] /= 1.0f + weight[i] * changed;
  }
}

/// Computes the least share of the past kept by five adjacent pixels, divided by telling_share.
void TimeFilter::State::find_shares_of_row(const RawView& raw, const AddedFrames& added, int row) {
  const std::ptrdiff_t first = pixel(row, 0);
  const float* const weight = added.weights.data() + first;
  float* const share = shares.data() + first;
  std::fill_n(share, width, 1.0f);
  for (int x = 0; x < width; ++x) {
    const float most = most_weight(raw, added, first + x);
    if (weight[x] < 0.0f || most == 0.0f) continue;
    const float own = weight[x] / (telling_share * most);
    for (int i = std::max(x - patch_reach, 0); i <= std::min(x + patch_reach, width - 1); ++i)
      share[i] = std::min(share[i], own);
  }
}

void TimeFilter::State::weigh_row_by_shares(const RawView& raw, AddedFrames& added, int row) const {
  const std::ptrdiff_t first = pixel(row, 0);
  float* const weight = added.weights.data() + first;
  for (int y = std::max(row - patch_reach, 0); y <= std::min(row + patch_reach, height - 1); ++y) {
    const float* const share = shares.data() + pixel(y, 0);
    for (int i = 0; i < width; ++i)
      weight[i] = std::min(weight[i], share[i] * most_weight(raw, added, first + i));
  }
  for (int i = 0; i < width; ++i) weight[i] = std::max(weight[i], 0.0f);
}

void TimeFilter::State::weigh(const RawView& raw, AddedFrames& added) {
  parallel_for_blocks(height, compared_strip_rows,
                      [&](IndexRange rows) { compare(raw, added, rows); });
  if (!options.before_filter) return;
  find_cell_changes();
  for_each_row([&](int row) {
    weigh_row_by_cells(raw, added, row);
    find_shares_of_row(raw, added, row);
  });
  for_each_row([&](int row) { weigh_row_by_shares(raw, added, row); });
}

void TimeFilter::State::add_row(const RawView& raw, AddedFrames& added, int row) const {
  Numbers numbers;
  BlockOfPixels averaged_now;
  for (int column = 0; column < width; column += block_pixels) {
    const int pixels = std::min(block_pixels, width - column);
    const std::ptrdiff_t first = pixel(row, column);
    read(raw, first, pixels, numbers, averaged_now);
    add_pixels(numbers.data(), averaged_now.data(), added.weights.data() + first, measurements,
               pixels, mean(added, 0, first), std::ptrdiff_t{height} * width,
               added.averaged.pixels.data() + first);
  }
}

void TimeFilter::State::add(const RawView& raw, AddedFrames& added) {
  if (added.is_empty) std::fill(added.weights.begin(), added.weights.end(), 0.0f);
  added.is_empty = false;
  for_each_row([&](int row) { add_row(raw, added, row); });
}

RawView TimeFilter::State::view(const AddedFrames& added) const {
  return marked_view(RawView::planar(added.means.data(), height, width, measurements),
                     added.averaged.pixels.data());
}

void AddedFrames::resize(const RawView& raw) {
  const auto pixels = static_cast<std::size_t>(raw.pixels());
  means.assign(pixels * static_cast<std::size_t>(raw.measurements), 0.0f);
  weights.assign(pixels, 0.0f);
  averaged = Image<float>(raw.height, raw.width, 1.0f);
  is_empty = true;
}

}  // namespace tofsmith

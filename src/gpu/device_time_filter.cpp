// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/device_time_filter.hpp"

#include <fmt/format.h>

#include "gpu/device_tables.hpp"

namespace tofsmith {

namespace {

TimeTest test_of(const ChangeTest& test) { return {.certain = test.certain, .most = test.most}; }

/// Fills everything except the frame size. @param words  receives the tables
TimeParameters parameters_of(const TimeFilter::State& s, std::vector<std::uint32_t>& words) {
  TableWords tables(words);
  std::vector<float> to_plane = s.to_plane;
  const auto measurements = static_cast<std::size_t>(s.measurements);
  for (std::size_t i = 0; i < to_plane.size(); ++i) to_plane[i] *= s.gain[i % measurements];
  return {.height = 0,
          .width = 0,
          .cell_rows = 0,
          .cell_columns = 0,
          .gain = tables.add(s.gain),
          .dark_raw = tables.add(s.dark_raw),
          .floor_variance_e2 = tables.add(s.floor_variance_e2),
          .shot_per_signal = tables.add(s.shot_per_signal),
          .to_plane = tables.add(to_plane),
          .lowest = s.levels.lowest,
          .highest = s.levels.highest,
          .has_own_shot_noise = s.has_own_shot_noise ? 1 : 0,
          .hidden_floor_e2 = s.hidden.floor_variance_e2,
          .hidden_shot_per_signal = s.hidden.shot_per_signal,
          .mean_curve_square = s.hidden.mean_curve_square,
          .pixel = test_of(s.pixel_test),
          .patch = test_of(s.patch_test),
          .shared = test_of(s.shared_test),
          .max_weight = static_cast<float>(s.options.max_frames - 1),
          .none = s.options.before_filter ? tells_nothing : 0.0f,
          .telling_share = telling_share};
}

}  // namespace

DeviceTimeFilter::DeviceTimeFilter(const Device& device, const TimeFilter::State& state)
    : state_(state), queue_(device) {
  const std::string options = fmt::format(
      "-DMEASUREMENTS={} -DRANK={} -DPATCH_REACH={} -DCELL_SIDE={} -DCELL_REACH={}",
      state.measurements, static_cast<int>(state.hidden.rank), patch_reach, cell_side, cell_reach);
  const auto kernel = [&](const char* name) { return queue_.kernel(time_kernels, options, name); };
  compare_frames_ = kernel("compare_frames");
  weigh_side_ = kernel("weigh_side");
  add_to_cells_ = kernel("add_to_cells");
  find_cell_changes_ = kernel("find_cell_changes");
  weigh_by_cells_ = kernel("weigh_by_cells");
  find_shares_ = kernel("find_shares");
  weigh_by_shares_ = kernel("weigh_by_shares");
  add_frame_ = kernel("add_frame");
  std::vector<std::uint32_t> words;
  parameters_ = parameters_of(state, words);
  words_ = queue_.allocate(words.size() * sizeof(std::uint32_t));
  queue_.upload(words.data(), words_.bytes, words_);
}

void DeviceTimeFilter::begin_frame(int height, int width) {
  if (is_empty()) resize(height, width);
}

void DeviceTimeFilter::resize(int height, int width) {
  TimeParameters& p = parameters_;
  p.height = height;
  p.width = width;
  p.cell_rows = (height + cell_side - 1) / cell_side;
  p.cell_columns = (width + cell_side - 1) / cell_side;
  const std::int64_t pixels = std::int64_t{height} * width, floats = sizeof(float),
                     cells = std::int64_t{p.cell_rows} * p.cell_columns;
  means_.reserve_planes(queue_, pixels, state_.measurements);
  reserve(queue_, weights_, floats * pixels);
  reserve(queue_, planes_, floats * pixels * (time_difference + state_.measurements));
  reserve(queue_, cells_, floats * cells * (state_.measurements + 1));
  reserve(queue_, cell_changes_, floats * cells);
}

void DeviceTimeFilter::add(const RawView& raw) {
  begin_frame(raw.height, raw.width);
  frame_.upload(queue_, raw, 0, raw.pixels());
  add_frame(frame_);
}

void DeviceTimeFilter::add(const DeviceRaw& raw, int height, int width) {
  begin_frame(height, width);
  add_frame(raw);
}

void DeviceTimeFilter::add_frame(const DeviceRaw& raw) {
  weigh(raw);
  run(add_frame_, parameters_.height, parameters_.width, raw.tile(), raw.numbers(), raw.averaged(),
      &weights_, means_.numbers(), means_.averaged());
  is_empty_ = false;
}

void DeviceTimeFilter::weigh(const DeviceRaw& raw) {
  if (is_empty_) return queue_.clear(weights_);
  const int height = parameters_.height, width = parameters_.width,
            cell_rows = parameters_.cell_rows, cell_columns = parameters_.cell_columns;
  const DeviceMemory *const averaged = raw.averaged(), *const averaged_before = means_.averaged(),
                            *const weights = &weights_;
  run(compare_frames_, height, width, raw.tile(), &words_, raw.numbers(), averaged,
      means_.numbers(), averaged_before, &planes_);
  run(weigh_side_, height, width, averaged, averaged_before, &planes_, weights);
  if (!state_.options.before_filter) return;
  run(add_to_cells_, cell_rows, cell_columns, &planes_, &cells_);
  run(find_cell_changes_, cell_rows, cell_columns, &cells_, &cell_changes_);
  run(weigh_by_cells_, height, width, averaged, averaged_before, &cell_changes_, weights);
  run(find_shares_, height, width, averaged, averaged_before, weights, &planes_);
  run(weigh_by_shares_, height, width, averaged, averaged_before, &planes_, weights);
}

}  // namespace tofsmith

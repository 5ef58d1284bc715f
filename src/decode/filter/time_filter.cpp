// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include "decode/filter/time_filter_state.hpp"
#include "decode/output/pixel_output.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

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
  const auto strips = static_cast<std::size_t>(
      std::min(threads, (height + compared_strip_rows - 1) / compared_strip_rows));
  return sizeof(float) * (static_cast<std::size_t>(height) * static_cast<std::size_t>(width) *
                              static_cast<std::size_t>(measurements + 2) +
                          State::cell_floats(height, width, measurements) +
                          strips * ComparedRows::floats(compared_strip_rows + 2 * patch_reach,
                                                        width, measurements));
}

RawView TimeFilter::add(const RawView& raw) {
  State& state = *state_;
  require_measurements(raw, state.measurements);
  require(raw.height > 0 && raw.width > 0, "raw height and width", std::min(raw.height, raw.width),
          "must be > 0");
  if (state.is_empty) {
    state.resize(raw);
  } else {
    require(raw.height == state.height, "raw height", raw.height,
            "must equal that of the frames before, " + std::to_string(state.height));
    require(raw.width == state.width, "raw width", raw.width,
            "must equal that of the frames before, " + std::to_string(state.width));
    parallel_for_blocks(state.height, compared_strip_rows,
                        [&](IndexRange rows) { state.compare(raw, rows); });
    if (state.options.before_filter) state.find_cell_changes();
  }
  state.is_empty = false;
  parallel_for_blocks(state.height, compared_strip_rows, [&](IndexRange rows) {
    for (std::int64_t row = rows.begin; row < rows.end; ++row)
      state.add_row(raw, static_cast<int>(row));
  });
  RawView view = RawView::planar(state.means.data(), state.height, state.width, state.measurements);
  view.averaged = state.averaged.pixels.data();
  return view;
}

void TimeFilter::forget() { state_->is_empty = true; }

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include "decode/filter/shared/filter_parts.hpp"
#include "decode/output/pixel_output.hpp"
#include "decode/shared/marked_raw.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

void TimeFilterOptions::validate() const { check_fields(*this, "TimeFilterOptions::"); }

TimeFilter::TimeFilter(const DecodingTable& table, const TimeFilterOptions& options) {
  options.validate();
  table.validate();
  require_exposures(table, "the temporal filter");
  state_ = std::make_unique<State>(table, options, AmbientProjection(table));
}
TimeFilter::~TimeFilter() = default;
TimeFilter::TimeFilter(TimeFilter&&) noexcept = default;
TimeFilter& TimeFilter::operator=(TimeFilter&&) noexcept = default;

const TimeFilter::State& state_of(const TimeFilter& filter) { return *filter.state_; }

const DecodingTable& TimeFilter::table() const { return state_->table; }
const TimeFilterOptions& TimeFilter::options() const { return state_->options; }

std::size_t TimeFilter::memory_bytes(const TimeFilterOptions& options, int height, int width,
                                     int measurements, int threads) {
  const auto strips = static_cast<std::size_t>(
      std::min(threads, (height + compared_strip_rows - 1) / compared_strip_rows));
  const auto pixels = static_cast<std::size_t>(height) * static_cast<std::size_t>(width);
  const auto k_count = static_cast<std::size_t>(measurements);
  const auto ahead = static_cast<std::size_t>(options.look_ahead);
  const std::size_t frames =
      (ahead > 0 ? 2 * (k_count + 2) + (ahead + 1) * (k_count + 1) : k_count + 2) +
      (options.before_filter ? 1 : 0);
  return sizeof(float) * (pixels * frames + State::cell_floats(height, width, measurements) +
                          strips * ComparedRows::floats(compared_strip_rows + 2 * patch_reach,
                                                        width, measurements));
}

std::optional<RawView> TimeFilter::add(const RawView& stored) {
  State& state = *state_;
  const MarkedRaw marked(stored, state.table.marking);
  const RawView& raw = marked.view();
  require_measurements(raw, state.measurements);
  require(raw.height > 0 && raw.width > 0, "raw height and width", std::min(raw.height, raw.width),
          "must be > 0");
  if (state.is_empty()) {
    state.resize(raw);
  } else {
    require(raw.height == state.height, "raw height", raw.height,
            "must equal that of the previous frames, " + std::to_string(state.height));
    require(raw.width == state.width, "raw width", raw.width,
            "must equal that of the previous frames, " + std::to_string(state.width));
  }
  if (state.options.look_ahead > 0) {
    state.waiting.push(raw);
    if (state.waiting.count() <= state.options.look_ahead) return std::nullopt;
    return state.finish_oldest();
  }
  if (!state.past.is_empty) state.weigh(raw, state.past);
  state.add(raw, state.past);
  return state.view(state.past);
}

std::optional<RawView> TimeFilter::add_end() {
  if (state_->waiting.count() > 0) return state_->finish_oldest();
  forget();
  return std::nullopt;
}

void TimeFilter::forget() {
  state_->past.is_empty = true;
  state_->waiting.clear();
}

}  // namespace tofsmith

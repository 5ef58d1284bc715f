// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/filter.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "core/shared/enum_words.hpp"
#include "decode/filter/shared/filter_parts.hpp"
#include "decode/output/pixel_output.hpp"
#include "decode/shared/marked_raw.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {
constexpr EnumWords<FilterStrength, 3> strength_words("FilterStrength", "filter strength",
                                                      words_of(FilterStrength{}));
}  // namespace

std::string_view name_of(FilterStrength strength) { return strength_words.of(strength); }

FilterStrength parse_filter_strength(std::string_view name) { return strength_words.parse(name); }

FilterOptions FilterOptions::of(FilterStrength strength) {
  FilterOptions options;
  if (strength == FilterStrength::light) options.windows = 1, options.slope_rounds = 0;
  if (strength == FilterStrength::strong) options.slope_rounds = 2;
  return options;
}

void FilterOptions::validate() const { check_fields(*this, "FilterOptions::"); }

Filter::Filter(DecodingTable table, const FilterOptions& options) {
  options.validate();
  table.validate();
  require_exposures(table, "the filter");
  const AmbientProjection projection(table);
  plan_ = std::make_unique<const Plan>(std::move(table), options, projection);
}
Filter::~Filter() = default;
Filter::Filter(Filter&&) noexcept = default;
Filter& Filter::operator=(Filter&&) noexcept = default;

void require_filterable(const Filter::Plan& plan, const RawView& raw,
                        const Image<std::uint8_t>& left_out) {
  require_measurements(raw, plan.measurements);
  require(raw.height > 0 && raw.width > 0, "raw height and width", std::min(raw.height, raw.width),
          "must be > 0");
  require(left_out.empty() || (left_out.height == raw.height && left_out.width == raw.width),
          "left_out", std::to_string(left_out.height) + " x " + std::to_string(left_out.width),
          "must have the size of the frame");
}

const Filter::Plan& plan_of(const Filter& filter) { return *filter.plan_; }
FilterPlanes& planes_of(FilteredFrame& frame) { return *frame.planes_; }

const DecodingTable& Filter::table() const { return plan_->decoder.table(); }
const FilterOptions& Filter::options() const { return plan_->options; }

std::size_t Filter::memory_bytes(const FilterOptions& options, int height, int width,
                                 int measurements, int threads) {
  const int step = window_step(options.windows - 1);
  const FilterGrid grid = FilterPlanes::grid_of(height, width, step);
  const FilterStrip strip{.first_row = 0, .rows = filter_rows, .step = step};
  const auto strips =
      static_cast<std::size_t>(std::min(threads, (height + filter_rows - 1) / filter_rows));
  const std::size_t weights = options.slope_rounds > 0 ? 2 : 1;
  return sizeof(float) *
         (FilterPlanes::floats(grid, measurements) +
          (options.slope_rounds > 0 ? 2 : 1) * static_cast<std::size_t>(height) *
              static_cast<std::size_t>(width) +
          strips * (weights * weight_floats(grid, strip) + scratch_floats(grid, strip)));
}

void Filter::apply(const RawView& stored, FilteredFrame& filtered, const Progress& progress,
                   const Image<std::uint8_t>& left_out) const {
  const Plan& plan = *plan_;
  const MarkedRaw marked(stored, plan.decoder.table().marking);
  const RawView& raw = marked.view();
  require_filterable(plan, raw, left_out);
  FilterPlanes& frame = *filtered.planes_;
  const int windows = plan.options.windows;
  frame.resize(raw.height, raw.width, plan.measurements, window_step(windows - 1));
  const double steps = windows * (1 + plan.options.slope_rounds);
  int done = 0;
  const auto step_done = [&] { report(progress, ++done / steps, "filtering"); };

  frame.left_out = left_out.empty() ? nullptr : left_out.pixels.data();
  plan.read(raw, frame);
  int from = 0, to = 1;
  for (int window = 0; window < windows; ++window) {
    plan.add_similar(frame, from, to, window);
    std::swap(from, to);
    step_done();
  }
  for (int round = 0; round < plan.options.slope_rounds; ++round) {
    if (round == 0) plan.leave_dark(raw, frame, from, to);
    plan.find_depth(raw, frame, from, to);
    plan.read_again(raw, frame, to, FilterPlanes::signal);
    for (int window = 0; window < windows; ++window) {
      plan.add_along_slopes(frame, window == 0 ? to : from, to, from, window);
      step_done();
    }
    plan.add_slope_noise(frame, round);
  }
  frame.result = from;
  frame.reserve_deviation_factors(plan.options.slope_rounds > 0);
  frame.noise = plan.noise_ratios();
  plan.finish(raw, frame, from, to);
}

FilteredFrame Filter::apply(const RawFrames& raw, int frame, const Progress& progress) const {
  FilteredFrame filtered;
  apply(view_of_frame(raw, frame), filtered, progress);
  return filtered;
}

}  // namespace tofsmith

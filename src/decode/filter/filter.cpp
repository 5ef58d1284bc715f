// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/filter.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "decode/filter/shared/filter_parts.hpp"
#include "decode/output/pixel_output.hpp"
#include "decode/shared/marked_raw.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/statistics.hpp"

namespace tofsmith {

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
  plan_ = make_hidden<const Plan>(std::move(table), options, projection);
}

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

namespace {

constexpr int block_side = 8;
constexpr std::size_t min_blocks = 16;
constexpr double flattest_share = 0.25;
constexpr double median_of_normal = 0.6745;  // of |x| of a standard normal variable

/// Second differences along one direction of a block [standard deviations].
class Differences {
 public:
  Differences(FilterPlanes& frame, int rank) : frame_(frame), rank_(rank) {}

  /// Returns the median of the absolute values; none if fewer than half are known.
  std::optional<double> median_of(int first_row, int first_column, std::ptrdiff_t step) {
    found_.clear();
    for (int row = first_row; row < first_row + block_side; ++row)
      for (int column = first_column; column < first_column + block_side; ++column)
        add(row * frame_.grid.stride + column, step);
    if (found_.size() < static_cast<std::size_t>(rank_ * block_side * block_side / 2)) return {};
    return quantile_of(found_, 0.5);
  }

 private:
  void add(std::ptrdiff_t at, std::ptrdiff_t step) {
    const float* const usable = frame_.scalar(FilterPlanes::usable) + at;
    if (!(usable[0] * usable[step] * usable[-step] > 0.0f)) return;
    const float* const v = frame_.scalar(FilterPlanes::variance) + at;
    const double sigma = std::sqrt(static_cast<double>(v[step] + 4.0f * v[0] + v[-step]));
    for (int j = 0; j < rank_; ++j) {
      const float* const u = frame_.light(0, j) + at;
      found_.push_back(std::abs(static_cast<double>(u[step] - 2.0f * u[0] + u[-step])) / sigma);
    }
  }

  FilterPlanes& frame_;
  int rank_;
  std::vector<double> found_;
};

/// Returns at most 128 rows in the middle of a frame.
RawView middle_rows(RawView raw) {
  constexpr int max_rows = 128;
  const int rows = std::min(raw.height, max_rows), first = (raw.height - rows) / 2;
  std::visit([&](auto& data) { data += first * raw.row_stride; }, raw.data);
  if (raw.averaged) raw.averaged += std::ptrdiff_t{first} * raw.width;
  raw.height = rows;
  return raw;
}

}  // namespace

std::optional<double> measured_noise_ratio(const Filter& filter, const RawView& whole) {
  const Filter::Plan& plan = plan_of(filter);
  const RawView stored = middle_rows(whole);
  const MarkedRaw marked(stored, plan.decoder.table().marking);
  const RawView& raw = marked.view();
  require_filterable(plan, raw, {});
  FilterPlanes frame;
  frame.resize(raw.height, raw.width, plan.measurements, 1);
  plan.read(raw, frame);
  Differences differences(frame, plan.rank);
  std::vector<double> medians;
  for (int row = 0; row + block_side <= raw.height; row += block_side)
    for (int column = 0; column + block_side <= raw.width; column += block_side) {
      const auto along = differences.median_of(row, column, 1),
                 down = differences.median_of(row, column, frame.grid.stride);
      if (along && down) medians.push_back(std::min(*along, *down));
    }
  if (medians.size() < min_blocks) return {};
  return quantile_of(medians, flattest_share) / median_of_normal;
}

}  // namespace tofsmith

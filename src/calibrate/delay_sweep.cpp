// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/calibrate/correlation_calibration.hpp"

#include <fmt/format.h>

#include <cmath>

#include "calibrate/sweep_pixels.hpp"
#include "io/arrays/shared/array_matrix.hpp"
#include "io/arrays/shared/sample_times.hpp"
#include "io/shared/read_file.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/io/raw_frames.hpp"

namespace tofsmith {
namespace {

double periods_per_number(DelayUnit unit, const Camera& camera) {
  switch (unit) {
    case DelayUnit::metre:
      return 1.0 / unambiguous_range_m(camera.fundamental_frequency_hz);
    case DelayUnit::bin:
      return 1.0 / camera.samples;
    case DelayUnit::period:
      return 1.0;
    default:
      return seconds_per_unit(name_of(unit)) * camera.fundamental_frequency_hz;
  }
}

RawFrames frames_of(const Eigen::MatrixXd& values) {
  RawFrames frames{.frames = static_cast<int>(values.rows()),
                   .height = 1,
                   .width = 1,
                   .measurements = static_cast<int>(values.cols())};
  for (Eigen::Index f = 0; f < values.rows(); ++f)
    for (Eigen::Index k = 0; k < values.cols(); ++k)
      frames.values.push_back(static_cast<float>(values(f, k)));
  return frames;
}

std::vector<double> shifts_of(const std::filesystem::path& path, DecimalMark decimal,
                              std::vector<std::string>& notes) {
  if (lower_extension(path) == ".npy") return read_one_axis(path);
  const NumberTable table = read_number_column(path, "the shifts", decimal);
  notes.insert(notes.end(), table.notes.begin(), table.notes.end());
  return {table.values.col(0).begin(), table.values.col(0).end()};
}

DelaySweep read_text(const std::filesystem::path& path, const Camera& camera,
                     const DelaySweepOptions& options) {
  const NumberTable table = read_number_table(path, {.decimal = options.decimal, .min_columns = 2});
  if (table.values.cols() < 2)
    throw IoError(path.string(),
                  "found one column; expected the delay and a value for each "
                  "measurement");
  // A row counter may precede the delays.
  const Eigen::Index delay = counts_samples(table, 0) && is_named_time(table, 1) ? 1 : 0;
  double periods = periods_per_number(options.unit, camera);
  if (options.unit == DelayUnit::second && !table.names.empty())
    if (const double unit_s = seconds_per_unit(table.names[static_cast<std::size_t>(delay)]);
        unit_s > 0.0)
      periods = unit_s * camera.fundamental_frequency_hz;
  DelaySweep sweep;
  sweep.notes = table.notes;
  for (const double value : table.values.col(delay)) sweep.delay_periods.push_back(value * periods);
  sweep.frames = frames_of(table.values.rightCols(table.values.cols() - 1 - delay));
  return sweep;
}

DelaySweep read_stack(const std::filesystem::path& path, const Camera& camera,
                      const DelaySweepOptions& options) {
  DelaySweep sweep;
  sweep.frames = read_raw_frames(path);
  const std::vector<double> shifts = shifts_of(options.shifts, options.decimal, sweep.notes);
  if (std::ssize(shifts) != sweep.frames.frames)
    throw IoError(options.shifts.string(),
                  fmt::format("found {} shifts; expected {}, one per frame of {}", shifts.size(),
                              sweep.frames.frames, path.string()));
  for (std::size_t i = 0; i < shifts.size(); ++i) {
    if (!std::isfinite(shifts[i]))
      throw IoError(fmt::format("{}[{}]", options.shifts.string(), i),
                    fmt::format("found {}; expected a finite number", shifts[i]));
    sweep.delay_periods.push_back(shifts[i] * periods_per_number(options.unit, camera));
  }
  return sweep;
}

}  // namespace

void DelaySweep::validate() const {
  require(std::ssize(delay_periods) == frames.frames, "delays", delay_periods.size(),
          fmt::format("must be {}, one per frame", frames.frames));
  const auto needed = static_cast<std::size_t>(frames.frames) * frames.pixels_per_frame() *
                      static_cast<std::size_t>(frames.measurements);
  require(needed > 0 && frames.values.size() == needed, "frames", frames.values.size(),
          "must have F x H x W x K values");
  require_whole_period(delay_groups(delay_periods));
}

DelaySweep read_delay_sweep(const std::filesystem::path& path, const Camera& camera,
                            const DelaySweepOptions& options) {
  DelaySweep sweep;
  if (is_number_table(path)) {
    if (!options.shifts.empty())
      throw IoError(
          path.string(),
          "is a table, whose first column is the delay; expected no separate list of shifts");
    sweep = read_text(path, camera, options);
  } else if (!options.shifts.empty()) {
    sweep = read_stack(path, camera, options);
  } else {
    const MeasuredTableFile file = read_measured_table(
        path,
        {.layout = {.taps = options.tap_order ? camera.sensor.taps : 1, .order = options.tap_order},
         .axes = options.table_axes,
         .keep_end_point = options.keep_end_point});
    sweep.frames = frames_of(file.table.correlation);
    sweep.notes = file.notes;
    const int count = file.table.samples();
    sweep.notes.push_back(fmt::format(
        "{}: its {} rows were interpreted as equal steps of one period", path.string(), count));
    for (int n = 0; n < count; ++n) sweep.delay_periods.push_back(static_cast<double>(n) / count);
  }
  try {
    sweep.validate();
  } catch (const std::invalid_argument& error) {
    throw IoError(path.string(), error.what());
  }
  return sweep;
}

}  // namespace tofsmith

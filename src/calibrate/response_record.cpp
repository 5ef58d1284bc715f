// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/calibrate/impulse_response.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/arrays/shared/array_matrix.hpp"
#include "io/arrays/shared/sample_times.hpp"
#include "io/shared/read_file.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/statistics.hpp"

namespace tofsmith {
namespace {

constexpr double equal_steps = 0.01;  // allows for times with few digits
constexpr double longest_gap = 10.0;  // in steps
constexpr Eigen::Index min_values = 16;

double median_step(const Eigen::VectorXd& time_s) {
  std::vector<double> steps;
  for (Eigen::Index i = 1; i < time_s.size(); ++i) steps.push_back(time_s[i] - time_s[i - 1]);
  return median_of(std::move(steps));
}

Eigen::VectorXd resampled(const Eigen::VectorXd& time_s, const Eigen::VectorXd& values,
                          double step_s) {
  const double span_s = time_s[time_s.size() - 1] - time_s[0];
  const auto count = static_cast<Eigen::Index>(std::floor(span_s / step_s + 1e-9)) + 1;
  Eigen::VectorXd result(count);
  Eigen::Index after = 1;
  for (Eigen::Index i = 0; i < count; ++i) {
    const double t = time_s[0] + step_s * static_cast<double>(i);
    while (after + 1 < time_s.size() && time_s[after] < t) ++after;
    const double share =
        std::clamp((t - time_s[after - 1]) / (time_s[after] - time_s[after - 1]), 0.0, 1.0);
    result[i] = values[after - 1] + share * (values[after] - values[after - 1]);
  }
  return result;
}

void set_times(ResponseRecord& record, const Eigen::VectorXd& time_s,
               const std::vector<std::size_t>& lines, const std::string& file) {
  const double step_s = median_step(time_s);
  double largest = 0.0;
  for (Eigen::Index i = 1; i < time_s.size(); ++i) {
    const double gap_s = time_s[i] - time_s[i - 1];
    const std::string place = fmt::format("{}:{}", file, lines[static_cast<std::size_t>(i)]);
    if (!(gap_s > 0.0))
      throw IoError(place,
                    fmt::format("found the time {:.9g} s after {:.9g} s; expected increasing times",
                                time_s[i], time_s[i - 1]));
    if (gap_s > longest_gap * step_s)
      throw IoError(place, fmt::format("found a gap of {:.4g} s between two times; expected at "
                                       "most {:.0f} steps of {:.4g} s",
                                       gap_s, longest_gap, step_s));
    largest = std::max(largest, std::abs(gap_s - step_s));
  }
  record.start_time_s = time_s[0];
  // The median of rounded times is one of two adjacent values.
  const double mean_step_s =
      (time_s[time_s.size() - 1] - time_s[0]) / static_cast<double>(time_s.size() - 1);
  double strayed = 0.0;
  for (Eigen::Index i = 0; i < time_s.size(); ++i)
    strayed =
        std::max(strayed, std::abs(time_s[i] - time_s[0] - mean_step_s * static_cast<double>(i)));
  record.time_step_s = mean_step_s;
  if (strayed <= equal_steps * mean_step_s) return;
  if (strayed <= mean_step_s && largest <= 0.5 * step_s) {
    record.notes.push_back(
        fmt::format("{}: its times deviate from equal steps by up to {:.2g} of a step, and the "
                    "values were resampled by linear interpolation",
                    file, strayed / mean_step_s));
  } else {
    record.time_step_s = step_s;
    record.notes.push_back(
        fmt::format("{}: its times are not equally spaced (steps off by up to {:.3g} of {:.4g} s); "
                    "the values were resampled by linear interpolation",
                    file, largest / step_s, step_s));
  }
  record.values = resampled(time_s, record.values, record.time_step_s);
}

void read_text(const std::filesystem::path& path, const ResponseRecordOptions& options,
               ResponseRecord& record) {
  const std::string file = path.string();
  const NumberTable table = read_number_table(path, {.decimal = options.decimal});
  TimedSamples samples =
      timed_samples_of(table, file, {options.time_step_s, options.time_unit_s, options.column});
  record.notes = std::move(samples.notes);
  record.values = std::move(samples.values);
  if (samples.time_s.size() > 1) set_times(record, samples.time_s, table.lines, file);
}

void read_array(const std::filesystem::path& path, ResponseRecord& record) {
  const std::vector<double> values = read_one_axis(path);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!is_measured(values[i]))
      throw IoError(fmt::format("{}[{}]", path.string(), i),
                    fmt::format("found {}; expected a finite, measured number", values[i]));
  record.values =
      Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

bool are_counts(const Eigen::VectorXd& values) {
  return values.minCoeff() >= 0.0 && values.maxCoeff() >= 10.0 &&
         (values.array() == values.array().round()).all();
}

}  // namespace

ResponseRecord read_response_record(const std::filesystem::path& path,
                                    const ResponseRecordOptions& options) {
  if (options.time_step_s)
    require(std::isfinite(*options.time_step_s) && *options.time_step_s > 0.0, "time_step_s",
            *options.time_step_s, "must be finite and > 0");
  ResponseRecord record;
  if (lower_extension(path) == ".npy")
    read_array(path, record);
  else
    read_text(path, options, record);
  if (record.values.size() < min_values)
    throw IoError(path.string(), fmt::format("found {} values; expected at least {}",
                                             record.values.size(), min_values));
  if (record.time_step_s == 0.0) {
    if (!options.time_step_s)
      throw IoError(path.string(), "found values without times; expected --time-step");
    record.time_step_s = *options.time_step_s;
  }
  record.counts = are_counts(record.values);
  return record;
}

}  // namespace tofsmith

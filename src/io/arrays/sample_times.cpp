// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/arrays/shared/sample_times.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/shared/text_numbers.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

using Eigen::Index;

/// Names in oscilloscope headers, as letters_and_digits().
constexpr std::array<std::string_view, 18> interval_names = {
    "increment",   "xincrement",       "xincr",          "xinc",         "xin",
    "tinc",        "tincrement",       "timeincrement",  "deltat",       "dt",
    "timestep",    "timeinterval",     "sampleinterval", "sampleperiod", "samplingperiod",
    "hresolution", "samplinginterval", "horizinterval"};

bool names_interval(std::string_view text) {
  const std::string word = letters_and_digits(text.substr(0, text.find('(')));
  return std::ranges::find(interval_names, word) != interval_names.end();
}

/// Parses "1e-10", "1e-10 s", "0,01uS" or "Analog:1e-10"; none if not a time > 0.
std::optional<double> interval_s_in(std::string_view text) {
  if (const std::size_t colon = text.rfind(':'); colon != std::string_view::npos)
    text.remove_prefix(colon + 1);
  std::string copy(trimmed(text));
  std::ranges::replace(copy, ',', '.');
  std::string_view rest = copy;
  if (rest.starts_with('+')) rest.remove_prefix(1);
  const std::optional<double> number = take_number(rest);
  if (!number) return std::nullopt;
  const double time_s = *number * (trimmed(rest).empty() ? 1.0 : seconds_per_unit(rest));
  return time_s > 0.0 && is_measured(time_s) ? std::optional(time_s) : std::nullopt;
}

/// Finds "name = value" in a cell, or a value in the cell after or below the name.
std::optional<double> stated_interval_s(const NumberTable& table) {
  const auto& header = table.header;
  for (std::size_t row = 0; row < header.size(); ++row)
    for (std::size_t i = 0; i < header[row].size(); ++i) {
      const std::string_view cell = header[row][i];
      const std::size_t sign = std::min(cell.find_first_of("=:"), cell.size());
      if (!names_interval(cell.substr(0, sign))) continue;
      const auto after = std::find_if(header[row].begin() + static_cast<std::ptrdiff_t>(i) + 1,
                                      header[row].end(), [](const auto& c) { return !c.empty(); });
      std::optional<double> found;
      if (sign < cell.size()) found = interval_s_in(cell.substr(sign + 1));
      if (!found && after != header[row].end()) found = interval_s_in(*after);
      if (!found && row + 1 < header.size() && i < header[row + 1].size())
        found = interval_s_in(header[row + 1][i]);
      if (found) return found;
    }
  return std::nullopt;
}

double unit_of(const NumberTable& table, Index column) {
  const auto i = static_cast<std::size_t>(column);
  for (const auto* names : {&table.names, &table.upper_names})
    if (!names->empty())
      if (const double unit_s = seconds_per_unit((*names)[i]); unit_s > 0.0) return unit_s;
  return 0.0;
}

bool increases(const Eigen::VectorXd& values) {
  const Index last = values.size() - 1;
  return last >= 1 && (values.tail(last).array() > values.head(last).array()).all();
}

std::optional<Index> time_column(const NumberTable& table, bool has_interval) {
  for (Index c = 0; c < table.values.cols(); ++c)
    if (is_named_time(table, c) && table.values.cols() > 1) return c;
  if (table.values.cols() < 2 || (has_interval && !increases(table.values.col(0))))
    return std::nullopt;
  return 0;
}

/// Returns the selected column, or the only one without times or sample numbers.
Index value_column(const NumberTable& table, std::optional<Index> time, const std::string& wanted,
                   const std::string& file) {
  if (!wanted.empty()) return table.column_of(wanted, file);
  std::vector<Index> candidates;
  for (Index c = 0; c < table.values.cols(); ++c)
    if (c != time && !(c == 0 && time && counts_samples(table, c))) candidates.push_back(c);
  if (candidates.size() == 1) return candidates.front();
  throw IoError(file, fmt::format("found {}; expected --column to select the values",
                                  table.describe_columns()));
}

Eigen::VectorXd equal_times(Index count, double step_s) {
  return step_s * Eigen::VectorXd::LinSpaced(count, 0.0, static_cast<double>(count - 1));
}

Eigen::VectorXd times_in_seconds(const NumberTable& table, Index column, const std::string& file,
                                 const SampleTimeOptions& options, std::optional<double> interval_s,
                                 std::vector<std::string>& notes) {
  constexpr double shortest_step_s = 1e-15;
  constexpr double tolerance = 0.01;
  const Eigen::VectorXd times = table.values.col(column);
  const double span = times[times.size() - 1] - times[0];
  const double step = span / static_cast<double>(std::max<Index>(1, times.size() - 1));
  double unit_s = options.time_unit_s.value_or(unit_of(table, column));
  const bool is_stated = interval_s && std::abs(step / *interval_s - 1.0) < tolerance;
  const bool is_too_short =
      step >= shortest_step_s && unit_s > 0.0 && unit_s * step < shortest_step_s;
  if (is_stated || is_too_short) {
    if (options.time_unit_s && *options.time_unit_s != 1.0)
      notes.push_back(
          fmt::format("{}: its times were read as seconds, in which their steps are "
                      "{:.3g}; --time-unit was not used",
                      file, step));
    unit_s = 1.0;
  } else if (unit_s == 0.0) {
    notes.push_back(fmt::format(
        "{}: its times were interpreted as seconds (--time-unit overrides this)", file));
    unit_s = 1.0;
  }
  return unit_s * times;
}

}  // namespace

double seconds_per_unit(std::string_view column_name) {
  std::string lower(column_name);
  std::ranges::transform(lower, lower.begin(), lower_case);
  for (const std::string_view micro : {"\xc2\xb5", "\xce\xbc", "\xb5"})  // UTF-8 and Latin-1
    if (const std::size_t at = lower.rfind(micro); at != std::string::npos)
      lower.replace(at, micro.size(), "u");
  // The unit is in brackets or after an underscore.
  while (!lower.empty() && !is_letter(lower.back())) lower.pop_back();
  std::size_t begin = lower.size();
  while (begin > 0 && is_letter_or_digit(lower[begin - 1])) --begin;
  const std::string unit = lower.substr(begin);
  constexpr std::array<std::pair<std::string_view, double>, 13> units{{{"s", 1.0},
                                                                       {"sec", 1.0},
                                                                       {"second", 1.0},
                                                                       {"seconds", 1.0},
                                                                       {"ms", 1e-3},
                                                                       {"milliseconds", 1e-3},
                                                                       {"us", 1e-6},
                                                                       {"microseconds", 1e-6},
                                                                       {"ns", 1e-9},
                                                                       {"nanoseconds", 1e-9},
                                                                       {"ps", 1e-12},
                                                                       {"picoseconds", 1e-12},
                                                                       {"fs", 1e-15}}};
  for (const auto& [name, seconds] : units)
    if (unit == name) return seconds;
  return 0.0;
}

bool is_named_time(const NumberTable& table, Index column) {
  if (unit_of(table, column) > 0.0) return true;
  const auto is_time = [&](const std::vector<std::string>& names) {
    if (names.empty()) return false;
    const std::string& name = names[static_cast<std::size_t>(column)];
    const std::string word = letters_and_digits(name.substr(0, name.find_first_of("([")));
    return word == "time" || word == "t" || word == "zeit";
  };
  return is_time(table.names) || is_time(table.upper_names);
}

bool counts_samples(const NumberTable& table, Index column) {
  const Eigen::VectorXd values = table.values.col(column);
  if (values.size() < 2 || values[0] != std::floor(values[0]) || unit_of(table, column) > 0.0)
    return false;
  const Eigen::VectorXd expected = values[0] + equal_times(values.size(), 1.0).array();
  return values == expected;
}

TimedSamples timed_samples_of(const NumberTable& table, const std::string& file,
                              const SampleTimeOptions& options) {
  const std::optional<double> interval_s = stated_interval_s(table);
  const std::optional<Index> time = time_column(table, interval_s.has_value());
  const Index column = value_column(table, time, options.column, file);
  TimedSamples samples{table.values.col(column), {}, table.notes};
  const bool has_times = time && *time != column;
  if (options.time_step_s) {
    if (has_times)
      samples.notes.push_back(
          fmt::format("{}: its times were not read: --time-step overrides them", file));
    return samples;
  }
  const bool is_counter = has_times && counts_samples(table, *time);
  if (interval_s && (is_counter || !has_times)) {
    samples.time_s = equal_times(samples.values.size(), *interval_s);
    samples.notes.push_back(
        fmt::format("{}: its times follow from the sampling interval in its header, {:.6g} s{}",
                    file, *interval_s, options.time_unit_s ? "; --time-unit was not used" : ""));
  } else if (is_counter && !options.time_unit_s) {
    throw IoError(file, fmt::format("found a sample counter in column {} and no sampling interval; "
                                    "expected --time-step, the time between two values [s], or "
                                    "--time-unit if the column holds times",
                                    table.first_column + static_cast<std::size_t>(*time)));
  } else if (has_times) {
    if (is_counter)
      samples.notes.push_back(
          fmt::format("{}: column {} looks like a sample counter and was read as times in the unit "
                      "of --time-unit; if it counts, use --time-step instead",
                      file, table.first_column + static_cast<std::size_t>(*time)));
    samples.time_s = times_in_seconds(table, *time, file, options, interval_s, samples.notes);
  }
  return samples;
}

}  // namespace tofsmith

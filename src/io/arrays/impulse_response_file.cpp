// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/measured_table_file.hpp"

#include <fmt/format.h>

#include <cmath>

#include "io/arrays/shared/array_matrix.hpp"
#include "io/arrays/shared/sample_times.hpp"
#include "io/shared/read_file.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/number_table.hpp"

namespace tofsmith {
namespace {

// Relative to the time step, for times with few digits.
constexpr double time_tolerance = 0.01;

double time_step_of(const Eigen::VectorXd& time_s, const std::string& file) {
  const Eigen::Index last = time_s.size() - 1;
  if (last < 1) throw IoError(file, "found one time; expected at least two, to determine the step");
  const double step_s = (time_s[last] - time_s[0]) / static_cast<double>(last);
  if (!(step_s > 0.0))
    throw IoError(file, "found times that do not increase; expected increasing times");
  for (Eigen::Index i = 0; i <= last; ++i) {
    const double expected_s = time_s[0] + step_s * static_cast<double>(i);
    if (std::abs(time_s[i] - expected_s) > time_tolerance * step_s)
      throw IoError(file, fmt::format("row {}: found the time {} s; expected {} s: times must be "
                                      "equally spaced",
                                      i, time_s[i], expected_s));
  }
  return step_s;
}

void read_text(const std::filesystem::path& path, std::optional<double> time_step_s,
               ImpulseResponse& response) {
  const NumberTable table = read_number_table(path);
  // Sample numbers cannot be compared with a given step.
  const SampleTimeOptions counted{.time_step_s = time_step_s};
  const TimedSamples samples = timed_samples_of(
      table, path.string(), counts_samples(table, 0) ? counted : SampleTimeOptions{});
  if (samples.time_s.size() > 0) response.time_step_s = time_step_of(samples.time_s, path.string());
  response.samples.assign(samples.values.begin(), samples.values.end());
}

}  // namespace

ImpulseResponse read_impulse_response(const std::filesystem::path& path,
                                      std::optional<double> time_step_s) {
  ImpulseResponse response;
  response.kind = ImpulseResponse::Kind::file;
  response.file = path.string();
  if (known_extension(path, {".csv", ".txt", ".tsv", ".dat", ".npy"}) == ".npy")
    response.samples = read_one_axis(path);
  else
    read_text(path, time_step_s, response);
  const double found_s = response.time_step_s;
  if (found_s == 0.0 && !time_step_s)
    throw IoError(path.string(),
                  "found values without times; expected time_step_s in addition to `file`");
  if (found_s != 0.0 && time_step_s && std::abs(found_s - *time_step_s) > time_tolerance * found_s)
    throw IoError(path.string(), fmt::format("found times {} s apart; expected time_step_s = {}",
                                             found_s, *time_step_s));
  response.time_step_s = time_step_s.value_or(found_s);
  try {
    response.validate("impulse_response");
  } catch (const std::invalid_argument& error) {
    throw IoError(path.string(), error.what());
  }
  return response;
}

void write_impulse_response(const std::filesystem::path& path, const ImpulseResponse& response,
                            OutputPolicy policy) {
  response.validate("impulse_response");
  std::string text = "time_s,value\n";
  for (std::size_t i = 0; i < response.samples.size(); ++i)
    text += fmt::format("{:.17g},{:.9g}\n", response.time_step_s * static_cast<double>(i),
                        response.samples[i]);
  write_file_atomically(path, text, policy);
}

}  // namespace tofsmith

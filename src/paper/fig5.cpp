// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "paper/data_tables.hpp"
#include "paper/figures.hpp"
#include "tofsmith/report/figure.hpp"

namespace tofsmith {

namespace {

constexpr double f0_hz = 15e6;
const std::vector<double> limits_in_f0 = {20, 10, 5};

ImpulseResponse hann(double f_max_in_f0) {
  ImpulseResponse response;
  response.kind = ImpulseResponse::Kind::hann;
  response.f_max_hz = f_max_in_f0 * f0_hz;
  return response;
}

/// A Hann window of width 1.444 / f_max, sampled over a period and scaled to sum 1.
std::vector<double> sampled_window(double f_max_in_f0, int samples) {
  const double width = 1.444 / f_max_in_f0;  // periods
  std::vector<double> values(static_cast<std::size_t>(samples), 0.0);
  double sum = 0.0;
  for (int n = 0; n < samples; ++n) {
    const double t = static_cast<double>(n) / samples - 0.5;
    if (std::abs(t) >= 0.5 * width) continue;
    sum += values[static_cast<std::size_t>(n)] =
        0.5 * (1.0 + std::cos(2.0 * std::numbers::pi * t / width));
  }
  for (double& value : values) value /= sum;
  return values;
}

/// The lowest frequency at which |H| falls to 1/5 [Hz], found on the response itself.
double measured_f_max_hz(const ImpulseResponse& response) {
  double low = 0.0, high = 100.0 * f0_hz;
  for (double f = 0.0; f < 100.0 * f0_hz; f += 0.01 * f0_hz)
    if (std::abs(response.transfer(f)) < 0.2) {
      low = f - 0.01 * f0_hz;
      high = f;
      break;
    }
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (std::abs(response.transfer(middle)) < 0.2 ? high : low) = middle;
  }
  return high;
}

/// Transform of the sampled window at a harmonic of f0: independent of the closed form.
double sampled_transfer(const std::vector<double>& response, int harmonic) {
  double sum = 0.0;
  const auto samples = static_cast<double>(response.size());
  for (std::size_t n = 0; n < response.size(); ++n)
    sum += response[n] *
           std::cos(2.0 * std::numbers::pi * harmonic * (static_cast<double>(n) / samples - 0.5));
  return sum;
}

}  // namespace

Reproduction reproduce_fig5(const ReproduceContext&, const Progress&) {
  constexpr int samples = 960;
  Reproduction result;
  std::vector<Series> in_time, in_frequency;
  std::vector<std::vector<double>> rows;
  bool holds = true;
  for (const double limit : limits_in_f0) {
    const ImpulseResponse response = hann(limit);
    const std::string name = fmt::format("f_max = {:g} f0", limit);
    static constexpr std::array colours = {"#009e73", "#0072b2", "#d55e00"};
    const LineStyle style{colours[in_time.size()]};

    // 1. The window in time.
    const std::vector<double> values = sampled_window(limit, samples);
    Series time{.name = name, .y = values, .style = style};
    for (int n = 0; n < samples; ++n)
      time.x.push_back((static_cast<double>(n) / samples - 0.5) / f0_hz * 1e9);
    in_time.push_back(time);

    // 2. Its transfer function, and where that is 1/5.
    Series frequency{.name = name, .style = style};
    for (double f = 0.0; f <= 40.0; f += 0.1) {
      frequency.x.push_back(f);
      frequency.y.push_back(std::abs(response.transfer(f * f0_hz)));
    }
    in_frequency.push_back(frequency);
    const double found_in_f0 = measured_f_max_hz(response) / f0_hz;
    const double at_limit = std::abs(sampled_transfer(values, static_cast<int>(limit)));
    holds = holds && std::abs(found_in_f0 / limit - 1.0) < 1e-3 && std::abs(at_limit - 0.2) < 1e-3;
    rows.push_back({limit, found_in_f0, at_limit});
    result.arrays[fmt::format("response_{:g}f0", limit)] = npy_of(values);
  }
  in_frequency.push_back(
      {.name = "1/5", .x = {0, 40}, .y = {0.2, 0.2}, .style = reference_style()});

  // 3. What the paper says of it.
  result.findings = {
      {holds ? Verdict::holds : Verdict::fails,
       "A Hann window models the arms' impulse response; f_max is the highest "
       "frequency that is not attenuated more than about 5 times.",
       fmt::format("|H| reaches 1/5 at {:.4f}, {:.4f} and {:.4f} f0 for windows made "
                   "for 20, 10 and 5 f0; the sampled windows' own transforms give "
                   "{:.4f}, {:.4f} and {:.4f} there.",
                   rows[0][1], rows[1][1], rows[2][1], rows[0][2], rows[1][2], rows[2][2]),
       ""}};
  result.sections = {
      {"The window and its transfer function",
       {line_figure(
            {.id = "response",
             .title = "Impulse responses",
             .caption = "Hann windows of three band limits; a period of f0 = 15 MHz lasts 66.7 ns. "
                        "Their sum is 1: mean power and duty stay."},
            in_time, {.label = "time", .unit = "ns", .range = ValueRange{-16, 16}},
            {.label = "response", .unit = fmt::format("per sample, N = {}", samples)}),
        line_figure(
            {.id = "transfer",
             .title = "Transfer functions",
             .caption = "Where each falls to 1/5 is its f_max. Beyond the first zero the side "
                        "lobes stay below 3 %."},
            in_frequency, {.label = "frequency", .unit = "f0"},
            {.label = "|H|", .unit = "", .from_zero = true})}}};
  result.files["f_max.csv"] = csv_text({"f_max_in_f0", "measured_in_f0", "attenuation"}, rows);
  return result;
}

}  // namespace tofsmith

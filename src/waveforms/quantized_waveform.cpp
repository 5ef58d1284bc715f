// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/waveforms/waveform_export.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

bool is_name(const std::string& name) {
  return !name.empty() && std::isalpha(static_cast<unsigned char>(name.front())) != 0 &&
         std::ranges::all_of(name,
                             [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
}

}  // namespace

void QuantizedWaveform::validate() const {
  require(is_name(name), "waveform name", name,
          "must be letters, digits and _, and begin with a letter");
  require(levels >= 2 && levels <= 1 << 24, name + " levels", levels, "must be in [2, 2^24]");
  require(codes.size() >= 2 && codes.size() <= std::size_t{1} << 26, name + " points", codes.size(),
          "must be in [2, 2^26]");
  require(periods >= 1 && points() % periods == 0, name + " periods", periods,
          "must be >= 1 and divide the points");
  const auto [least, most] = std::ranges::minmax(codes);
  require(least >= 0 && most < levels, name + " code", least < 0 ? least : most,
          "must be in [0, levels - 1]");
  require(std::isfinite(sample_rate_hz) && sample_rate_hz > 0.0, name + " sample_rate_hz",
          sample_rate_hz, "must be finite and > 0");
  require(std::isfinite(full_scale) && full_scale >= 0.0, name + " full_scale", full_scale,
          "must be finite and >= 0");
  require(std::isfinite(low_v) && std::isfinite(high_v) && high_v > low_v, name + " high_v", high_v,
          "must be finite and above low_v");
}

QuantizedWaveform quantized(const Waveform& table, int points, std::int32_t levels, double scale) {
  QuantizedWaveform result;
  result.levels = levels;
  const double peak = table.peak();
  result.full_scale = scale * peak;
  const Eigen::VectorXd values = table.cell_averages(points);
  result.codes.reserve(static_cast<std::size_t>(points));
  for (const double value : values)
    result.codes.push_back(
        peak > 0.0 ? static_cast<std::int32_t>(std::lround(value / peak * (levels - 1))) : 0);
  return result;
}

}  // namespace tofsmith

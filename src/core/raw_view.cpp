// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/image.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/shared/pixel_runs.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/raw_markers.hpp"

namespace tofsmith {

RawView view_of_frame(const RawFrames& raw, int frame) {
  require(frame >= 0 && frame < raw.frames, "frame", frame,
          "must be in [0, " + std::to_string(raw.frames) + ")");
  require(raw.height >= 0 && raw.width >= 0 && raw.measurements >= 0 &&
              raw.values.size() == static_cast<std::size_t>(raw.frames) * raw.pixels_per_frame() *
                                       static_cast<std::size_t>(raw.measurements),
          "raw values", raw.values.size(), "must be frames x height x width x measurements");
  return RawView::interleaved(raw.frame(frame), raw.height, raw.width, raw.measurements);
}

void copy_pixels(const RawView& raw, std::int64_t first, std::int64_t count, float* values) {
  for_each_run(raw, first, count, [&](const auto* pixel, std::int64_t length, std::int64_t) {
    for (std::int64_t i = 0; i < length; ++i, pixel += raw.column_stride)
      for (int k = 0; k < raw.measurements; ++k)
        *values++ = static_cast<float>(pixel[k * raw.measurement_stride]);
  });
}

namespace {

/// NaN equals NaN.
bool is_same_number(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

bool is_same_list(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), is_same_number);
}

bool names(const std::vector<double>& list, double number) {
  return std::any_of(list.begin(), list.end(),
                     [number](double named) { return is_same_number(named, number); });
}

void validate_markers(const std::vector<double>& list, const std::string& field) {
  constexpr double largest = 9007199254740992.0;  // 2^53
  std::vector<double> before;
  for (const double number : list) {
    require(!std::isfinite(number) || std::abs(number) <= largest, field, number,
            "each must be in [-2^53, 2^53], NaN or infinite");
    require(!names(before, number), field, number, "must be listed once");
    before.push_back(number);
  }
}

}  // namespace

bool RawMarkers::mean_saturated(double number) const { return names(saturated, number); }
bool RawMarkers::mean_invalid(double number) const { return names(invalid, number); }

void RawMarkers::validate() const {
  validate_markers(saturated, "raw.saturated");
  validate_markers(invalid, "raw.invalid");
  for (const double number : invalid)
    require(!mean_saturated(number), "raw.invalid", number, "must not be in raw.saturated as well");
}

bool operator==(const RawMarkers& a, const RawMarkers& b) {
  return is_same_list(a.saturated, b.saturated) && is_same_list(a.invalid, b.invalid);
}

}  // namespace tofsmith

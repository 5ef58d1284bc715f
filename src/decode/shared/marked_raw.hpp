// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/image.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

/// Returns a view of the frame in which saturated and invalid values are replaced.
/// @param buffer  memory of the result; unused if the marking replaces nothing
RawView mark_raw(const RawView& raw, const RawMarking& marking, std::vector<std::byte>& buffer);

/// Completes a view of numbers that need no marking.
inline RawView marked_view(RawView numbers, const float* averaged, const NoiseRatios& noise = {}) {
  numbers.averaged = averaged;
  numbers.noise = noise;
  numbers.is_marked = true;
  return numbers;
}

/// A marked frame and its buffer. The first step of every decoder and filter.
class MarkedRaw {
 public:
  MarkedRaw(const RawView& raw, const RawMarking& marking)
      : view_(mark_raw(raw, marking, buffer_)) {}
  MarkedRaw(const MarkedRaw&) = delete;
  MarkedRaw& operator=(const MarkedRaw&) = delete;

  const RawView& view() const { return view_; }

 private:
  std::vector<std::byte> buffer_;
  RawView view_;
};

/// Returns the raw value at which the well or the converter clips a tap; none if neither does.
std::optional<float> saturation_level_of(const Sensor& sensor);

void set_saturation(const Camera& camera, DecodingTable& table);

/// Raw values at which measurements are clipped: <= lowest or >= highest.
struct SaturationLevels {
  float lowest = -std::numeric_limits<float>::infinity();
  float highest = std::numeric_limits<float>::infinity();

  SaturationLevels() = default;
  explicit SaturationLevels(const DecodingTable& table)
      : lowest(table.lower_saturation_level.value_or(-std::numeric_limits<float>::infinity())),
        highest(table.saturation_level.value_or(std::numeric_limits<float>::infinity())) {}

  bool has_any() const { return std::isfinite(lowest) || std::isfinite(highest); }
  template <typename Number>
  bool clip(Number number) const {
    return number <= static_cast<Number>(lowest) || number >= static_cast<Number>(highest);
  }

  /// Adds a value to a sum; infinite if a value is clipped, NaN if one is not finite.
  double added(double sum, double number) const {
    if (!std::isfinite(number) || std::isnan(sum)) return std::numeric_limits<double>::quiet_NaN();
    if (std::isinf(sum) || !clip(number)) return sum + number;
    return number > static_cast<double>(lowest) ? std::numeric_limits<double>::infinity()
                                                : -std::numeric_limits<double>::infinity();
  }
  /// Returns the mean; a saturation level if a value was clipped.
  double mean(double sum, double count) const {
    if (std::isinf(sum)) return static_cast<double>(sum > 0.0 ? highest : lowest);
    return sum / count;
  }
};

}  // namespace tofsmith

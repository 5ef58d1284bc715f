// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>
#include <optional>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

/// Raw number at which a tap value is clipped, by its well or its converter; none if by neither.
std::optional<float> saturation_level_of(const Sensor& sensor);

/// Sets both saturation levels and the marking of a camera's table.
void set_saturation(const Camera& camera, DecodingTable& table);

/// Raw numbers at which measurements are clipped, from `highest` on and down from `lowest`;
/// infinite where they never are.
struct SaturationLevels {
  float lowest = -std::numeric_limits<float>::infinity();
  float highest = std::numeric_limits<float>::infinity();

  SaturationLevels() = default;
  explicit SaturationLevels(const DecodingTable& table)
      : lowest(table.lower_saturation_level.value_or(-std::numeric_limits<float>::infinity())),
        highest(table.saturation_level.value_or(std::numeric_limits<float>::infinity())) {}

  bool has_any() const { return std::isfinite(lowest) || std::isfinite(highest); }
  /// Returns true for a clipped number; only for finite numbers.
  template <typename Number>
  bool clip(Number number) const {
    return number <= static_cast<Number>(lowest) || number >= static_cast<Number>(highest);
  }

  /// The sum with one more number: infinite from the first clipped one on, NaN from the first on
  /// that is not finite.
  double added(double sum, double number) const {
    if (!std::isfinite(number) || std::isnan(sum)) return std::numeric_limits<double>::quiet_NaN();
    if (std::isinf(sum) || !clip(number)) return sum + number;
    return number > static_cast<double>(lowest) ? std::numeric_limits<double>::infinity()
                                                : -std::numeric_limits<double>::infinity();
  }
  /// The mean of `count` numbers with this sum; a level if one was clipped.
  double mean(double sum, double count) const {
    if (std::isinf(sum)) return static_cast<double>(sum > 0.0 ? highest : lowest);
    return sum / count;
  }
};

}  // namespace tofsmith

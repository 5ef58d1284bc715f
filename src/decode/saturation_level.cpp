// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/shared/saturation_level.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tofsmith {

std::optional<float> saturation_level_of(const Sensor& sensor) {
  double level = std::numeric_limits<double>::infinity();
  if (sensor.full_well_e) {
    level = *sensor.full_well_e / sensor.gain_e_per_dn.value_or(1.0) +
            sensor.black_level_dn.value_or(0.0);
    if (sensor.adc_bits) level = std::floor(level);
  }
  if (sensor.adc_bits) level = std::min(level, std::exp2(*sensor.adc_bits) - 1.0);
  if (!std::isfinite(level)) return std::nullopt;
  return static_cast<float>(level);
}

}  // namespace tofsmith

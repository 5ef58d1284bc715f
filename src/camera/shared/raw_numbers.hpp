// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

struct ConverterNumbers {
  double min_dn = 0.0, max_dn = 0.0;
};

/// From 0, or symmetric for a mixer without black level. @param sensor  must have adc_bits
inline ConverterNumbers raw_numbers(const Sensor& sensor) {
  const double count = std::exp2(*sensor.adc_bits);
  if (sensor.is_signed() && !sensor.black_level_dn) return {-0.5 * count, 0.5 * count - 1.0};
  return {0.0, count - 1.0};
}

}  // namespace tofsmith

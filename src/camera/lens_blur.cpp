// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "tofsmith/camera/lens.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

double LensBlur::disc_radius_px(double distance_m) const {
  const double far_px = focal_length_m * focal_length_m /
                        (2.0 * f_number * (focus_distance_m - focal_length_m) * pixel_pitch_m);
  return std::isnan(distance_m) ? far_px : far_px * std::abs(1.0 - focus_distance_m / distance_m);
}

void LensBlur::validate() const {
  check_ranges(*this, "lens.");
  require(kind != Kind::disc || focus_distance_m > focal_length_m, "lens.focus_distance_m",
          focus_distance_m, "must be > lens.focal_length_m");
}

}  // namespace tofsmith

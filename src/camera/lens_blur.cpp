// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "camera/number_checks.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

double LensBlur::disc_radius_px(double distance_m) const {
  const double far_px = focal_length_m * focal_length_m /
                        (2.0 * f_number * (focus_distance_m - focal_length_m) * pixel_pitch_m);
  return std::isnan(distance_m) ? far_px : far_px * std::abs(1.0 - focus_distance_m / distance_m);
}

void LensBlur::validate() const {
  require(pixel_samples >= 1 && pixel_samples <= 16, "lens.pixel_samples", pixel_samples,
          "must be in [1, 16]");
  if (kind == Kind::gaussian)
    require(blur_sigma_px > 0.0 && blur_sigma_px <= 32.0, "lens.blur_sigma_px", blur_sigma_px,
            "must be in (0, 32]");
  if (kind != Kind::disc) return;
  require_positive(focal_length_m, "lens.focal_length_m");
  require_positive(f_number, "lens.f_number");
  require(std::isfinite(focus_distance_m) && focus_distance_m > focal_length_m,
          "lens.focus_distance_m", focus_distance_m,
          "must be finite and > lens.focal_length_m: nothing nearer is ever sharp");
  require_positive(pixel_pitch_m, "lens.pixel_pitch_m");
}

}  // namespace tofsmith

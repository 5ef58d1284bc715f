// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

/// Time from the start of the frame. With exposure = exposures: the duration of all exposures and
/// readout gaps.
double exposure_start_s(const Camera& camera, int exposure, int exposures) {
  double start_s = 0.0;
  for (int i = 0; i < exposure; ++i)
    start_s += camera.exposure_s.of(i, exposures) + camera.sensor.readout_gap_s.value_or(0.0);
  return start_s;
}

}  // namespace

double Camera::frame_period_s(int exposures) const {
  const double busy_s = exposure_start_s(*this, exposures, exposures);
  if (!sensor.frame_period_s) return busy_s;
  require(*sensor.frame_period_s >= busy_s * (1.0 - 1e-12), "sensor.frame_period_s",
          *sensor.frame_period_s,
          fmt::format("must be >= {:.6g} s, the time of {} exposures with their gaps", busy_s,
                      exposures));
  return *sensor.frame_period_s;
}

double Camera::exposure_middle_s(int frame, int exposure, int exposures) const {
  return frame * frame_period_s(exposures) + exposure_start_s(*this, exposure, exposures) +
         0.5 * exposure_s.of(exposure, exposures);
}

double Camera::frame_middle_s(int frame, int exposures) const {
  const double end_s =
      exposure_start_s(*this, exposures - 1, exposures) + exposure_s.of(exposures - 1, exposures);
  return frame * frame_period_s(exposures) + 0.5 * end_s;
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/chips/chip_light.hpp"

#include <algorithm>

#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

std::optional<BrokenRule> why_not_plain(const Camera& camera) {
  if (camera.band_limited())
    return broken(
        "impulse_response", "given",
        "must be none, because the search on a chip clock requires rectangular waveforms");
  if (camera.light.generator || camera.sensor.generator)
    return broken("generator", "given", "must be none with a chip clock, which replaces it");
  const auto& contrasts = camera.sensor.modulation_contrasts;
  if (camera.sensor.modulation_contrast != 1.0 || !contrasts.empty())
    return broken("sensor.modulation_contrast",
                  contrasts.empty() ? camera.sensor.modulation_contrast : contrasts.front(),
                  "must be 1 to search codes on a chip clock");
  if (camera.sensor.is_signed())
    return broken("sensor.demodulation", "signed",
                  "must be \"gain\" to search codes of exclusive taps");
  if (camera.sensor.readout != Readout::separate)
    return broken("sensor.readout", camera.sensor.readout == Readout::rows ? "rows" : "difference",
                  "must be separate to search codes on a chip clock");
  const auto& times = camera.exposure_s.each_s;
  if (std::any_of(times.begin(), times.end(),
                  [&](double time_s) { return time_s != times.front(); }))
    return broken("exposure_s", "of different lengths",
                  "must be equal to search codes on a chip clock");
  return std::nullopt;
}

void require_plain(const Camera& camera) {
  camera.validate();
  require(why_not_plain(camera));
}

ChipLight::ChipLight(const Camera& camera, const OperatingPoint& point, int code_chips,
                     int exposures, ChipMetric metric)
    : peak_factor(camera.light.peak_factor),
      chips(code_chips),
      chip_m(camera.range_m() / code_chips),
      is_known(metric == ChipMetric::known_light) {
  require_plain(camera);
  require(camera.exposure_s.each_s.empty() ||
              camera.exposure_s.each_s.size() == static_cast<std::size_t>(exposures),
          "number of exposure_s", camera.exposure_s.each_s.size(), "must equal the exposures");
  const double time_s = camera.exposure_s.of(0, exposures);
  signal_e = time_s * point.signal_e_per_s / chips;
  ambient_e = time_s * point.ambient_e_per_s / chips;
  constexpr double min_e2 = 1e-9;  // avoids division by zero
  constant_e2 = std::max(
      min_e2, constant_variance_e2_of(camera.sensor) + time_s * camera.sensor.dark_current_e_per_s);
}

}  // namespace tofsmith

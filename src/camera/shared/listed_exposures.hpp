// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <optional>
#include <string>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

/// Error if a camera lists times or an order for another number of exposures.
/// @param whose  " of code NAME", for the message
inline std::optional<BrokenRule> other_exposures_listed(const Camera& camera, int exposures,
                                                        const std::string& whose = "") {
  const std::size_t ordered = camera.playback ? camera.playback->order.size() : 0;
  const std::size_t listed = camera.exposure_s.each_s.size();
  const std::string rule = fmt::format("must equal the {} exposures{}", exposures, whose);
  if (ordered > 0 && ordered != static_cast<std::size_t>(exposures))
    return broken("number of playback.order", ordered, rule);
  if (listed > 0 && listed != static_cast<std::size_t>(exposures))
    return broken("number of exposure_s", listed, rule);
  return std::nullopt;
}

/// Reorders values of the code's exposures.
inline std::vector<double> in_camera_order(std::vector<double> of_code, const Camera& camera) {
  if (!camera.playback || camera.playback->order.size() != of_code.size()) return of_code;
  std::vector<double> of_camera;
  for (const int exposure : camera.playback->order)
    of_camera.push_back(of_code[static_cast<std::size_t>(exposure)]);
  return of_camera;
}

}  // namespace tofsmith

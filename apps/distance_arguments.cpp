// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "distance_arguments.hpp"

#include <fmt/format.h>

#include <string>

#include "number_checks.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/camera/optics.hpp"

namespace tofsmith::apps {

void DistanceArguments::add_to(CLI::App& command) {
  CLI::Option* distance =
      command
          .add_option("--distance", distances_m_,
                      "surface distances in metres, such as 1,2,5; they replace the camera's "
                      "operating points, and the light levels follow from the camera's [optics]")
          ->delimiter(',')
          ->allow_extra_args(false)
          ->check(positive_number())
          ->transform(number_in("m"));
  command.add_option("--albedo", albedo_, "albedo of the surfaces at --distance")
      ->check(positive_number(1.0))
      ->capture_default_str()
      ->needs(distance);
  command
      .add_option("--klux", klux_,
                  "sunlight on the surfaces at --distance [klx] (default: the camera's [optics])")
      ->check(number_from_0_on())
      ->transform(number_in("klx"))
      ->needs(distance);
}

Camera DistanceArguments::at(const Camera& camera, const Session& session) const {
  if (!is_asked()) return camera;
  if (!camera.optics)
    throw UsageError(fmt::format(
        "--distance: found no [optics] in camera {}; expected its keys, from which the light at "
        "a distance is computed. Add these typical values, or your own:\n  --set '{}'",
        camera.name, typical_optics_line()));
  if (klux_ && !camera.optics->filter_width_m)
    throw UsageError(
        fmt::format("--klux: found no optics.filter_width_m in camera {}; expected the bandwidth "
                    "of the optical filter. Add this typical value, or your own:\n"
                    "  --set 'optics.{}'",
                    camera.name, typical_filter_line));
  constexpr double brightest_klux = 200.0;  // sunlight at noon: 130 klx
  if (klux_ && *klux_ > brightest_klux)
    session.say(fmt::format(
        "note: --klux {:g} exceeds sunlight (130 klx at noon); check that the unit is klx, not lux",
        *klux_));
  Camera judged = at_distances(camera, distances_m_, albedo_, klux_);
  for (const double distance_m : distances_m_) {
    const OperatingPoint light = judged.optics->light_at(distance_m, albedo_);
    session.say(
        fmt::format("{:.4g} m, albedo {:.3g}: S = {:.4g} e/s, A = {:.4g} e/s{}", distance_m,
                    albedo_, light.signal_e_per_s, light.ambient_e_per_s,
                    distance_m < camera.range_m()
                        ? std::string()
                        : fmt::format("; beyond the unambiguous range of {:.4g} m, so depths wrap",
                                      camera.range_m())));
  }
  return judged;
}

}  // namespace tofsmith::apps

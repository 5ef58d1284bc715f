// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/camera/lens.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {

constexpr double planck_j_s = 6.62607015e-34;

// Sunlight on a surface that faces the sun [W/m2/nm]: global spectrum of ASTM G173-03 (air mass
// 1.5) averaged over 10 nm, and its illuminance.
constexpr double sun_first_m = 800e-9, sun_step_m = 10e-9, sun_klux = 109.9;
constexpr std::array sun_w_per_m2_nm = {1.076, 0.936, 0.909, 0.961, 1.002, 0.952, 0.959,
                                        0.951, 0.926, 0.799, 0.713, 0.655, 0.703, 0.271,
                                        0.352, 0.344, 0.513, 0.627, 0.708, 0.745};
constexpr double sun_last_m = sun_first_m + sun_step_m * sun_w_per_m2_nm.size();

/// Mean between two wavelengths of the table.
double sunlight_between(double first_m, double last_m) {
  double sum = 0.0;
  for (std::size_t i = 0; i < sun_w_per_m2_nm.size(); ++i) {
    const double begin_m = sun_first_m + sun_step_m * static_cast<double>(i);
    const double overlap_m = std::min(last_m, begin_m + sun_step_m) - std::max(first_m, begin_m);
    sum += std::max(0.0, overlap_m) * sun_w_per_m2_nm[i];
  }
  return sum / (last_m - first_m);
}

void require_positive(double value, std::string_view field) {
  require(std::isfinite(value) && value > 0.0, field, value, "must be finite and > 0");
}

void require_sight(double distance_m, double albedo) {
  require_positive(distance_m, "distance_m");
  require(albedo > 0.0 && albedo <= 1.0, "albedo", albedo, "must be in (0, 1]");
}

}  // namespace

double Optics::electrons_per_j_per_m2() const {
  const double photons_per_j = wavelength_m / (planck_j_s * speed_of_light_m_per_s);
  return transmission / (4.0 * f_number * f_number) * pixel_pitch_m * pixel_pitch_m * fill_factor *
         quantum_efficiency * photons_per_j;
}

double Optics::source_w_per_m2(double distance_m) const {
  const auto half_tangent = [](double full_deg) {
    return std::tan(full_deg * std::numbers::pi / 360.0);
  };
  return source_power_w / (4.0 * distance_m * distance_m * half_tangent(field_of_view_deg[0]) *
                           half_tangent(field_of_view_deg[1]));
}

double Optics::sunlight_w_per_m2() const {
  if (sunlight_w_per_m2_nm) return *sunlight_w_per_m2_nm * *filter_width_m * 1e9;
  if (!sunlight_klux || *sunlight_klux == 0.0) return 0.0;
  const double half_m = *filter_width_m / 2.0;
  return *sunlight_klux / sun_klux *
         sunlight_between(wavelength_m - half_m, wavelength_m + half_m) * *filter_width_m * 1e9;
}

OperatingPoint Optics::light_at(double distance_m, double albedo) const {
  validate();
  require_sight(distance_m, albedo);
  return {albedo * source_w_per_m2(distance_m) * electrons_per_j_per_m2(),
          albedo * sunlight_w_per_m2() * electrons_per_j_per_m2()};
}

double Optics::distance_m(double signal_e_per_s, double albedo) const {
  require_positive(signal_e_per_s, "signal_e_per_s");
  return std::sqrt(light_at(1.0, albedo).signal_e_per_s / signal_e_per_s);
}

double Optics::source_power_for_w(double signal_e_per_s, double distance_m, double albedo) const {
  require_positive(signal_e_per_s, "signal_e_per_s");
  return source_power_w * signal_e_per_s / light_at(distance_m, albedo).signal_e_per_s;
}

Camera at_distances(Camera camera, std::vector<double> distances_m, double albedo,
                    std::optional<double> klux) {
  require(camera.optics.has_value(), "optics", "none",
          "is required to compute the light at a distance, such as " + typical_optics_line());
  require(!distances_m.empty(), "distances_m", "none", "must be at least one");
  if (klux) {
    camera.optics->sunlight_w_per_m2_nm.reset();
    camera.optics->sunlight_klux = klux;
  }
  std::sort(distances_m.begin(), distances_m.end());
  OperatingRange& operating = camera.operating;
  operating.signal_e_per_s.clear();
  for (const double distance_m : distances_m) {
    const OperatingPoint light = camera.optics->light_at(distance_m, albedo);
    operating.signal_e_per_s.push_back(light.signal_e_per_s);
    operating.ambient_e_per_s = {light.ambient_e_per_s};
  }
  operating.albedo = 1.0;
  operating.uniform_albedo = false;
  camera.validate();
  return camera;
}

OperatingPoint capture_light(const Camera& camera, double reference_distance_m) {
  OperatingPoint light = camera.operating.middle();
  if (!camera.optics) return light;
  const OperatingPoint seen = camera.optics->light_at(reference_distance_m);
  light.signal_e_per_s = seen.signal_e_per_s;
  if (camera.optics->sunlight_klux || camera.optics->sunlight_w_per_m2_nm)
    light.ambient_e_per_s = seen.ambient_e_per_s;
  return light;
}

void Optics::validate() const {
  check_ranges(*this, "optics.");
  if (filter_width_m)
    require(*filter_width_m < 2.0 * wavelength_m, "optics.filter_width_m", *filter_width_m,
            "must be below twice the wavelength");
  require(!sunlight_klux || !sunlight_w_per_m2_nm, "optics.sunlight_klux",
          sunlight_klux.value_or(0.0), "must be omitted if sunlight_w_per_m2_nm is given");
  if (sunlight_klux) {
    const double half_m = filter_width_m.value_or(0.0) / 2.0;
    require(wavelength_m - half_m >= sun_first_m && wavelength_m + half_m <= sun_last_m,
            "optics.wavelength_m", wavelength_m,
            fmt::format("must place the filter within {:.0f} to {:.0f} nm, where the spectrum of "
                        "sunlight is known; otherwise set sunlight_w_per_m2_nm",
                        1e9 * sun_first_m, 1e9 * sun_last_m));
  }
  require(filter_width_m || !(sunlight_klux || sunlight_w_per_m2_nm), "optics.filter_width_m",
          "none",
          fmt::format(
              "is required with sunlight, to compute the light that passes the filter, such as {}",
              typical_filter_line));
}

std::string typical_optics_line() {
  KeyList list;
  Optics blank;
  describe(list, blank);
  std::string line = "optics = { ";
  for (const KeyDescription& its : list.keys)
    if (!its.key.example.empty()) line += fmt::format("{} = {}, ", its.name, its.key.example);
  return line + std::string(typical_filter_line) + " }";
}

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

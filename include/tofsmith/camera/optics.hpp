// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "tofsmith/camera/operating_range.hpp"
#include "tofsmith/core/field_visitor.hpp"

namespace tofsmith {

/// Optics of a camera, which relate watts and lux to electrons. Assumes Lambertian surfaces that
/// face the camera, uniform illumination of the field of view, and objects far from the lens.
/// @see docs/optics.md
struct Optics {
  double source_power_w = 0.0;
  double wavelength_m = 0.0;
  std::array<double, 2> field_of_view_deg{};
  double f_number = 0.0;
  double pixel_pitch_m = 0.0;
  double quantum_efficiency = 0.0;
  double transmission = 1.0;
  double fill_factor = 1.0;
  std::optional<double> filter_width_m = {};
  /// The global spectrum of ASTM G173-03 has 109.9 klx.
  std::optional<double> sunlight_klux = {};
  std::optional<double> sunlight_w_per_m2_nm = {};  ///< replaces sunlight_klux

  /// Returns signal S and ambient light A of a surface [e/s]:
  ///   S = albedo E tau / (4 k^2) pitch^2 fill QE lambda / (h c),
  ///   E = P / (4 d^2 tan(h / 2) tan(v / 2)).
  ///
  /// For A, E is the irradiance by sunlight within the band of the filter.
  /// @throws InvalidArgument
  OperatingPoint light_at(double distance_m, double albedo = 1.0) const;
  /// Returns the distance of a surface with this signal [m].
  double distance_m(double signal_e_per_s, double albedo = 1.0) const;
  /// Returns the mean optical power for this signal at the distance [W].
  double source_power_for_w(double signal_e_per_s, double distance_m, double albedo = 1.0) const;

  /// Returns the irradiance of a facing surface by the light source.
  double source_w_per_m2(double distance_m) const;
  /// Returns the irradiance by sunlight within the band of the filter.
  double sunlight_w_per_m2() const;
  /// Returns the electrons per pixel for 1 J/m2 on a white surface.
  double electrons_per_j_per_m2() const;

  /// @throws InvalidArgument
  void validate() const;

  friend bool operator==(const Optics&, const Optics&) = default;
};

/// Keys of [optics].
inline void describe(FieldVisitor& fields, Optics& optics) {
  fields.value(Key("source_power_w", "Mean optical power of the modulated light", above(0))
                   .required("0.5")
                   .usually(0.01, 10),
               optics.source_power_w);
  fields.value(Key("wavelength_m", "Wavelength of the modulated light", closed(200e-9, 20e-6))
                   .required("850e-9"),
               optics.wavelength_m);
  fields.value(Key("field_of_view_deg", "Full horizontal and vertical angle of the illumination",
                   open(0, 180))
                   .required("[70, 55]"),
               optics.field_of_view_deg);
  fields.value(Key("f_number", "Focal length divided by the aperture of the lens", above(0))
                   .required("1.4")
                   .usually(0.8, 4),
               optics.f_number);
  fields.value(Key("pixel_pitch_m", "Distance between pixel centres", above(0))
                   .required("10e-6")
                   .usually(2e-6, 5e-5),
               optics.pixel_pitch_m);
  fields.value(
      Key("quantum_efficiency", "Electrons per photon on the sensitive area", left_open(0, 1))
          .required("0.3"),
      optics.quantum_efficiency);
  fields.value(
      Key("transmission", "Transmission of lens and filter at the wavelength", left_open(0, 1)),
      optics.transmission);
  fields.value(Key("fill_factor", "Sensitive share of a pixel", left_open(0, 1)),
               optics.fill_factor);
  fields.value(
      Key("filter_width_m", "Bandwidth of the optical filter; required with sunlight", above(0)),
      optics.filter_width_m);
  fields.value(Key("sunlight_klux",
                   "Illuminance of surfaces by sunlight; requires a filter within "
                   "800 to 1000 nm",
                   at_least(0)),
               optics.sunlight_klux);
  fields.value(Key("sunlight_w_per_m2_nm",
                   "Irradiance of surfaces by sunlight within the band of "
                   "the filter, instead of sunlight_klux",
                   at_least(0)),
               optics.sunlight_w_per_m2_nm);
}

inline constexpr std::string_view typical_filter_line = "filter_width_m = 30e-9";
/// Returns typical values of all required keys and of the filter as a line of a camera file.
std::string typical_optics_line();

}  // namespace tofsmith

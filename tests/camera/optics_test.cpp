// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "refusal.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Optics plain_optics() {
  return {.source_power_w = 0.5,
          .wavelength_m = 850e-9,
          .field_of_view_deg = {70.0, 55.0},
          .f_number = 1.4,
          .pixel_pitch_m = 10e-6,
          .quantum_efficiency = 0.3,
          .transmission = 0.8,
          .fill_factor = 0.9,
          .filter_width_m = 30e-9};
}

/// Reference: counts the source photons in the field of view, and the fraction that the patch of a
/// pixel reflects into the lens, summed over a fine aperture.
double signal_by_photons(const Optics& o, double distance_m, double albedo) {
  constexpr double h = 6.62607015e-34, c = 299792458.0, pi = std::numbers::pi;
  const double focal_m = 4e-3;  // any value: patch and aperture scale together
  const double width_m = 2 * distance_m * std::tan(o.field_of_view_deg[0] / 2 * pi / 180);
  const double height_m = 2 * distance_m * std::tan(o.field_of_view_deg[1] / 2 * pi / 180);
  const double patch_m = o.pixel_pitch_m * distance_m / focal_m;
  const double on_patch_w = o.source_power_w * patch_m * patch_m / (width_m * height_m);
  const double radius_m = focal_m / o.f_number / 2;
  double into_lens = 0.0;  // of a Lambertian emitter: cosine / pi per solid angle
  constexpr int rings = 2000;
  for (int i = 0; i < rings; ++i) {
    const double r = radius_m * (i + 0.5) / rings;
    const double cosine = distance_m / std::hypot(r, distance_m);
    const double area = 2 * pi * r * radius_m / rings;
    into_lens += cosine / pi * area * cosine / (r * r + distance_m * distance_m);
  }
  const double power_w = albedo * on_patch_w * into_lens * o.transmission * o.fill_factor;
  return power_w * o.quantum_efficiency * o.wavelength_m / (h * c);
}

TEST(Optics, SignalEqualsCountedPhotons) {
  const Optics optics = plain_optics();
  for (const double distance_m : {0.5, 2.0, 7.0})
    for (const double albedo : {0.1, 1.0})
      EXPECT_NEAR(optics.light_at(distance_m, albedo).signal_e_per_s /
                      signal_by_photons(optics, distance_m, albedo),
                  1.0, 1e-4);
}

TEST(Optics, AmbientLightDoesNotDependOnDistanceButSignalDoes) {
  Optics optics = plain_optics();
  optics.sunlight_klux = 50.0;
  const OperatingPoint near = optics.light_at(1.0), far = optics.light_at(3.0, 0.5);
  EXPECT_NEAR(near.signal_e_per_s / far.signal_e_per_s, 18.0, 1e-9);
  EXPECT_NEAR(near.ambient_e_per_s / far.ambient_e_per_s, 2.0, 1e-9);
}

TEST(Optics, SunlightFollowsTheStandardSpectrum) {
  Optics optics = plain_optics();
  EXPECT_EQ(optics.sunlight_w_per_m2(), 0.0);
  optics.sunlight_klux = 109.9;
  optics.filter_width_m = 10e-9;
  const auto around = [&](double nm) {
    optics.wavelength_m = nm * 1e-9;
    return optics.sunlight_w_per_m2() / 10.0;
  };
  EXPECT_NEAR(around(855.0), 0.95, 0.01);  // ASTM G173-03, global, mean of 850 to 859 nm
  EXPECT_NEAR(around(935.0), 0.27, 0.01);  // water vapour
  EXPECT_NEAR(around(850.0), 0.5 * (around(845.0) + around(855.0)), 1e-9);
  const double by_klux_w_per_m2 = optics.sunlight_w_per_m2();
  optics.sunlight_klux.reset();
  optics.sunlight_w_per_m2_nm = by_klux_w_per_m2 / 10.0;
  EXPECT_NEAR(optics.sunlight_w_per_m2(), by_klux_w_per_m2, 1e-12);
}

TEST(Optics, ConvertsBackFromElectrons) {
  const Optics optics = plain_optics();
  const OperatingPoint light = optics.light_at(3.7, 0.4);
  EXPECT_NEAR(optics.distance_m(light.signal_e_per_s, 0.4), 3.7, 1e-9);
  EXPECT_NEAR(optics.source_power_for_w(2 * light.signal_e_per_s, 3.7, 0.4), 1.0, 1e-9);
}

TEST(Optics, ACameraCanBeEvaluatedAtDistances) {
  Camera camera = built_in_camera("paper-10f0");
  camera.optics = plain_optics();
  const Camera judged = at_distances(camera, {4.0, 1.0}, 0.3, 20.0);
  camera.optics->sunlight_klux = 20.0;
  const OperatingPoint near = camera.optics->light_at(1.0, 0.3);
  EXPECT_THAT(judged.operating.signal_e_per_s,
              ElementsAre(near.signal_e_per_s, camera.optics->light_at(4.0, 0.3).signal_e_per_s));
  EXPECT_THAT(judged.operating.ambient_e_per_s, ElementsAre(near.ambient_e_per_s));
}

TEST(Optics, CapturesUseItsLight) {
  Camera camera = built_in_camera("paper-10f0");
  EXPECT_EQ(capture_light(camera, 2.0), camera.operating.middle());
  camera.optics = plain_optics();
  EXPECT_EQ(capture_light(camera, 2.0).signal_e_per_s, camera.optics->light_at(2.0).signal_e_per_s);
  EXPECT_EQ(capture_light(camera, 2.0).ambient_e_per_s, camera.operating.middle().ambient_e_per_s);
  camera.optics->sunlight_klux = 0.0;
  EXPECT_EQ(capture_light(camera, 2.0).ambient_e_per_s, 0.0);
}

TEST(Optics, RejectsImpossibleValues) {
  const auto refusal = [](auto&& change) {
    Optics optics = plain_optics();
    change(optics);
    return refusal_of([&] { optics.validate(); });
  };
  EXPECT_EQ(refusal([](Optics&) {}), "accepted");
  EXPECT_THAT(refusal([](Optics& o) { o.source_power_w = 0.0; }),
              HasSubstr("optics.source_power_w = 0; must be finite and > 0"));
  EXPECT_THAT(refusal([](Optics& o) { o.wavelength_m = 850.0; }),
              HasSubstr("optics.wavelength_m = 850; must be in [2e-07, 2e-05]"));
  EXPECT_THAT(refusal([](Optics& o) { o.field_of_view_deg[1] = 180.0; }),
              HasSubstr("optics.field_of_view_deg[1] = 180"));
  EXPECT_THAT(refusal([](Optics& o) { o.quantum_efficiency = 30.0; }),
              HasSubstr("optics.quantum_efficiency = 30; must be in (0, 1]"));
  EXPECT_THAT(refusal([](Optics& o) {
                o.sunlight_klux = 50.0;
                o.filter_width_m.reset();
              }),
              HasSubstr("optics.filter_width_m = none"));
  EXPECT_THAT(refusal([](Optics& o) {
                o.sunlight_klux = 50.0;
                o.wavelength_m = 1550e-9;
              }),
              HasSubstr("otherwise set sunlight_w_per_m2_nm"));
  EXPECT_THAT(refusal([](Optics& o) { o.sunlight_klux = o.sunlight_w_per_m2_nm = 1.0; }),
              HasSubstr("must be omitted if sunlight_w_per_m2_nm is given"));
  EXPECT_THROW(at_distances(built_in_camera("paper-10f0"), {1.0}), InvalidArgument);
  EXPECT_THROW(plain_optics().light_at(-1.0), InvalidArgument);
  EXPECT_THROW(plain_optics().light_at(1.0, 1.5), InvalidArgument);
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/shared/random.hpp"
#include "tofsmith/calibrate/correlation_calibration.hpp"
#include "tofsmith/decode/stray_light.hpp"

namespace tofsmith {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::ThrowsMessage;

Camera bench_camera() {
  Camera camera = built_in_camera("paper-10f0");
  camera.sensor.adc_bits = 16;
  camera.sensor.gain_e_per_dn = 1.0;
  camera.sensor.black_level_dn = 100.0;
  return camera;
}

/// Frames of a square target on black through a lens with stray light.
struct Bench {
  int size = 32, half_target = 2, frames = 4;
  double exponent = 2.0, share = 0.04, light_e = 3e4;
  std::uint64_t seed = 1;

  Image<float> kernel() const {
    const int reach = size - 1;
    Image<float> k(2 * reach + 1, 2 * reach + 1);
    double sum = 0.0;
    for (int v = -reach; v <= reach; ++v)
      for (int u = -reach; u <= reach; ++u) {
        const double r = std::hypot(v, u);
        const double value = r < 0.5 ? 0.0 : std::pow(std::max(r, 3.0), -exponent);
        k(v + reach, u + reach) = static_cast<float>(value);
        sum += value;
      }
    for (float& value : k.pixels) value *= static_cast<float>(share / sum);
    return k;
  }
  RawFrames capture(bool covered = false) const {
    Image<float> light(size, size);
    const int row = size / 2, column = size / 3;
    if (!covered)
      for (int v = -half_target; v <= half_target; ++v)
        for (int u = -half_target; u <= half_target; ++u)
          light(row + v, column + u) = static_cast<float>(light_e);
    const Image<float> seen = StrayLight(kernel()).scatter(light);
    RandomStream random(seed, covered ? 2 : 1, 0);
    RawFrames raw{.frames = frames, .height = size, .width = size, .measurements = 4, .values = {}};
    constexpr std::array measured{1.0, 0.6, 0.3, 0.8};
    for (int f = 0; f < frames; ++f)
      for (const float pixel : seen.pixels)
        for (const double m : measured) {
          const double mean = m * std::max(0.0, static_cast<double>(pixel));
          raw.values.push_back(
              static_cast<float>(100.0 + mean + std::sqrt(mean + 100.0) * random.normal()));
        }
    return raw;
  }
  double share_within(double radius_px) const {
    const Image<float> k = kernel();
    const int reach = k.width / 2;
    double sum = 0.0;
    for (int v = -reach; v <= reach; ++v)
      for (int u = -reach; u <= reach; ++u)
        if (std::hypot(v, u) <= radius_px) sum += static_cast<double>(k(v + reach, u + reach));
    return sum;
  }
  CalibratedStrayLight calibrate() const {
    return calibrate_stray_light(capture(), {}, bench_camera());
  }
};

TEST(StrayLightCalibration, IntervalsContainTheTruthIn200Cameras) {
  int totals = 0, shares = 0, all = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    RandomStream random(seed, 5, 0);
    // An inverse square law is one of the fitted laws.
    const Bench bench{.size = 28,
                      .share = 0.01 + 0.07 * random.uniform(),
                      .light_e = 1e4 * (1.0 + 3.0 * random.uniform()),
                      .seed = seed};
    const CalibratedStrayLight found = bench.calibrate();
    const Image<float> kernel = bench.kernel();
    const int reach = kernel.width / 2;
    const double total = bench.share_within(found.radius_px.back());
    totals += std::abs(found.total.value - total) <= 1.96 * found.total.standard_error;
    const double at_3 = static_cast<double>(kernel(reach, reach + 3));
    for (std::size_t j = 0; j < found.share.size(); ++j, ++all)
      shares += std::abs(found.share[j].value - at_3 * std::pow(3.0 / found.radius_px[j], 2)) <=
                1.96 * found.share[j].standard_error;
  }
  EXPECT_GE(totals, 186);
  EXPECT_GE(shares, 0.93 * all);
  RecordProperty("totals", totals);
  RecordProperty("shares", shares);
  RecordProperty("all", all);
}

TEST(StrayLightCalibration, ApproximatesOtherLaws) {
  for (const double exponent : {1.5, 2.5, 3.0}) {
    const Bench bench{.size = 48, .frames = 16, .exponent = exponent};
    const CalibratedStrayLight found = bench.calibrate();
    EXPECT_NEAR(found.total.value, bench.share_within(found.radius_px.back()), 0.1 * bench.share)
        << exponent;
    // Stray light that remains after correction.
    StrayLight truth(bench.kernel()), measured(found.kernel);
    Image<float> light(48, 48);
    light(20, 20) = 1e6F;
    const Image<float> seen = truth.scatter(light), again = measured.gather(seen);
    double before = 0.0, after = 0.0;
    for (int v = 0; v < 48; ++v)
      for (int u = 0; u < 48; ++u)
        if (std::hypot(v - 20, u - 20) >= 3.0 && std::hypot(v - 20, u - 20) < 20.0) {
          before += std::pow(static_cast<double>(seen(v, u)), 2);
          after += std::pow(static_cast<double>(again(v, u)), 2);
        }
    EXPECT_LT(std::sqrt(after / before), 0.1) << exponent;
  }
}

TEST(StrayLightCalibration, SubtractsLightWithoutTheTarget) {
  const Bench bench;
  RawFrames lit = bench.capture(), dark = bench.capture(true);
  for (RawFrames* raw : {&lit, &dark})
    for (std::size_t i = 0; i < raw->values.size(); ++i)
      raw->values[i] += static_cast<float>(40 + i / 4 % 31);  // a wall that is not black
  const CalibratedStrayLight found = calibrate_stray_light(lit, dark, bench_camera());
  EXPECT_NEAR(found.total.value, bench.share_within(found.radius_px.back()), 0.1 * bench.share);
}

TEST(StrayLightCalibration, ReportsAbsenceOfStrayLight) {
  EXPECT_THAT(Bench{.share = 0.0}.calibrate().notes,
              Contains(HasSubstr("the stray light is not significant")));
}

TEST(StrayLightCalibration, RejectsFramesWithoutATarget) {
  const auto refuses = [](const Bench& bench, const char* why) {
    EXPECT_THAT([&] { bench.calibrate(); }, ThrowsMessage<std::invalid_argument>(HasSubstr(why)));
  };
  refuses({.light_e = 1e5}, "saturated");
  refuses({.half_target = 0}, "at least 4 pixels");
  refuses({.half_target = 9}, "at most a quarter");
  const Bench bench;
  RawFrames smaller = Bench{.size = 16}.capture();
  EXPECT_THROW(calibrate_stray_light(bench.capture(), smaller, bench_camera()),
               std::invalid_argument);
  RawFrames nothing = bench.capture();
  std::ranges::fill(nothing.values, NAN);
  EXPECT_THROW(calibrate_stray_light(nothing, {}, bench_camera()), std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith

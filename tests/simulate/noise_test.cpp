// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate/noise.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tofsmith/core/statistics.hpp"

namespace tofsmith {
namespace {

struct Moments {
  double mean, mean_se, variance, variance_se;
};

/// Moments of 40,000 draws; standard errors are computed from the fourth moment.
template <typename Draw>
Moments moments_of(Draw&& draw) {
  constexpr int count = 40000;
  std::vector<double> values;
  RunningStatistics statistics;
  for (int i = 0; i < count; ++i) {
    RandomStream random(11, static_cast<std::uint64_t>(i));
    values.push_back(draw(random));
    statistics.add(values.back());
  }
  RunningStatistics squares;
  for (const double v : values) squares.add((v - statistics.mean()) * (v - statistics.mean()));
  return {statistics.mean(), statistics.standard_error(), statistics.variance(),
          squares.standard_error()};
}

TEST(PixelNoise, ElectronsHaveTheMomentsOfTheModel) {
  for (const NoiseModel model : {NoiseModel::poisson, NoiseModel::gaussian}) {
    for (const double expected_e : {0.0, 0.7, 30.0, 2500.0}) {
      Sensor sensor;
      sensor.noise = model;
      sensor.read_noise_e = 3.0;
      const PixelNoise noise(sensor);
      const Moments m = moments_of(
          [&](RandomStream& random) { return noise.draw_electrons(expected_e, random); });
      EXPECT_NEAR(m.mean, expected_e, 4 * m.mean_se) << expected_e;
      EXPECT_NEAR(m.variance, expected_e + 9.0, 4 * m.variance_se) << expected_e;
    }
  }
}

TEST(PixelNoise, PoissonWithoutReadNoiseGivesIntegers) {
  Sensor sensor;
  sensor.read_noise_e = 0.0;
  const PixelNoise noise(sensor);
  for (std::uint64_t i = 0; i < 100; ++i) {
    RandomStream random(1, i);
    const double electrons = noise.draw_electrons(4.2, random);
    EXPECT_EQ(electrons, std::round(electrons));
    EXPECT_GE(electrons, 0.0);
  }
}

TEST(PixelNoise, ConvertsNothingByDefault) {
  const PixelNoise noise{Sensor{}};
  for (const double electrons : {-40.25, 0.0, 1.5, 1e7})
    EXPECT_EQ(noise.convert(electrons), electrons);
}

TEST(PixelNoise, ConvertsWithGainBlackLevelAndLimits) {
  Sensor sensor;
  sensor.adc_bits = 10;
  sensor.gain_e_per_dn = 2.5;
  sensor.black_level_dn = 64.0;
  const PixelNoise noise(sensor);
  EXPECT_EQ(noise.convert(0.0), 64.0);
  EXPECT_EQ(noise.convert(250.0), 164.0);
  EXPECT_EQ(noise.convert(251.2), 164.0);
  EXPECT_EQ(noise.convert(251.3), 165.0);
  EXPECT_EQ(noise.convert(-100.0), 24.0) << "the black level keeps negative electrons";
  EXPECT_EQ(noise.convert(-1000.0), 0.0);
  EXPECT_EQ(noise.convert(1e6), 1023.0);
}

TEST(PixelNoise, FullWellClipsBeforeConversion) {
  Sensor sensor;
  sensor.full_well_e = 1000.0;
  EXPECT_EQ(PixelNoise(sensor).convert(1500.0), 1000.0);
  EXPECT_EQ(PixelNoise(sensor).convert(-50.0), -50.0);
  sensor.adc_bits = 12;
  sensor.gain_e_per_dn = 1.0;
  EXPECT_EQ(PixelNoise(sensor).convert(1500.0), 1000.0);
}

TEST(PixelNoise, QuantizationAddsATwelfthOfTheStepSquared) {
  Sensor sensor;
  sensor.noise = NoiseModel::gaussian;
  sensor.read_noise_e = 10.0;
  sensor.adc_bits = 16;
  sensor.gain_e_per_dn = 12.0;
  sensor.black_level_dn = 100.0;
  const PixelNoise noise(sensor);
  const Moments m = moments_of([&](RandomStream& random) {
    return (noise.convert(noise.draw_electrons(400.0, random)) - 100.0) * 12.0;
  });
  EXPECT_NEAR(m.mean, 400.0, 4 * m.mean_se);
  EXPECT_NEAR(m.variance, 500.0 + 12.0, 4 * m.variance_se);
}

TEST(PixelNoise, DifferencesUseNeighbouringBuckets) {
  Sensor sensor;
  sensor.taps = 2;
  double raw[] = {7.0, 3.0, 1.0, 5.0};
  PixelNoise(sensor).read_out(raw, 4);
  EXPECT_EQ(raw[1], 3.0);
  sensor.readout = Readout::difference;
  const PixelNoise noise(sensor);
  EXPECT_EQ(noise.measurements(4), 2);
  noise.read_out(raw, 4);
  EXPECT_EQ(raw[0], 4.0);
  EXPECT_EQ(raw[1], -4.0);
}

TEST(PixelNoise, DoesNotIncludeTheGenerator) {
  Sensor sensor;
  sensor.generator = Generator{.edge_grid_s = 1.0 / (7e6 * 12)};  // for a camera of 7 MHz
  EXPECT_NO_THROW(PixelNoise{sensor});
}

TEST(PixelNoise, RejectsInvalidSettings) {
  Sensor sensor;
  sensor.full_well_e = -1.0;
  EXPECT_THROW(PixelNoise{sensor}, std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith

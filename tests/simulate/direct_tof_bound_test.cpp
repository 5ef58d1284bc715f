// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/bounds.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "camera/shared/actual_code.hpp"
#include "core/shared/random.hpp"

namespace tofsmith {
namespace {

using std::numbers::pi;

Camera gaussian_light(double cutoff_hz, double peak_factor) {
  Camera camera = built_in_camera("paper-30x");
  camera.samples = 60;
  camera.light.peak_factor = peak_factor;
  camera.light.impulse_response = {.kind = ImpulseResponse::Kind::gaussian, .cutoff_hz = cutoff_hz};
  return camera;
}

/// Deviation of a Gaussian response in periods; |H(cutoff)|^2 = 1/2.
double deviation(const Camera& camera) {
  return std::sqrt(std::log(2.0)) / (2 * pi) * camera.fundamental_frequency_hz /
         camera.light.impulse_response.cutoff_hz;
}

TEST(DirectTofBound, OfSinglePhotonsIsThatOfTheirArrivalTimes) {
  // Without ambient light, the mean of n normal arrival times has a standard error of s / sqrt(n).
  const Camera camera = gaussian_light(150e6, 1000.0);
  const double s = deviation(camera);
  EXPECT_NEAR(DirectTofBound(camera).photon_information({1e4, 0.0}) * s * s / (1e4 * 0.3), 1.0,
              1e-3);
  EXPECT_NEAR(DirectTofBound(camera).mae_m({1e4, 0.0}),
              camera.range_m() * std::sqrt(2 / pi) * s / std::sqrt(3000.0),
              2e-3 * camera.range_m() * s / std::sqrt(3000.0));
}

TEST(DirectTofBound, OfAModulationIsThePlainIntegral) {
  const Camera camera = built_in_camera("paper-10f0");
  const OperatingPoint point{3e3, 2e4};
  const Waveform pulse = rectangular_pulse(1.0 / 15);
  constexpr int points = 20000;
  const Eigen::VectorXd m =
      arm_output(pulse, camera.light.impulse_response, camera.fundamental_frequency_hz, points);
  double sum = 0.0;
  for (int j = 0; j < points; ++j) {
    const double slope = (m[(j + 1) % points] - m[(j + points - 1) % points]) * points / 2;
    sum += std::pow(3e3 * slope, 2) / (3e3 * std::max(m[j], 0.0) + 2e4) / points;
  }
  EXPECT_NEAR(DirectTofBound(camera).information_of(pulse, point) / (0.3 * sum), 1.0, 1e-3);
}

TEST(DirectTofBound, NoModulationBeatsIt) {
  // Single pulses, trains, trains of unequal pulses and random words; some approach the bound.
  double closest = 0.0;
  for (const double peak_factor : {1.3, 2.0, 10.0, 40.0}) {
    for (const auto& [name, cutoff_hz] : {std::pair("narrow", 45e6), std::pair("wide", 200e6)}) {
      const Camera camera = gaussian_light(cutoff_hz, peak_factor);
      const DirectTofBound bound(camera);
      const double min_duty = 1.0 / peak_factor;
      std::vector<Waveform> lights;
      for (const double duty : {min_duty, std::min(0.95, 1.5 * min_duty), 0.5})
        for (const int pulses : {1, 3, 6, 13})
          if (duty >= min_duty) lights.push_back(pulse_train(pulses, duty));
      if (peak_factor < 2.0) lights.push_back(Waveform::binary({{0.0, 0.5}}, peak_factor));
      for (std::uint64_t item = 0; item < 3; ++item) {
        RandomStream random(5, item);
        Eigen::VectorXd word(60);
        for (double& x : word) x = random.uniform() < min_duty ? 1.0 : 0.0;
        word[0] = 1.0;
        const double level = std::min(peak_factor, 1.0 / word.mean());
        lights.push_back(Waveform::binary_from_samples(word, level));
      }
      for (const OperatingPoint& point :
           {OperatingPoint{1e4, 0.0}, OperatingPoint{1e4, 1e3}, OperatingPoint{1e3, 1e7}}) {
        const double largest = bound.photon_information(point);
        for (const Waveform& light : lights) {
          const double information = bound.information_of(light, point);
          EXPECT_LE(information, largest * (1 + 1e-6))
              << name << " peak " << peak_factor << " A " << point.ambient_e_per_s;
          closest = std::max(closest, information / largest);
        }
      }
    }
  }
  EXPECT_GT(closest, 0.8) << "a bound no light comes near would say nothing";
}

TEST(DirectTofBound, IsNeverAboveTheReceiverBound) {
  for (const char* name : {"paper-10f0", "paper-5f0"})
    for (const double peak_factor : {1.2, 4.0, 15.0})
      for (const int taps : {1, 2, 4, 16}) {
        Camera camera = built_in_camera(name);
        camera.samples = 60;
        camera.light.peak_factor = peak_factor;
        camera.sensor.taps = taps;
        camera.sensor.read_noise_e = taps == 16 ? 0.0 : 20.0;
        const DirectTofBound direct(camera);
        const ReceiverBound receiver(camera, 3);
        for (const OperatingPoint& point : {OperatingPoint{1e3, 1e2}, OperatingPoint{1e5, 0.0},
                                            OperatingPoint{1e6, 1e2}, OperatingPoint{1e3, 1e7}})
          EXPECT_LE(direct.mae_m(point), receiver.mae_m(point) * (1 + 1e-9))
              << name << " " << peak_factor << " " << taps;
      }
}

TEST(DirectTofBound, IsZeroForUnlimitedLight) {
  Camera camera = built_in_camera("paper-10f0");
  camera.light.impulse_response = {};
  EXPECT_EQ(DirectTofBound(camera).mae_m({1e4, 1e4}), 0.0);
  EXPECT_GT(ReceiverBound(camera, 4).mae_m({1e4, 1e4}), 0.0) << "the sensor still has one";
  camera.light.edge_jitter_s = 50e-12;
  EXPECT_GT(DirectTofBound(camera).mae_m({1e4, 1e4}), 0.0);
}

TEST(DirectTofBound, AccountsForListedExposures) {
  Camera camera = gaussian_light(100e6, 10.0);
  const double even = DirectTofBound(camera).mae_m({1e4, 1e3});
  camera.exposure_s.each_s = {0.25, 0.04, 0.01};
  EXPECT_NEAR(DirectTofBound(camera).mae_m({1e4, 1e3}), even, 1e-12 * even);
}

}  // namespace
}  // namespace tofsmith

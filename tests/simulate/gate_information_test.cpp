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
#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

namespace {

constexpr int points = 480;
constexpr int highest = 40;

struct Light {
  double signal_e, ambient_e, other_e2;
};

constexpr Light lights[] = {
    {7500.0, 10.0, 400.0}, {7500.0, 7500.0, 400.0}, {75.0, 10.0, 400.0}, {1e6, 0.0, 1.0}};

Eigen::VectorXcd transfer_of(ImpulseResponse::Kind kind) {
  Camera camera = built_in_camera("paper-10f0");
  if (kind != ImpulseResponse::Kind::hann)
    camera.light.impulse_response = {.kind = kind, .cutoff_hz = 90e6};
  return camera.transfer(highest);
}

/// Information at every depth for a light and a gate, as Fourier sums at `points` depths.
struct Information {
  double mean = 0.0, largest = 0.0;
};

Information information_of(const Eigen::VectorXcd& transfer, const Eigen::VectorXcd& light,
                           const Eigen::VectorXcd& gate, const Light& of) {
  Information information;
  for (int j = 0; j < points; ++j) {
    const double turn = 2 * std::numbers::pi * j / points;
    double value = 0.0, slope = 0.0;
    for (int n = 0; n <= highest; ++n) {
      const std::complex<double> part = (n == 0 ? 1.0 : 2.0) * transfer[n] * light[n] *
                                        std::conj(gate[n]) * std::polar(1.0, n * turn);
      value += part.real();
      slope -= 2 * std::numbers::pi * n * part.imag();
    }
    const double electrons = of.signal_e * value + of.ambient_e * gate[0].real();
    const double here = std::pow(of.signal_e * slope, 2) / (electrons + of.other_e2);
    information.mean += here / points;
    information.largest = std::max(information.largest, here);
  }
  return information;
}

TEST(GateInformation, NoGateHasMoreAndSquareWavesComeNear) {
  for (const ImpulseResponse::Kind kind :
       {ImpulseResponse::Kind::hann, ImpulseResponse::Kind::gaussian,
        ImpulseResponse::Kind::lowpass}) {
    const Eigen::VectorXcd transfer = transfer_of(kind);
    const GateInformation bound(transfer);
    for (const Light& light : lights) {
      const double mean = bound.mean_over_depths(light.signal_e, light.ambient_e, light.other_e2);
      const double any = bound.at_any_depth(light.signal_e, light.ambient_e, light.other_e2);
      EXPECT_LT(mean, any);
      Information nearest;
      const auto hold = [&](const Waveform& modulation, const Waveform& gate) {
        const Information found =
            information_of(transfer, modulation.harmonics(highest), gate.harmonics(highest), light);
        EXPECT_LE(found.mean, mean) << light.signal_e;
        EXPECT_LE(found.largest, any) << light.signal_e;
        nearest.mean = std::max(nearest.mean, found.mean);
        nearest.largest = std::max(nearest.largest, found.largest);
      };
      for (int frequency = 1; frequency <= 10; ++frequency)
        for (const double pulse : {0.02, 0.1, 0.3})
          for (const double open : {0.1, 0.2, 0.35, 0.5, 0.7}) {
            std::vector<OnInterval> on;
            for (int i = 0; i < frequency; ++i)
              on.push_back({i / double(frequency), (i + open) / double(frequency)});
            hold(pulse_train(frequency, pulse), Waveform::binary(on));
          }
      for (std::uint64_t item = 0; item < 20; ++item) {
        RandomStream random(8, item);
        Eigen::VectorXd gate(60);
        const double share = random.uniform();
        double state = 0.0;
        for (double& d : gate) {
          if (random.uniform() < 0.3) state = random.uniform() < share ? 1.0 : 0.0;
          d = state;
        }
        gate[0] = 1.0;
        hold(rectangular_pulse(0.02 + 0.2 * random.uniform()),
             Waveform::binary_from_samples(gate, 1.0));
      }
      // Only in bright light: if other noise dominates, the limit by taps is the tighter bound.
      if (light.other_e2 + light.ambient_e < light.signal_e) {
        EXPECT_GT(nearest.mean, 0.5 * mean) << light.signal_e << " " << light.ambient_e;
        EXPECT_GT(nearest.largest, 0.7 * any) << light.signal_e << " " << light.ambient_e;
      }
    }
  }
}

/// Reference of at_any_depth(): opens gates in the order of slope over light.
double of_sorted_points(const Eigen::VectorXcd& transfer, const Light& of) {
  constexpr int fine = 8192;
  Eigen::VectorXd response(fine), slope(fine);
  for (int j = 0; j < fine; ++j) {
    std::complex<double> value = 0.0, by_turn = 0.0;
    for (int n = 0; n < transfer.size(); ++n) {
      const double turn = 2 * std::numbers::pi * n;
      const std::complex<double> part =
          (n == 0 ? 1.0 : 2.0) * transfer[n] * std::polar(1.0, turn * j / fine);
      value += part;
      by_turn += turn * std::complex<double>(0.0, 1.0) * part;
    }
    response[j] = value.real();
    slope[j] = of.signal_e * by_turn.real();
  }
  const double least = 1e-7 * response.maxCoeff();
  const Eigen::VectorXd light = of.signal_e * response.cwiseMax(least).array() + of.ambient_e;
  std::vector<int> order(fine);
  for (int j = 0; j < fine; ++j) order[static_cast<std::size_t>(j)] = j;
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return slope[a] / light[a] > slope[b] / light[b]; });
  double passed = 0.0, gained = 0.0, largest = 0.0;
  for (const int j : order) {
    passed += light[j] / fine;
    gained += slope[j] / fine;
    for (const double x : {passed, light.mean() - passed})
      largest = std::max(largest, gained * gained / (x + of.other_e2));
  }
  return largest;
}

TEST(GateInformation, EqualsThatOfSortedPointsAndIsNeverBelow) {
  for (const ImpulseResponse::Kind kind :
       {ImpulseResponse::Kind::hann, ImpulseResponse::Kind::gaussian,
        ImpulseResponse::Kind::lowpass}) {
    const Eigen::VectorXcd transfer = transfer_of(kind);
    const GateInformation bound(transfer);
    for (const Light& light : lights) {
      const double any = bound.at_any_depth(light.signal_e, light.ambient_e, light.other_e2);
      const double sorted = of_sorted_points(transfer, light);
      EXPECT_GE(any / sorted, 1 - 1e-5) << light.signal_e;
      EXPECT_LE(any / sorted, 1 + 5e-4) << light.signal_e;
    }
  }
}

TEST(GateInformation, RequiresLightAndIncreasesWithIt) {
  const GateInformation bound(transfer_of(ImpulseResponse::Kind::hann));
  EXPECT_EQ(bound.mean_over_depths(0.0, 100.0, 400.0), 0.0);
  EXPECT_EQ(bound.at_any_depth(0.0, 100.0, 400.0), 0.0);
  double last = 0.0;
  for (double signal_e = 1.0; signal_e < 1e7; signal_e *= 3) {
    const double mean = bound.mean_over_depths(signal_e, 100.0, 400.0);
    EXPECT_GT(mean, last);
    EXPECT_LT(bound.mean_over_depths(signal_e, 1000.0, 400.0), mean);
    EXPECT_LT(bound.mean_over_depths(signal_e, 100.0, 800.0), mean);
    last = mean;
  }
}

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

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/shared/random.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/simulate/bounds.hpp"

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

}  // namespace
}  // namespace tofsmith

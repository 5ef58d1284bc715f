// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "camera/shared/actual_code.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tofsmith/camera/camera.hpp"

namespace tofsmith {
namespace {

constexpr double frequency_hz = 15e6;

ImpulseResponse response_of(ImpulseResponse::Kind kind) {
  ImpulseResponse response;
  response.kind = kind;
  response.f_max_hz = response.cutoff_hz = 10 * frequency_hz;
  return response;
}

TEST(ArmOutput, KeepsTheMean) {
  using Kind = ImpulseResponse::Kind;
  const Waveform waveform = Waveform::binary({{0.1, 0.23}, {0.5, 0.77}}, 2.0);
  for (const Kind kind : {Kind::none, Kind::hann, Kind::gaussian, Kind::lowpass})
    for (const int points : {48, 101}) {
      const Eigen::VectorXd actual = arm_output(waveform, response_of(kind), frequency_hz, points);
      ASSERT_EQ(actual.size(), points);
      EXPECT_NEAR(actual.mean(), waveform.mean(), 1e-12) << name_of(kind);
    }
}

TEST(ArmOutput, WithoutResponseEqualsTheCellAverages) {
  const Waveform waveform = rectangular_pulse(0.3, 0.9);
  EXPECT_EQ(arm_output(waveform, {}, frequency_hz, 64), waveform.cell_averages(64));
}

TEST(ArmOutput, IsTheConvolutionWithTheWindow) {
  // Integral of a Hann window of width W, centred on zero, over the part that overlaps the pulse.
  // From -W/2 to x it is 1/2 + x/W + sin(2 pi x / W) / (2 pi).
  const double width = 1.444010597686313 / 10;  // periods
  const auto integral = [&](double x) {
    if (x <= -width / 2) return 0.0;
    if (x >= width / 2) return 1.0;
    return 0.5 + x / width + std::sin(2 * std::numbers::pi * x / width) / (2 * std::numbers::pi);
  };
  const double begin = 0.3, end = 0.52;
  const Eigen::VectorXd actual =
      arm_output(Waveform::binary({{begin, end}}), response_of(ImpulseResponse::Kind::hann),
                 frequency_hz, 480);
  for (int j = 0; j < 480; ++j) {
    const double t = j / 480.0;
    EXPECT_NEAR(actual[j], integral(t - begin) - integral(t - end), 1e-4) << t;
  }
}

TEST(ArmOutput, OfALowPassIsDelayed) {
  // x(t) = 1 - exp(-2 pi f_c t); the response to the previous pulse has decayed by then.
  const double rate = 2 * std::numbers::pi * 10;
  const Eigen::VectorXd actual =
      arm_output(Waveform::binary({{0.25, 0.75}}), response_of(ImpulseResponse::Kind::lowpass),
                 frequency_hz, 1000);
  for (const int j : {100, 200, 300, 400, 600, 700})
    EXPECT_NEAR(actual[j], j < 250 ? 0.0 : 1 - std::exp(-rate * (j / 1000.0 - 0.25)), 2e-3) << j;
}

}  // namespace
}  // namespace tofsmith

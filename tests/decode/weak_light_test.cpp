// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "decode/ambient_projection.hpp"
#include "decode/output/pixel_model.hpp"
#include "decode_setup.hpp"

namespace tofsmith {
namespace {

constexpr int pixels = 40000;
constexpr double depth_bin = 61.3;

DepthImage captured(const DecodeSetup& setup, double signal) {
  const DecodingTable& table = setup.decoder.table();
  return setup.decoder.decode(
      frame_by_pixel(table.measurements(), 1, pixels, 1,
                     [&](int, int, RandomStream& random, std::vector<float>& values) {
                       append_noisy_pixel(table, signal, 1e4, depth_bin, random, values);
                     }));
}

double length_of_directions(const DecodingTable& table) {
  Eigen::MatrixXd curve = AmbientProjection(table).curve;
  curve.rowwise().normalize();
  double length = 0.0;
  for (Eigen::Index n = 0; n < curve.rows(); ++n)
    length += std::acos(std::clamp(curve.row(n).dot(curve.row((n + 1) % curve.rows())), -1.0, 1.0));
  return length;
}

/// `deviations` is the signal in units of its standard deviation.
double signal_of(const DecodingTable& table, double deviations) {
  const AmbientProjection projection(table);
  const PixelModel model(table, projection);
  const Position position = Position::at(depth_bin);
  double signal = 1e4;
  for (int i = 0; i < 30; ++i) {
    const Eigen::VectorXd light =
        signal * projection.gated.row(position.bin).transpose() + 1e4 * projection.ambient;
    std::array<double, max_measurements> plane, variance;
    model.project(light.data(), plane.data());
    signal = deviations *
             model.estimate(light.data(), plane.data(), {position.bin, 0.0}, variance.data())
                 .signal_standard_deviation_e_per_s;
  }
  return signal;
}

// The estimated signal is the maximum of a random field along the curve of directions. Its tail
// probability is proportional to the length of the curve (Rice).
TEST(WeakLight, FalseDetectionRateFollowsTheLengthOfTheCurve) {
  for (const char* code : {"sinusoid-k4", "hamiltonian-k4", "hamiltonian-k5"}) {
    DecodeOptions options;
    options.min_confidence = 0.0;
    const DecodeSetup setup(code, camera_with("paper-10f0"), options);
    const DepthImage image = captured(setup, 0.0);
    const auto ok = static_cast<double>(
        std::count(image.status.pixels.begin(), image.status.pixels.end(), PixelStatus::ok));
    const double t = options.low_signal_sigma;
    const double expected = length_of_directions(setup.decoder.table()) / (2 * std::numbers::pi) *
                            std::exp(-0.5 * t * t);
    EXPECT_NEAR(ok / pixels / expected, 1.0, 0.2) << code << ' ' << expected;
  }
}

TEST(WeakLight, NoDepthIsTrustedWithoutLight) {
  for (const char* code : {"sinusoid-k4", "hamiltonian-k4", "hamiltonian-k5"}) {
    const DecodeSetup setup(code, camera_with("paper-10f0"));
    const DepthImage image = captured(setup, 0.0);
    double sum = 0.0;
    int count = 0, ok = 0;
    for (std::size_t i = 0; i < pixels; ++i) {
      const float confidence = image.confidence.pixels[i];
      if (std::isnan(confidence)) continue;
      sum += confidence;
      ++count;
      ok += image.status.pixels[i] == PixelStatus::ok;
    }
    // The main lobe is a tenth of the range.
    EXPECT_LT(sum / count, 0.35) << code;
    EXPECT_LT(ok, 2e-3 * pixels) << code;
  }
}

TEST(WeakLight, DeviationIsTheSpreadOfDepthFromFiveSignalDeviationsOn) {
  DecodeOptions options;
  options.min_confidence = 0.0;  // otherwise noise may move a depth out of the main lobe
  for (const char* code : {"sinusoid-k4", "hamiltonian-k4", "hamiltonian-k5"}) {
    const DecodeSetup setup(code, camera_with("paper-10f0"), options);
    const DecodingTable& table = setup.decoder.table();
    const DepthImage image = captured(setup, signal_of(table, 5.0));
    double squares = 0.0, count = 0.0;
    for (std::size_t i = 0; i < pixels; ++i) {
      if (image.status.pixels[i] != PixelStatus::ok) continue;
      const double error =
          std::remainder(image.depth_m.pixels[i] / table.bin_m() - depth_bin, table.bin_count()) *
          table.bin_m();
      const double deviation = image.deviation_m.pixels[i];
      if (std::abs(error) > 4 * deviation) continue;  // in another lobe
      squares += std::pow(error / deviation, 2), ++count;
    }
    EXPECT_GT(count, 0.9 * pixels) << code;
    EXPECT_NEAR(std::sqrt(squares / count), 1.0, 0.15) << code;
  }
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Laws that hold for the pixels of every decoder.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "decode_setup.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

inline constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
inline constexpr float infinite = std::numeric_limits<float>::infinity();

template <typename DecoderType>
DepthImage decode_pixels(const DecoderType& decoder, const std::vector<float>& raw) {
  return decoder.decode(frame_of(raw, decoder.measurements()));
}

/// Decodes a noise-free pixel at one eighth of the range in ambient light of 1e3 e/s.
/// @param signal_off, ambient_off  tolerances of the estimates [e/s]
template <typename Setup>
void expect_strong_signal_is_ok(const Setup& setup, double signal, double signal_off,
                                double ambient_off) {
  std::vector<float> raw;
  setup.append_expected(raw, signal, 30.0, 1e3);
  const DepthImage image = decode_pixels(setup.decoder, raw);
  EXPECT_EQ(image.status(0, 0), PixelStatus::ok);
  EXPECT_NEAR(image.depth_m(0, 0), setup.camera.range_m() / 8, 1e-3);
  EXPECT_NEAR(image.signal_e_per_s(0, 0), signal, signal_off);
  EXPECT_NEAR(image.ambient_e_per_s(0, 0), 1e3, ambient_off);
  EXPECT_GT(image.confidence(0, 0), 0.999);
}

/// Sets some of `pixels` noisy pixels to NaN or infinity, in one or in all measurements; the other
/// pixels must not change.
/// @param max_apart_bin  largest distance of the other depths from their bins
template <typename DecoderType>
void expect_not_a_number_disturbs_no_neighbour(const DecoderType& decoder, int pixels,
                                               double max_apart_bin = 0.5) {
  std::vector<float> raw = noisy_pixels(decoder.table(), 1e4, 1e4, pixels, 1);
  const DepthImage before = decode_pixels(decoder, raw);
  const auto count = static_cast<std::size_t>(pixels), first = count / 2;
  const auto measurements = static_cast<std::size_t>(decoder.measurements());
  float* const bad = raw.data() + first * measurements;
  bad[2] = not_a_number;
  bad[measurements] = infinite;
  bad[3 * measurements - 1] = -infinite;
  std::fill_n(bad + 3 * measurements, measurements, infinite);
  const DepthImage after = decode_pixels(decoder, raw);
  const std::vector<double> positions = depth_bins_of(decoder, raw);
  const std::vector<std::int32_t> bins = bins_of(decoder, raw);
  const int samples = decoder.samples();
  for (std::size_t i = 0; i < count; ++i) {
    const bool is_bad = i >= first && i < first + 4;
    EXPECT_EQ(std::isnan(positions[i]), is_bad);
    EXPECT_EQ(bins[i] == -1, is_bad);
    if (is_bad) {
      EXPECT_EQ(after.status.pixels[i], PixelStatus::invalid);
      EXPECT_TRUE(std::isnan(after.depth_m.pixels[i]));
      continue;
    }
    EXPECT_EQ(after.status.pixels[i], before.status.pixels[i]);
    EXPECT_EQ(after.depth_m.pixels[i], before.depth_m.pixels[i]);
    EXPECT_EQ(after.confidence.pixels[i], before.confidence.pixels[i]);
    EXPECT_LE(std::abs(circular_difference(bins[i], positions[i], samples)), max_apart_bin);
    EXPECT_LT(bins[i], samples);
  }
}

/// Expects correct depths for raw values far beyond any sensor.
template <typename Setup>
void expect_huge_numbers_are_decoded(const Setup& setup) {
  std::vector<float> raw;
  setup.append_expected(raw, 1e4, 50.0, 0.0);
  for (float& value : raw) value *= 3e34f;
  EXPECT_NEAR(depth_bins_of(setup.decoder, raw)[0], 50.0, 1e-3);
}

/// On a curve within a half-space, a measurement of the opposite direction only fits a negative
/// signal.
template <typename DecoderType>
void expect_negative_signal_is_no_return() {
  Eigen::MatrixXd correlation(20, 3);
  for (int n = 0; n < 20; ++n) correlation.row(n) << 0.0, 1.0, 0.02 * n;
  const DecoderType decoder(make_decoding_table(correlation, 10.0));
  EXPECT_EQ(decode_pixels(decoder, {100.0f, 0.0f, 50.0f}).status(0, 0), PixelStatus::no_return);
  EXPECT_EQ(decode_pixels(decoder, {0.0f, 1e6f, 2e5f}).status(0, 0), PixelStatus::ok);
}

/// Expects the status of pixels that are faint, without signal, saturated or invalid. Only faint
/// pixels have a depth.
template <typename Setup>
void expect_statuses_of_bad_pixels(const char* code) {
  Camera camera = camera_with("paper-10f0");
  camera.sensor.full_well_e = 5000.0;
  const Setup setup(code, camera);
  const auto pixel_of = [&](float value) {
    return std::vector<float>(static_cast<std::size_t>(setup.decoder.measurements()), value);
  };
  std::vector<float> faint, invalid = pixel_of(5000.0f);
  setup.append_expected(faint, 50.0, 30.0, 1e4);
  invalid[1] = not_a_number;
  for (const auto& [raw, status] : {std::pair{faint, PixelStatus::low_signal},
                                    {pixel_of(0.0f), PixelStatus::no_return},
                                    {pixel_of(700.0f), PixelStatus::no_return},
                                    {pixel_of(5000.0f), PixelStatus::saturated},
                                    {invalid, PixelStatus::invalid}}) {
    const DepthImage image = decode_pixels(setup.decoder, raw);
    EXPECT_EQ(image.status(0, 0), status) << name_of(status);
    EXPECT_EQ(std::isnan(image.depth_m(0, 0)), status != PixelStatus::low_signal);
  }
}

struct PixelEstimates {
  RunningStatistics depth_m, signal, ambient, predicted_m;
  /// Predicted over empirical deviation; with n trials its standard error is 1 / sqrt(2 n).
  double ratio() const { return predicted_m.mean() / std::sqrt(depth_m.variance()); }
};

template <typename Setup>
PixelEstimates estimates_at(const Setup& setup, double truth_bin, double signal, double ambient) {
  const int trials = 4000;
  const Return r{signal, truth_bin};
  const Eigen::VectorXd mean = setup.model.expected_electrons({&r, 1}, ambient);
  const Eigen::VectorXd variance = setup.model.variance_e2({&r, 1}, ambient);
  RandomStream random(3, static_cast<std::uint64_t>(truth_bin));
  std::vector<float> raw;
  for (int i = 0; i < trials; ++i)
    for (int k = 0; k < setup.decoder.measurements(); ++k)
      raw.push_back(static_cast<float>(mean[k] + std::sqrt(variance[k]) * random.normal()));
  const DepthImage image = decode_pixels(setup.decoder, raw);
  PixelEstimates result;
  for (int i = 0; i < trials; ++i) {
    result.depth_m.add(image.depth_m(0, i));
    result.signal.add(image.signal_e_per_s(0, i));
    result.ambient.add(image.ambient_e_per_s(0, i));
    result.predicted_m.add(image.deviation_m(0, i));
  }
  return result;
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/shared/random.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/decode/decoder.hpp"
#include "tofsmith/decode/merge_exposures.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

const std::vector<double> exposures{1.0, 4.0, 16.0};

Camera exposed_camera() {
  Camera camera = built_in_camera("paper-10f0");
  camera.sensor.adc_bits = 12;
  camera.sensor.gain_e_per_dn = 5.0;
  camera.sensor.black_level_dn = 50.0;
  camera.sensor.read_noise_e = 40.0;
  return camera;
}

DecodingTable exposed_table() {
  const Camera camera = exposed_camera();
  return make_decoding_table(ForwardModel(build_family("hamiltonian-k4", camera), camera), camera);
}

/// Pixels have one depth and increasing light.
RawFrames exposed(double exposure, double least_e, double most_e, int width, std::uint64_t seed) {
  const DecodingTable table = exposed_table();
  RandomStream random(seed, static_cast<std::uint64_t>(exposure), 0);
  RawFrames raw{.frames = 1, .height = 1, .width = width, .measurements = 4, .values = {}};
  for (int x = 0; x < width; ++x) {
    const double light_e = least_e * std::pow(most_e / least_e, x / (width - 1.0));
    for (int k = 0; k < 4; ++k) {
      const double mean_e =
          exposure * light_e * (table.correlation(70, k) + 0.2 * table.ambient_gain[k]);
      const double e = mean_e + std::sqrt(mean_e + 1600.0) * random.normal();
      raw.values.push_back(static_cast<float>(std::clamp(std::round(50.0 + e / 5.0), 0.0, 4095.0)));
    }
  }
  return raw;
}

std::vector<RawFrames> bracket(double least_e, double most_e, int width, std::uint64_t seed = 1) {
  std::vector<RawFrames> frames;
  for (const double exposure : exposures)
    frames.push_back(exposed(exposure, least_e, most_e, width, seed));
  return frames;
}

MergedExposures merged(const std::vector<RawFrames>& frames) {
  std::vector<RawView> views;
  for (const RawFrames& raw : frames) views.push_back(view_of_frame(raw, 0));
  MergedExposures result;
  merge_exposures(views, exposures, exposed_table(), result);
  return result;
}

TEST(MergeExposures, VarianceIsConsistentWithAveraged) {
  // Light levels at which 3, 2 and 1 exposures are not saturated.
  for (const double light_e : {3e2, 3e3, 1.2e4}) {
    SCOPED_TRACE(light_e);
    constexpr int width = 4000;
    const MergedExposures found = merged(bracket(light_e, light_e * (1 + 1e-9), width));
    const DecodingTable table = exposed_table();
    double square = 0.0, expected = 0.0;
    for (int x = 0; x < width; ++x)
      for (int k = 0; k < 4; ++k) {
        const double mean_e = light_e * (table.correlation(70, k) + 0.2 * table.ambient_gain[k]);
        const double e =
            5.0 *
            (static_cast<double>(found.values.values[static_cast<std::size_t>(4 * x + k)]) - 50.0);
        // Noise assumed by a decoder.
        expected += (mean_e + 1600.0 + 25.0 / 12.0) /
                    static_cast<double>(found.averaged.pixels[std::size_t(x)]);
        square += std::pow(e - mean_e, 2);
      }
    EXPECT_NEAR(square / expected, 1.0, 0.05);
  }
}

TEST(MergeExposures, DepthIsBetterThanInAnySingleExposure) {
  constexpr int width = 3000;
  const std::vector<RawFrames> frames = bracket(2e2, 1.2e4, width);
  const Decoder decoder(exposed_table());
  const double truth_m = 70.0 * decoder.table().bin_m();
  const auto rms_m = [&](const RawView& raw) {
    Image<float> depth_m(1, width);
    decoder.decode(raw, {.depth_m = depth_m.pixels.data()});
    double square = 0.0;
    for (const float depth : depth_m.pixels) {
      // Saturated pixels have no depth; count that as the largest error.
      const double error_m = std::isfinite(depth) ? static_cast<double>(depth) - truth_m : truth_m;
      square += error_m * error_m / width;
    }
    return std::sqrt(square);
  };
  const MergedExposures found = merged(frames);
  const double together_m = rms_m(found.view());
  for (const RawFrames& raw : frames) EXPECT_LT(together_m, 0.7 * rms_m(view_of_frame(raw, 0)));
}

TEST(MergeExposures, ASingleUsableExposureIsUnchanged) {
  std::vector<RawFrames> frames = bracket(1.1e4, 1.2e4, 5);
  const MergedExposures found = merged(frames);  // the longer exposures are saturated
  for (std::size_t i = 0; i < found.values.values.size(); ++i)
    EXPECT_NEAR(found.values.values[i], frames[0].values[i], 1e-3);
  for (const float n : found.averaged.pixels) EXPECT_FLOAT_EQ(n, 1.0F);
}

TEST(MergeExposures, PixelsSaturatedOrInvalidInAllExposuresStaySo) {
  std::vector<RawFrames> frames = bracket(1e3, 1.1e3, 4);
  for (RawFrames& raw : frames) {
    raw.values[0] = 4095.0F;                                  // clipped in all exposures
    raw.values[5] = std::numeric_limits<float>::quiet_NaN();  // invalid in all exposures
  }
  frames[1].values[9] = std::numeric_limits<float>::infinity();  // in one exposure
  const MergedExposures found = merged(frames);
  EXPECT_EQ(found.values.values[0], 4095.0F);
  EXPECT_TRUE(std::isnan(found.values.values[4]));
  EXPECT_TRUE(std::isfinite(found.values.values[9]));
  EXPECT_LT(found.averaged.pixels[2], found.averaged.pixels[3]);
}

TEST(MergeExposures, RejectsInvalidExposures) {
  const std::vector<RawFrames> frames = bracket(1e3, 1.1e3, 4);
  const auto refuses = [&](const std::vector<double>& given, const char* why) {
    EXPECT_THAT([&] { check_exposures(given, "hdr"); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(why)));
  };
  refuses({1.0}, "at least 2");
  refuses({2.0, 4.0}, "must contain 1: the shortest exposure");
  refuses({1.0, 0.0}, "each must be in [1, 1e6]");
  refuses({1.0, NAN}, "each must be in [1, 1e6]");
  const std::vector<RawView> one{view_of_frame(frames[0], 0)};
  MergedExposures result;
  EXPECT_THROW(merge_exposures(one, exposures, exposed_table(), result), std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith

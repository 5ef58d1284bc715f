// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tofsmith/decode/decoder.hpp"
#include "tofsmith/decode/stray_light.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// Falls with the square of the distance; sum `total`.
Image<float> glare(double total, int reach = 20) {
  Image<float> kernel(2 * reach + 1, 2 * reach + 1);
  double sum = 0.0;
  for (int v = -reach; v <= reach; ++v)
    for (int u = -reach; u <= reach; ++u) {
      const double share = v == 0 && u == 0 ? 0.0 : 1.0 / (v * v + u * u);
      kernel(v + reach, u + reach) = static_cast<float>(share);
      sum += share;
    }
  for (float& share : kernel.pixels) share *= static_cast<float>(total / sum);
  return kernel;
}

DecodingTable table() {
  Camera camera = built_in_camera("paper-10f0");
  camera.sensor.adc_bits = 16;
  camera.sensor.gain_e_per_dn = 2.0;
  camera.sensor.black_level_dn = 100.0;
  return make_decoding_table(ForwardModel(build_family("hamiltonian-k4", camera), camera), camera);
}

/// A bright object next to a dark one at another depth, without noise.
RawFrames scene(const DecodingTable& table) {
  RawFrames raw{.frames = 1, .height = 24, .width = 32, .measurements = 4, .values = {}};
  for (int v = 0; v < raw.height; ++v)
    for (int u = 0; u < raw.width; ++u)
      for (int k = 0; k < 4; ++k)
        raw.values.push_back(
            static_cast<float>(100.0 + (u < 10 ? 4000.0 * table.correlation(30, k)
                                               : 60.0 * table.correlation(90, k))));
  return raw;
}

RawFrames scattered(const RawFrames& raw, StrayLight& stray_light) {
  RawFrames seen = raw;
  for (std::size_t k = 0; k < 4; ++k) {
    Image<float> light(raw.height, raw.width);
    for (std::size_t i = 0; i < light.pixels.size(); ++i)
      light.pixels[i] = raw.values[4 * i + k] - 100.0F;
    const Image<float> scatter = stray_light.scatter(light);
    for (std::size_t i = 0; i < light.pixels.size(); ++i)
      seen.values[4 * i + k] = scatter.pixels[i] + 100.0F;
  }
  return seen;
}

TEST(StrayLight, GatheringInvertsScattering) {
  for (const double total : {0.01, 0.1, 0.45}) {
    StrayLight stray_light(glare(total));
    EXPECT_NEAR(stray_light.share(), total, 1e-6);
    Image<float> light(30, 40);
    for (std::size_t i = 0; i < light.pixels.size(); ++i)
      light.pixels[i] = static_cast<float>(i * 37 % 101);
    const Image<float> again = stray_light.gather(stray_light.scatter(light));
    for (std::size_t i = 0; i < light.pixels.size(); ++i)
      EXPECT_NEAR(again.pixels[i], light.pixels[i], 2e-3) << total;
  }
}

TEST(StrayLight, LightIsConservedFarFromTheEdges) {
  StrayLight stray_light(glare(0.2, 5));
  Image<float> light(21, 21);
  light(10, 10) = 100.0F;
  const Image<float> seen = stray_light.scatter(light);
  double sum = 0.0;
  for (const float value : seen.pixels) sum += static_cast<double>(value);
  EXPECT_NEAR(sum, 100.0, 1e-3);
  EXPECT_NEAR(seen(10, 10), 80.0, 1e-3);
}

TEST(StrayLight, DarkObjectsNextToBrightOnesKeepTheirDepth) {
  const DecodingTable of = table();
  const Decoder decoder(of);
  StrayLight stray_light(glare(0.05));
  const RawFrames truth = scene(of), seen = scattered(truth, stray_light);
  RawFrames clean;
  stray_light.remove(view_of_frame(seen, 0), of, clean);
  const auto worst_m = [&](const RawFrames& raw) {
    const DepthImage image = decoder.decode(raw);
    double worst = 0.0;
    for (int v = 0; v < 24; ++v)
      for (int u = 12; u < 32; ++u)
        worst =
            std::max(worst, std::abs(static_cast<double>(image.depth_m(v, u)) - 90.0 * of.bin_m()));
    return worst;
  };
  EXPECT_GT(worst_m(seen), 0.1);
  EXPECT_LT(worst_m(clean), 2e-3);
}

TEST(StrayLight, SaturatedAndInvalidPixelsAreUnchanged) {
  const DecodingTable of = table();
  StrayLight stray_light(glare(0.05));
  RawFrames seen = scattered(scene(of), stray_light);
  seen.values[0] = 65535.0F;
  seen.values[5] = std::numeric_limits<float>::quiet_NaN();
  seen.values[8] = 65534.0F;  // just below saturation; gathering makes it brighter
  RawFrames clean;
  stray_light.remove(view_of_frame(seen, 0), of, clean);
  EXPECT_EQ(clean.values[0], 65535.0F);
  EXPECT_TRUE(std::isnan(clean.values[5]));
  EXPECT_LT(clean.values[8], 65535.0F);
  for (std::size_t i = 12; i < clean.values.size(); ++i)
    EXPECT_TRUE(std::isfinite(clean.values[i]));
}

TEST(StrayLight, RejectsInvalidKernels) {
  const auto refuses = [](Image<float> kernel, const char* why) {
    EXPECT_THAT([&] { StrayLight stray_light(kernel); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(why)));
  };
  refuses(Image<float>(2, 3), "must be odd");
  refuses(Image<float>(), "must be odd");
  refuses(Image<float>(3, 3, 0.1F), "must be < 0.5");
  refuses(Image<float>(3, 3, -0.1F), ">= 0");
  refuses(Image<float>(3, 3, NAN), "finite");
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/depth_image.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "decode_setup.hpp"
#include "output_setup.hpp"
#include "tofsmith/decode/frame_pipeline.hpp"

namespace tofsmith {

namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr double range_m = 10.0;

Image<float> row_of(const std::vector<float>& values) {
  Image<float> image(1, static_cast<int>(values.size()));
  image.pixels = values;
  return image;
}

DepthImage decoded(const std::vector<float>& depth_m) {
  DepthImage image(1, static_cast<int>(depth_m.size()));
  image.depth_m.pixels = depth_m;
  for (std::size_t i = 0; i < depth_m.size(); ++i) {
    image.signal_e_per_s.pixels[i] = 1000.0f;
    image.ambient_e_per_s.pixels[i] = 200.0f;
    image.confidence.pixels[i] = 0.5f;
    image.deviation_m.pixels[i] = 0.01f;
    image.status.pixels[i] = PixelStatus::low_signal;
  }
  return image;
}

void apply_all(const PixelMaps& maps, DepthImage& image) {
  apply(maps, range_m, DecodedView::of(image), 0, image.status.size());
}

TEST(PixelMaps, OffsetsAreSubtractedAndWrap) {
  DepthImage image = decoded({1.0f, 1.0f, 9.5f, 0.25f, 3.0f, nan});
  apply_all({row_of({0.25f, 1.5f, -1.0f, 0.25f, 23.0f, 1.0f}), {}}, image);
  const std::vector<float> expected = {0.75f, 9.5f, 0.5f, 0.0f, 0.0f};
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_FLOAT_EQ(image.depth_m.pixels[i], expected[i]) << i;
  EXPECT_TRUE(std::isnan(image.depth_m.pixels[5]));
  EXPECT_EQ(image.signal_e_per_s.pixels[0], 1000.0f);
  EXPECT_EQ(image.status.pixels[0], PixelStatus::low_signal);
}

TEST(PixelMaps, DepthsStayInTheRangeForAnyOffset) {
  RandomStream random(1, 0);
  for (int i = 0; i < 20000; ++i) {
    const float depth = i % 3 == 0 ? 0.0f : static_cast<float>(range_m * random.uniform());
    const auto offset = static_cast<float>(random.normal() * std::pow(10.0, i % 12 - 9));
    DepthImage image = decoded({depth});
    apply_all({row_of({offset}), {}}, image);
    ASSERT_GE(image.depth_m.pixels[0], 0.0f) << depth << " - " << offset;
    ASSERT_LT(image.depth_m.pixels[0], 10.0f) << depth << " - " << offset;
  }
}

TEST(PixelMaps, GainsDivideLightOnly) {
  DepthImage image = decoded({1.0f, 2.0f});
  apply_all({{}, row_of({0.5f, 2.0f})}, image);
  EXPECT_EQ(image.signal_e_per_s.pixels, (std::vector<float>{2000.0f, 500.0f}));
  EXPECT_EQ(image.ambient_e_per_s.pixels, (std::vector<float>{400.0f, 100.0f}));
  EXPECT_EQ(image.depth_m.pixels, (std::vector<float>{1.0f, 2.0f}));
  EXPECT_EQ(image.confidence.pixels, (std::vector<float>{0.5f, 0.5f}));
  EXPECT_EQ(image.deviation_m.pixels, (std::vector<float>{0.01f, 0.01f}));
}

TEST(PixelMaps, AcceptPartsOfAnImageAndMissingPlanes) {
  const PixelMaps maps{row_of({1.0f, 2.0f, nan, 4.0f}), row_of({1.0f, 2.0f, 4.0f, 8.0f})};
  DepthImage whole = decoded({5.0f, 5.0f, 5.0f, 5.0f}), parts = whole;
  apply_all(maps, whole);
  DecodedView view = DecodedView::of(parts);
  apply(maps, range_m, view, 0, 1);
  EXPECT_EQ(parts.depth_m.pixels[1], 5.0f);
  view.depth_m = nullptr;
  apply(maps, range_m, view.from(1), 1, 3);
  EXPECT_EQ(parts.signal_e_per_s.pixels[3], whole.signal_e_per_s.pixels[3]);
  EXPECT_EQ(parts.status.pixels, whole.status.pixels);
  EXPECT_EQ(parts.depth_m.pixels[3], 5.0f);
  apply(maps, range_m, {}, 0, 4);  // no plane is requested
  EXPECT_THROW(apply(maps, range_m, view, 2, 3), std::invalid_argument);
  EXPECT_THROW(apply(maps, 0.0, view, 0, 4), std::invalid_argument);
}

TEST(PixelMaps, FixedPatternPhaseIsCorrected) {
  const DecodeSetup setup("hamiltonian-k4", camera_with("paper-30x"));
  const double bin_m = setup.camera.bin_m();
  std::vector<float> raw, offset_m, gain;
  for (int i = 0; i < 240; ++i) {
    const double moved_bin = std::fmod(37.0 + i, 240.0);  // all pixels see the surface of bin 37
    gain.push_back(0.5f + 0.01f * static_cast<float>(i));
    offset_m.push_back(static_cast<float>(i * bin_m));
    setup.append_expected(raw, 1e5 * gain.back(), moved_bin, 1e4 * gain.back());
  }
  DepthImage image = setup.decoder.decode(frame_of(raw, 4));
  apply({row_of(offset_m), row_of(gain)}, setup.camera.range_m(), DecodedView::of(image), 0, 240);
  for (std::size_t i = 0; i < 240; ++i) {
    ASSERT_NEAR(image.depth_m.pixels[i], 37.0 * bin_m, 1e-3) << i;
    ASSERT_NEAR(image.signal_e_per_s.pixels[i], 1e5, 20.0) << i;
    ASSERT_NEAR(image.ambient_e_per_s.pixels[i], 1e4, 20.0) << i;
  }
}

std::string complaint(const PixelMaps& maps, int height, int width) {
  try {
    maps.validate(height, width);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(PixelMaps, RejectsInvalidMapsByName) {
  EXPECT_EQ(complaint({}, 3, 4), "accepted");
  EXPECT_EQ(complaint({Image<float>(4, 3), {}}, 3, 4),
            "delay_offset_m = 4 x 3; must have the size of the frames, 3 x 4");
  EXPECT_EQ(complaint({{}, Image<float>(3, 4)}, 3, 4),
            "gain[0, 0] = 0; must be finite and > 0, or NaN for a dead pixel");
  Image<float> gain(2, 2, 1.0f), offset(2, 2, -3.0f);
  EXPECT_EQ(complaint({offset, gain}, 2, 2), "accepted");
  gain(1, 0) = -2.0f;
  EXPECT_EQ(complaint({offset, gain}, 2, 2),
            "gain[1, 0] = -2; must be finite and > 0, or NaN for a dead pixel");
  offset(0, 1) = std::numeric_limits<float>::infinity();
  EXPECT_EQ(complaint({offset, {}}, 2, 2),
            "delay_offset_m[0, 1] = inf; must be finite, or NaN for a dead pixel");
}

// Every declared plane is forwarded, filled by every method, and empty at pixels without a depth.

std::vector<DecodedPlane> all_planes() {
  std::vector<DecodedPlane> planes;
  for (const PlaneDescription& described : plane_descriptions) planes.push_back(described.plane);
  return planes;
}

TEST(DecodedPlanes, ViewsHaveExactlyThePlanesOfTheirImage) {
  for (const DecodedPlane plane : all_planes()) {
    SCOPED_TRACE(name_of(plane));
    DepthImage image({plane}, 2, 3);
    const DecodedView view = DecodedView::of(image), later = view.from(4);
    EXPECT_EQ(view.wants_bins_only(), plane == DecodedPlane::bin);
    EXPECT_EQ(view.planes(), std::vector{plane});
    for (const DecodedPlane other : all_planes())
      with_plane(
          other,
          [&](const auto& values, const auto* its, const auto* from) {
            EXPECT_EQ(values.size(), other == plane ? 6u : 0u);
            EXPECT_EQ(its, values.pixels.data());
            EXPECT_EQ(from, its ? its + 4 : nullptr);
          },
          image, view, later);
  }
}

void spoil(DepthImage& image) {
  for_each_plane(
      []<typename Value>(Image<Value>& plane) {
        std::ranges::fill(plane.pixels, static_cast<Value>(std::is_enum_v<Value> ? 77 : -7e6));
      },
      image);
}

TEST(DecodedPlanes, AreFilledByTheDeclaredMethods) {
  const DecodeSetup setup("multifrequency-1x3-4x3-7x3", camera_with("paper-10f0"));
  constexpr int pixels = 300;
  std::vector<float> raw = noisy_pixels(setup.decoder.table(), 1e5, 1e4, pixels, 3);
  raw[0] = std::numeric_limits<float>::quiet_NaN();
  const RawView view =
      RawView::interleaved(raw.data(), 1, pixels, setup.decoder.table().measurements());
  for (const DecodeMethod method : all_values<DecodeMethod>) {
    const bool is_multipath = method == DecodeMethod::two_return || method == DecodeMethod::tail;
    const auto backend = cpu_backend(make_decoder(method, setup.decoder.table()));
    const auto pipeline = backend->prepare({}, 1, pixels);
    ASSERT_TRUE(pipeline->submit(view));
    DepthImage image(all_planes(), 1, pixels), spoiled = image;
    spoil(image);
    spoil(spoiled);
    decode_frame(*pipeline, {}, 0, 1, DecodedView::of(image));
    for (const auto& described : plane_descriptions) {
      if (described.use == PlaneUse::of_returns && !is_multipath) continue;
      SCOPED_TRACE(testing::Message() << name_of(method) << ", " << described.word);
      with_plane(
          described.plane,
          [&]<typename Value>(const Image<Value>& values, const Image<Value>& unfilled) {
            for (std::size_t i = 0; i < values.size(); ++i)
              ASSERT_FALSE(same<Value>({values.pixels[i]}, {unfilled.pixels[i]})) << i;
            if (described.use != PlaneUse::of_frames) {
              EXPECT_TRUE(same<Value>({values.pixels[0]}, {no_value<Value>}));
            }
          },
          image, spoiled);
    }
  }
}

TEST(DecodedPlanes, DeadPixelsHaveNoValueInAnyPlane) {
  for (const bool in_gain : {false, true}) {
    DepthImage image(all_planes(), 1, 2);
    spoil(image);
    PixelMaps maps;
    (in_gain ? maps.gain : maps.delay_offset_m) = row_of({nan, 1.0f});
    maps.validate(1, 2);
    apply(maps, range_m, DecodedView::of(image), 0, 2);
    EXPECT_EQ(image.status.pixels[0], PixelStatus::invalid);
    for_each_plane(
        []<typename Value>(const Image<Value>& values) {
          EXPECT_TRUE(same<Value>({values.pixels[0]}, {no_value<Value>}));
          EXPECT_FALSE(same<Value>({values.pixels[1]}, {no_value<Value>}));
        },
        image);
  }
}

TEST(DecodedPlanes, DefaultPlanesFollowFromTheirUse) {
  for (const bool multipath : {false, true})
    for (const PlaneDescription& described : plane_descriptions)
      EXPECT_EQ(
          std::ranges::count(usual_planes(multipath), described.plane) == 1,
          described.use == PlaneUse::usual || (multipath && described.use == PlaneUse::of_returns))
          << described.word;
}

}  // namespace

}  // namespace tofsmith

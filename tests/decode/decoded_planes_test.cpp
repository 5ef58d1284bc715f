// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Every declared plane is forwarded, filled by every method, and empty at pixels without a depth.
#include <gtest/gtest.h>

#include <limits>

#include "output_setup.hpp"
#include "tofsmith/decode/frame_pipeline.hpp"

namespace tofsmith {
namespace {

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
  for (const DecodeMethod method : all_decode_methods) {
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
  DepthImage image(all_planes(), 1, 2);
  spoil(image);
  PixelMaps maps;
  maps.gain = Image<float>(1, 2, 1.0f);
  maps.gain.pixels[0] = std::numeric_limits<float>::quiet_NaN();
  apply(maps, 10.0, DecodedView::of(image), 0, 2);
  for_each_plane(
      []<typename Value>(const Image<Value>& values) {
        EXPECT_TRUE(same<Value>({values.pixels[0]}, {no_value<Value>}));
        EXPECT_FALSE(same<Value>({values.pixels[1]}, {no_value<Value>}));
      },
      image);
}

TEST(DecodedPlanes, DefaultPlanesAreWritten) {
  for (const bool multipath : {false, true})
    for (const PlaneDescription& described : plane_descriptions)
      EXPECT_EQ(
          std::ranges::count(usual_planes(multipath), described.plane) > 0,
          described.use == PlaneUse::usual || (multipath && described.use == PlaneUse::of_returns))
          << described.word;
}

}  // namespace
}  // namespace tofsmith

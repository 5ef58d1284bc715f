// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "decode_setup.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/decode/depth_image.hpp"
#include "tofsmith/decode/frame_pipeline.hpp"

namespace tofsmith {
namespace {

constexpr int height = 40, width = 60, edge = 30;

struct Mixture {
  double depth_bin = 0.0, signal_e_per_s = 1e5;
  double second_bin = 0.0, second_e_per_s = 0.0;
};
using SceneOfMixtures = std::function<Mixture(int row, int column)>;

RawFrames frame_of_mixtures(const DecodingTable& table, const SceneOfMixtures& scene) {
  return frame_by_pixel(
      table.measurements(), height, width, 1,
      [&](int y, int x, RandomStream& random, std::vector<float>& raw) {
        const Mixture seen = scene(y, x);
        std::vector<float> second;
        append_noisy_pixel(table, seen.signal_e_per_s, 1e4, seen.depth_bin, random, raw);
        append_noisy_pixel(table, seen.second_e_per_s, 0.0, seen.second_bin, random, second);
        if (!(seen.second_e_per_s > 0.0)) return;
        for (int k = 0; k < table.measurements(); ++k)
          raw[raw.size() - static_cast<std::size_t>(table.measurements() - k)] +=
              second[static_cast<std::size_t>(k)];
      });
}

/// Near surface on the left, far on the right, one mixed column.
Mixture edge_between(int column) {
  if (column == edge) return {70.0, 0.6e5, 120.0, 0.4e5};
  return {column < edge ? 70.0 : 120.0};
}

DepthImage marked(const DecodeSetup& setup, const RawFrames& raw,
                  MixedPixels mixed = MixedPixels::label) {
  DepthImage image = setup.decoder.decode(raw);
  mark_mixed_pixels(setup.decoder.table(), view_of_frame(raw, 0), mixed, DecodedView::of(image));
  return image;
}

double share_marked(const DepthImage& image) {
  return static_cast<double>(std::ranges::count(image.status.pixels, PixelStatus::mixed)) /
         static_cast<double>(image.status.size());
}

struct MarkedCounts {
  int at_edge = 0, elsewhere = 0;
};

MarkedCounts count_marked(const DepthImage& image) {
  MarkedCounts counts;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (image.status(y, x) == PixelStatus::mixed)
        ++(x == edge ? counts.at_edge : counts.elsewhere);
  return counts;
}

class MixedPixelsOfFrames : public testing::Test {
 protected:
  DepthImage marked_scene(const SceneOfMixtures& scene) const {
    return marked(setup, frame_of_mixtures(table, scene));
  }

  DecodeSetup setup{"hamiltonian-k5", camera_with("paper-10f0")};
  const DecodingTable& table = setup.decoder.table();
  const RawFrames edge_frame = frame_of_mixtures(table, [](int, int x) { return edge_between(x); });
};

TEST(MixedPixels, NamesAreReadBack) {
  for (const MixedPixels mixed : all_values<MixedPixels>)
    EXPECT_EQ(parse_word<MixedPixels>("mixed", name_of(mixed)), mixed);
  EXPECT_THROW(parse_word<MixedPixels>("mixed", "near"), std::invalid_argument);
}

TEST_F(MixedPixelsOfFrames, MixturesOfTwoSurfacesAreLabelledAndKeepTheirDepth) {
  const DepthImage before = setup.decoder.decode(edge_frame), image = marked(setup, edge_frame);
  EXPECT_EQ(image.depth_m.pixels, before.depth_m.pixels);
  for (std::size_t i = 0; i < image.status.size(); ++i)
    if (image.status.pixels[i] != PixelStatus::mixed) {
      EXPECT_EQ(image.status.pixels[i], before.status.pixels[i]);
    }
  EXPECT_GE(count_marked(image).at_edge, height - 2);
  EXPECT_LE(count_marked(image).elsewhere, height * width / 200);
}

TEST_F(MixedPixelsOfFrames, TheMiddleOfARibbonFivePixelsWideIsFound) {
  const DepthImage image = marked_scene([](int, int x) {
    const double share = 0.5 + 0.1 * (x - edge);
    if (x < edge - 2) return Mixture{70.0};
    if (x > edge + 2) return Mixture{120.0};
    return Mixture{70.0, (1 - share) * 1e5, 120.0, share * 1e5};
  });
  EXPECT_GE(count_marked(image).at_edge, height * 8 / 10);
}

TEST_F(MixedPixelsOfFrames, ASmallShareOfAnotherSurfaceIsFound) {
  const DepthImage image = marked_scene([](int, int x) {
    return x == edge ? Mixture{70.0, 1e6, 120.0, 3e4} : Mixture{x < edge ? 70.0 : 120.0, 1e6};
  });
  for (int y = 0; y < height; ++y)
    EXPECT_NEAR(image.depth_m(y, edge) / table.bin_m(), 70.0, 0.48) << y;
  EXPECT_GE(count_marked(image).at_edge, height * 9 / 10);
  EXPECT_LE(count_marked(image).elsewhere, height * width / 100);
}

TEST_F(MixedPixelsOfFrames, SnappedDepthIsThatOfAPixelNearby) {
  const DepthImage before = setup.decoder.decode(edge_frame);
  const DepthImage image = marked(setup, edge_frame, MixedPixels::snap);
  for (int y = 0; y < height; ++y) {
    if (image.status(y, edge) != PixelStatus::mixed) continue;
    bool is_neighbours = false;
    for (int dy = -3; dy <= 3; ++dy)
      for (int dx = -3; dx <= 3; ++dx)
        if ((dy != 0 || dx != 0) && y + dy >= 0 && y + dy < height)
          is_neighbours |= image.depth_m(y, edge) == before.depth_m(y + dy, edge + dx);
    EXPECT_TRUE(is_neighbours) << y;
    // The near surface is brighter.
    EXPECT_NEAR(image.depth_m(y, edge), 70.0 * table.bin_m(), 0.2) << y;
  }
}

TEST_F(MixedPixelsOfFrames, DroppedPixelsHaveNoValues) {
  const DepthImage image = marked(setup, edge_frame, MixedPixels::drop);
  EXPECT_GT(share_marked(image), 0.0);
  for (std::size_t i = 0; i < image.status.size(); ++i) {
    const bool is_mixed = image.status.pixels[i] == PixelStatus::mixed;
    EXPECT_EQ(std::isnan(image.depth_m.pixels[i]), is_mixed);
    EXPECT_EQ(std::isnan(image.signal_e_per_s.pixels[i]), is_mixed);
    EXPECT_EQ(std::isnan(image.confidence.pixels[i]), is_mixed);
  }
}

TEST_F(MixedPixelsOfFrames, AreTheSameIfOnlyDepthIsRequested) {
  const auto backend = cpu_backend(make_decoder(DecodeMethod::zncc, table));
  const auto pipeline = backend->prepare({}, height, width);
  ASSERT_TRUE(pipeline->submit(view_of_frame(edge_frame, 0)));
  DepthImage image({DecodedPlane::depth}, height, width);
  decode_frame(*pipeline, {.maps = {}, .mixed = MixedPixels::snap}, 0, height,
               DecodedView::of(image));
  EXPECT_EQ(image.depth_m.pixels, marked(setup, edge_frame, MixedPixels::snap).depth_m.pixels);
}

TEST_F(MixedPixelsOfFrames, SurfacesAndObjectsOnePixelWideAreUnchanged) {
  const SceneOfMixtures flat = [](int, int) { return Mixture{90.0}; };
  const SceneOfMixtures slanted = [](int y, int x) { return Mixture{60.0 + 0.6 * x + 0.3 * y}; };
  const SceneOfMixtures textured = [](int y, int x) {
    return Mixture{90.0, (x / 3 + y / 3) % 2 == 0 ? 1e5 : 1.5e4};
  };
  const SceneOfMixtures lines = [](int, int x) {
    return Mixture{x == 12 || x == 40 ? 60.0 : 130.0};
  };
  for (const SceneOfMixtures& scene : {flat, slanted, textured, lines})
    EXPECT_EQ(share_marked(marked_scene(scene)), 0.0);
}

TEST_F(MixedPixelsOfFrames, NoiseAtASharpEdgeMarksFewPixels) {
  const DepthImage image = marked_scene([](int, int x) {
    return Mixture{x < edge ? 70.0 : 120.0, 3e4};
  });
  EXPECT_LT(share_marked(image), 0.005);
}

TEST_F(MixedPixelsOfFrames, EdgesOfASteepFloorAreFound) {
  // 1.6 bins per row are 12 cm per pixel, far above the noise.
  const auto seen = [](int row, int column) {
    Mixture pixel = edge_between(column);
    pixel.depth_bin += 1.6 * row;
    pixel.second_bin = 190.0;
    if (column > edge) pixel.depth_bin = 190.0;
    return pixel;
  };
  const DepthImage image = marked_scene(seen);
  EXPECT_GE(count_marked(image).at_edge, height * 8 / 10);
  EXPECT_LE(count_marked(image).elsewhere, height * width / 100);
}

/// A frame whose mixed pixels a filter has turned into single returns between both surfaces.
RawFrames filtered_frame(const DecodingTable& table) {
  return frame_of_mixtures(table,
                           [](int, int x) { return x == edge ? Mixture{95.0} : edge_between(x); });
}

TEST_F(MixedPixelsOfFrames, UnfilteredValuesRevealMixedPixelsHiddenByAFilter) {
  const RawFrames filtered = filtered_frame(table);
  const RawView measured = view_of_frame(edge_frame, 0);
  const auto marked_at_the_edge = [&](const UnfilteredPixels& unfiltered) {
    DepthImage image = setup.decoder.decode(filtered);
    mark_mixed_pixels(table, view_of_frame(filtered, 0), MixedPixels::label, DecodedView::of(image),
                      {}, {}, unfiltered);
    return count_marked(image).at_edge;
  };
  EXPECT_EQ(marked_at_the_edge({}), 0);
  EXPECT_GE(marked_at_the_edge({.measured = &measured}), height - 2);
}

TEST_F(MixedPixelsOfFrames, PreviouslyFoundPixelsStayMarkedAndBelongToNoSurface) {
  const RawFrames filtered = filtered_frame(table);
  const RawView measured = view_of_frame(edge_frame, 0);
  UnfilteredPixels unfiltered{.measured = &measured,
                              .mixed = Image<std::uint8_t>(height, width, 0)};
  for (int y = 0; y < height; ++y) unfiltered.mixed(y, edge) = 1;
  unfiltered.mixed(5, 12) = 1;  // in the near surface
  for (const MixedPixels mixed : all_values<MixedPixels>) {
    const DepthImage before = setup.decoder.decode(filtered);
    DepthImage image = before;
    const std::int64_t count = mark_mixed_pixels(table, view_of_frame(filtered, 0), mixed,
                                                 DecodedView::of(image), {}, {}, unfiltered);
    EXPECT_EQ(count, std::ranges::count(image.status.pixels, PixelStatus::mixed));
    EXPECT_EQ(image.status(5, 12), PixelStatus::mixed);
    for (int y = 0; y < height; ++y) {
      EXPECT_EQ(image.status(y, edge), PixelStatus::mixed) << y;
      if (mixed != MixedPixels::snap) continue;
      EXPECT_NEAR(image.depth_m(y, edge), 70.0 * table.bin_m(), 0.2) << y;
    }
  }
  unfiltered.mixed = Image<std::uint8_t>(3, 4, 0);
  DepthImage image = setup.decoder.decode(filtered);
  EXPECT_THAT(
      [&] {
        mark_mixed_pixels(table, view_of_frame(filtered, 0), MixedPixels::label,
                          DecodedView::of(image), {}, {}, unfiltered);
      },
      testing::ThrowsMessage<std::invalid_argument>(testing::HasSubstr("unfiltered.mixed")));
}

TEST(MixedPixels, ThreeMeasurementsMarkNothing) {
  const DecodeSetup setup("hamiltonian-k3", camera_with("paper-10f0"));
  const RawFrames raw =
      frame_of_mixtures(setup.decoder.table(), [](int, int x) { return edge_between(x); });
  EXPECT_EQ(share_marked(marked(setup, raw)), 0.0);
}

TEST_F(MixedPixelsOfFrames, SinglePixelsAndEmptyFramesAreUnchanged) {
  RawFrames raw = frame_of_mixtures(table, [](int, int) { return Mixture{90.0}; });
  RawFrames one = raw;
  one.height = one.width = 1;
  one.values.resize(static_cast<std::size_t>(one.measurements));
  EXPECT_EQ(marked(setup, one).status(0, 0), PixelStatus::ok);
  std::ranges::fill(raw.values, std::numeric_limits<float>::quiet_NaN());
  for (const PixelStatus status : marked(setup, raw, MixedPixels::drop).status.pixels)
    EXPECT_EQ(status, PixelStatus::invalid);
}

TEST_F(MixedPixelsOfFrames, RequireMatchingPlanesAndShapes) {
  const RawFrames raw = frame_of_mixtures(table, [](int, int) { return Mixture{90.0}; });
  DepthImage image = setup.decoder.decode(raw);
  DecodedView view = DecodedView::of(image);
  view.status = nullptr;
  EXPECT_THROW(mark_mixed_pixels(table, view_of_frame(raw, 0), MixedPixels::label, view),
               std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith

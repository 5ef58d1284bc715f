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

namespace tofsmith {
namespace {

constexpr int height = 40, width = 60, edge = 30;

struct Seen {
  double depth_bin = 0.0, signal_e_per_s = 1e5;
  double second_bin = 0.0, second_e_per_s = 0.0;
};
using SceneOfPixels = std::function<Seen(int row, int column)>;

RawFrames frame_seen(const DecodingTable& table, const SceneOfPixels& scene) {
  return frame_by_pixel(
      table.measurements(), height, width, 1,
      [&](int y, int x, RandomStream& random, std::vector<float>& raw) {
        const Seen seen = scene(y, x);
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
Seen edge_between(int column) {
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

DecodeSetup setup_of(const std::string& code = "hamiltonian-k5") {
  return DecodeSetup(code, camera_with("paper-10f0"));
}

TEST(MixedPixels, NamesAreReadBack) {
  for (const MixedPixels mixed : all_mixed_pixels)
    EXPECT_EQ(parse_mixed_pixels(name_of(mixed)), mixed);
  EXPECT_THROW(parse_mixed_pixels("near"), std::invalid_argument);
}

TEST(MixedPixels, MixturesOfTwoSurfacesAreLabelledAndKeepTheirDepth) {
  const DecodeSetup setup = setup_of();
  const RawFrames raw =
      frame_seen(setup.decoder.table(), [](int, int x) { return edge_between(x); });
  const DepthImage before = setup.decoder.decode(raw), image = marked(setup, raw);
  int found = 0, elsewhere = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const bool is_mixed = image.status(y, x) == PixelStatus::mixed;
      (x == edge ? found : elsewhere) += is_mixed ? 1 : 0;
      EXPECT_EQ(image.depth_m(y, x), before.depth_m(y, x));
      if (!is_mixed) {
        EXPECT_EQ(image.status(y, x), before.status(y, x));
      }
    }
  EXPECT_GE(found, height - 2);
  EXPECT_LE(elsewhere, height * width / 200);
}

TEST(MixedPixels, TheMiddleOfARibbonFivePixelsWideIsFound) {
  const DecodeSetup setup = setup_of();
  const DepthImage image = marked(setup, frame_seen(setup.decoder.table(), [](int, int x) {
                                    const double share = 0.5 + 0.1 * (x - edge);
                                    if (x < edge - 2) return Seen{70.0};
                                    if (x > edge + 2) return Seen{120.0};
                                    return Seen{70.0, (1 - share) * 1e5, 120.0, share * 1e5};
                                  }));
  int found = 0;
  for (int y = 0; y < height; ++y) found += image.status(y, edge) == PixelStatus::mixed ? 1 : 0;
  EXPECT_GE(found, height * 8 / 10);
}

TEST(MixedPixels, ASmallShareOfAnotherSurfaceIsFound) {
  const DecodeSetup setup = setup_of();
  const DepthImage image =
      marked(setup, frame_seen(setup.decoder.table(), [](int, int x) {
               return x == edge ? Seen{70.0, 1e6, 120.0, 3e4} : Seen{x < edge ? 70.0 : 120.0, 1e6};
             }));
  int found = 0;
  for (int y = 0; y < height; ++y) {
    EXPECT_NEAR(image.depth_m(y, edge) / setup.decoder.table().bin_m(), 70.0, 0.48) << y;
    found += image.status(y, edge) == PixelStatus::mixed ? 1 : 0;
  }
  EXPECT_GE(found, height * 9 / 10);
  EXPECT_LE(share_marked(image) * height * width - found, height * width / 100);
}

TEST(MixedPixels, SnappedDepthIsThatOfAPixelNearby) {
  const DecodeSetup setup = setup_of();
  const RawFrames raw =
      frame_seen(setup.decoder.table(), [](int, int x) { return edge_between(x); });
  const DepthImage before = setup.decoder.decode(raw);
  const DepthImage image = marked(setup, raw, MixedPixels::snap);
  for (int y = 0; y < height; ++y) {
    if (image.status(y, edge) != PixelStatus::mixed) continue;
    bool is_neighbours = false;
    for (int dy = -3; dy <= 3; ++dy)
      for (int dx = -3; dx <= 3; ++dx)
        if ((dy != 0 || dx != 0) && y + dy >= 0 && y + dy < height)
          is_neighbours |= image.depth_m(y, edge) == before.depth_m(y + dy, edge + dx);
    EXPECT_TRUE(is_neighbours) << y;
    // The near surface is brighter.
    EXPECT_NEAR(image.depth_m(y, edge), 70.0 * setup.decoder.table().bin_m(), 0.2) << y;
  }
}

TEST(MixedPixels, DroppedPixelsHaveNoValues) {
  const DecodeSetup setup = setup_of();
  const RawFrames raw =
      frame_seen(setup.decoder.table(), [](int, int x) { return edge_between(x); });
  const DepthImage image = marked(setup, raw, MixedPixels::drop);
  EXPECT_GT(share_marked(image), 0.0);
  for (std::size_t i = 0; i < image.status.size(); ++i) {
    const bool is_mixed = image.status.pixels[i] == PixelStatus::mixed;
    EXPECT_EQ(std::isnan(image.depth_m.pixels[i]), is_mixed);
    EXPECT_EQ(std::isnan(image.signal_e_per_s.pixels[i]), is_mixed);
    EXPECT_EQ(std::isnan(image.confidence.pixels[i]), is_mixed);
  }
}

TEST(MixedPixels, SurfacesWithoutAnEdgeAreUnchanged) {
  const DecodeSetup setup = setup_of();
  const SceneOfPixels flat = [](int, int) { return Seen{90.0}; };
  const SceneOfPixels slanted = [](int y, int x) { return Seen{60.0 + 0.6 * x + 0.3 * y}; };
  const SceneOfPixels textured = [](int y, int x) {
    return Seen{90.0, (x / 3 + y / 3) % 2 == 0 ? 1e5 : 1.5e4};
  };
  for (const SceneOfPixels& scene : {flat, slanted, textured})
    EXPECT_EQ(share_marked(marked(setup, frame_seen(setup.decoder.table(), scene))), 0.0);
}

TEST(MixedPixels, NoiseAtASharpEdgeMarksFewPixels) {
  const DecodeSetup setup = setup_of();
  const RawFrames raw = frame_seen(setup.decoder.table(), [](int, int x) {
    return Seen{x < edge ? 70.0 : 120.0, 3e4};
  });
  EXPECT_LT(share_marked(marked(setup, raw)), 0.005);
}

TEST(MixedPixels, ObjectsOnePixelWideAreKept) {
  const DecodeSetup setup = setup_of();
  const RawFrames raw = frame_seen(
      setup.decoder.table(), [](int, int x) { return Seen{x == 12 || x == 40 ? 60.0 : 130.0}; });
  EXPECT_EQ(share_marked(marked(setup, raw)), 0.0);
}

TEST(MixedPixels, EdgesOfASteepFloorAreFound) {
  const DecodeSetup setup = setup_of();
  // 1.6 bins per row are 12 cm per pixel, far above the noise.
  const auto seen = [](int row, int column) {
    Seen pixel = edge_between(column);
    pixel.depth_bin += 1.6 * row;
    pixel.second_bin = 190.0;
    if (column > edge) pixel.depth_bin = 190.0;
    return pixel;
  };
  const DepthImage image = marked(setup, frame_seen(setup.decoder.table(), seen));
  int found = 0, elsewhere = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      (x == edge ? found : elsewhere) += image.status(y, x) == PixelStatus::mixed ? 1 : 0;
  EXPECT_GE(found, height * 8 / 10);
  EXPECT_LE(elsewhere, height * width / 100);
}

/// A frame whose mixed pixels a filter has turned into single returns between both surfaces.
RawFrames filtered_frame(const DecodingTable& table) {
  return frame_seen(table, [](int, int x) { return x == edge ? Seen{95.0} : edge_between(x); });
}

TEST(MixedPixels, UnfilteredValuesRevealMixedPixelsHiddenByAFilter) {
  const DecodeSetup setup = setup_of();
  const RawFrames own =
      frame_seen(setup.decoder.table(), [](int, int x) { return edge_between(x); });
  const RawFrames filtered = filtered_frame(setup.decoder.table());
  const RawView measured = view_of_frame(own, 0);
  const auto marked_at_the_edge = [&](const UnfilteredPixels& unfiltered) {
    DepthImage image = setup.decoder.decode(filtered);
    mark_mixed_pixels(setup.decoder.table(), view_of_frame(filtered, 0), MixedPixels::label,
                      DecodedView::of(image), {}, {}, unfiltered);
    int count = 0;
    for (int y = 0; y < height; ++y) count += image.status(y, edge) == PixelStatus::mixed ? 1 : 0;
    return count;
  };
  EXPECT_EQ(marked_at_the_edge({}), 0);
  EXPECT_GE(marked_at_the_edge({.measured = &measured}), height - 2);
}

TEST(MixedPixels, PreviouslyFoundPixelsStayMarkedAndBelongToNoSurface) {
  const DecodeSetup setup = setup_of();
  const RawFrames own =
      frame_seen(setup.decoder.table(), [](int, int x) { return edge_between(x); });
  const RawFrames filtered = filtered_frame(setup.decoder.table());
  const RawView measured = view_of_frame(own, 0);
  UnfilteredPixels unfiltered{.measured = &measured,
                              .mixed = Image<std::uint8_t>(height, width, 0)};
  for (int y = 0; y < height; ++y) unfiltered.mixed(y, edge) = 1;
  unfiltered.mixed(5, 12) = 1;  // in the near surface
  for (const MixedPixels mixed : all_mixed_pixels) {
    const DepthImage before = setup.decoder.decode(filtered);
    DepthImage image = before;
    const std::int64_t count = mark_mixed_pixels(setup.decoder.table(), view_of_frame(filtered, 0),
                                                 mixed, DecodedView::of(image), {}, {}, unfiltered);
    EXPECT_EQ(count, std::ranges::count(image.status.pixels, PixelStatus::mixed));
    EXPECT_EQ(image.status(5, 12), PixelStatus::mixed);
    for (int y = 0; y < height; ++y) {
      EXPECT_EQ(image.status(y, edge), PixelStatus::mixed) << y;
      if (mixed != MixedPixels::snap) continue;
      EXPECT_NEAR(image.depth_m(y, edge), 70.0 * setup.decoder.table().bin_m(), 0.2) << y;
    }
  }
  unfiltered.mixed = Image<std::uint8_t>(3, 4, 0);
  DepthImage image = setup.decoder.decode(filtered);
  EXPECT_THAT(
      [&] {
        mark_mixed_pixels(setup.decoder.table(), view_of_frame(filtered, 0), MixedPixels::label,
                          DecodedView::of(image), {}, {}, unfiltered);
      },
      testing::ThrowsMessage<std::invalid_argument>(testing::HasSubstr("unfiltered.mixed")));
}

TEST(MixedPixels, ThreeMeasurementsMarkNothing) {
  const DecodeSetup setup = setup_of("hamiltonian-k3");
  const RawFrames raw =
      frame_seen(setup.decoder.table(), [](int, int x) { return edge_between(x); });
  EXPECT_EQ(share_marked(marked(setup, raw)), 0.0);
}

TEST(MixedPixels, SinglePixelsAndEmptyFramesAreUnchanged) {
  const DecodeSetup setup = setup_of();
  RawFrames raw = frame_seen(setup.decoder.table(), [](int, int) { return Seen{90.0}; });
  RawFrames one = raw;
  one.height = one.width = 1;
  one.values.resize(static_cast<std::size_t>(one.measurements));
  EXPECT_EQ(marked(setup, one).status(0, 0), PixelStatus::ok);
  std::ranges::fill(raw.values, std::numeric_limits<float>::quiet_NaN());
  for (const PixelStatus status : marked(setup, raw, MixedPixels::drop).status.pixels)
    EXPECT_EQ(status, PixelStatus::invalid);
}

TEST(MixedPixels, RequireMatchingPlanesAndShapes) {
  const DecodeSetup setup = setup_of();
  const RawFrames raw = frame_seen(setup.decoder.table(), [](int, int) { return Seen{90.0}; });
  DepthImage image = setup.decoder.decode(raw);
  DecodedView view = DecodedView::of(image);
  view.status = nullptr;
  EXPECT_THROW(
      mark_mixed_pixels(setup.decoder.table(), view_of_frame(raw, 0), MixedPixels::label, view),
      std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith

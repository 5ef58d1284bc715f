// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "decode_setup.hpp"
#include "tofsmith/decode/filter.hpp"
#include "tofsmith/decode/frame_pipeline.hpp"

namespace tofsmith {
namespace {

constexpr int height = 64, width = 96, captures = 32;

struct Seen {
  double depth_bin, signal_e_per_s;
};
using SceneOfPixels = std::function<Seen(int row, int column)>;
using Part = std::function<bool(int row, int column)>;

int from_border(int row, int column) {
  return std::min({row, column, height - 1 - row, width - 1 - column});
}
bool is_inner(int row, int column) { return from_border(row, column) >= 13; }
bool is_at_border(int row, int column) { return from_border(row, column) < 3; }

struct Repeats {
  std::vector<std::vector<double>> depth, deviation;

  Repeats(const DecodeSetup& setup, FilterStrength strength, const SceneOfPixels& scene) {
    const DecodingTable& table = setup.decoder.table();
    const Filter filter(table, FilterOptions::of(strength));
    FilteredFrame filtered;
    DepthImage image(height, width);
    for (unsigned capture = 1; capture <= captures; ++capture) {
      const RawFrames raw = frame_by_pixel(
          table.measurements(), height, width, capture,
          [&](int y, int x, RandomStream& random, std::vector<float>& values) {
            const Seen seen = scene(y, x);
            append_noisy_pixel(table, seen.signal_e_per_s, 1e4, seen.depth_bin, random, values);
          });
      filter.apply(view_of_frame(raw, 0), filtered);
      setup.decoder.decode(filtered.view(), DecodedView::of(image));
      depth.emplace_back(), deviation.emplace_back();
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          depth.back().push_back(std::remainder(
              image.depth_m(y, x) / table.bin_m() - scene(y, x).depth_bin, table.bin_count()));
          deviation.back().push_back(image.deviation_m(y, x) / table.bin_m());
        }
    }
  }

  /// Spread over predicted deviation.
  double ratio(const Part& part) const {
    double squares = 0.0, count = 0.0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        if (!part(y, x)) continue;
        const auto at = static_cast<std::size_t>(y * width + x);
        double mean = 0.0;
        for (const auto& capture : depth) mean += capture[at] / captures;
        for (std::size_t i = 0; i < captures; ++i)
          squares += std::pow((depth[i][at] - mean) / deviation[i][at], 2);
        count += captures - 1;
      }
    return std::sqrt(squares / count);
  }
};

class FilterDeviation : public testing::TestWithParam<FilterStrength> {
 protected:
  DecodeSetup setup{"hamiltonian-k5", camera_with("paper-10f0")};
};

// Few windows are independent: the standard error of the spread is about 3 %.
TEST_P(FilterDeviation, EqualsTheSpreadOfRepeatedCapturesOnAFlatPlane) {
  for (const double signal : {3e3, 3e4}) {
    const Repeats repeats(setup, GetParam(), [&](int, int) { return Seen{61.3, signal}; });
    EXPECT_NEAR(repeats.ratio(is_inner), 1.0, 0.06) << signal;
    EXPECT_NEAR(repeats.ratio(is_at_border), 1.0, 0.08) << signal;
  }
}

TEST_P(FilterDeviation, EqualsTheSpreadOfRepeatedCapturesOnASlantedPlane) {
  const Repeats repeats(setup, GetParam(), [](int row, int column) {
    return Seen{60.0 + 0.1 * column + 0.04 * row, 1.5e4};
  });
  EXPECT_NEAR(repeats.ratio(is_inner), 1.0, 0.1);
}

TEST_P(FilterDeviation, EqualsTheSpreadOfRepeatedCapturesForAnyAlbedo) {
  const Repeats repeats(setup, GetParam(), [](int row, int column) {
    const bool is_dark = (row / 3 * 7 + column / 3 * 5) % 4 == 0;
    return Seen{61.3, is_dark ? 8e3 : 4e4};
  });
  EXPECT_NEAR(repeats.ratio(is_inner), 1.0, 0.07);
}

// Noise changes the weights of pixels whose depth differs.
TEST(FilterDeviationOfLight, IncludesTheNoiseOfWeightsOnASteepPlane) {
  const DecodeSetup setup("hamiltonian-k5", camera_with("paper-10f0"));
  const Repeats repeats(setup, FilterStrength::light, [](int row, int column) {
    return Seen{60.0 + 0.2 * column + 0.08 * row, 1e5};
  });
  EXPECT_NEAR(repeats.ratio(is_inner), 1.0, 0.15);
}

TEST_P(FilterDeviation, IsAtMostAThirdTooSmallNearAnEdge) {
  const Repeats repeats(setup, GetParam(), [](int, int column) {
    return Seen{column < 48 ? 60.0 : 75.0, 2e4};
  });
  const auto beside_edge = [](int row, int column) {
    return from_border(row, column) >= 8 && (column == 47 || column == 48);
  };
  EXPECT_LT(repeats.ratio(beside_edge), 1.3);
}

/// Square of the depth error over that of the deviation which decode_frame() reports: median over
/// pixels of the ratio of means over captures.
double squared_error_ratio(const DecodeSetup& setup, FilterStrength strength,
                           const SceneOfPixels& scene, const Part& part) {
  const DecodingTable& table = setup.decoder.table();
  const Filter filter(table, FilterOptions::of(strength));
  const std::unique_ptr<FrameBackend> backend =
      cpu_backend(make_decoder(DecodeMethod::zncc, table));
  const std::unique_ptr<FramePipeline> pipeline =
      backend->prepare({.filter = &filter, .keeps_filtered = true}, height, width);
  DepthImage image(height, width);
  std::vector<double> errors(height * width), variances(height * width), ratios;
  for (unsigned capture = 1; capture <= captures; ++capture) {
    const RawFrames raw = frame_by_pixel(
        table.measurements(), height, width, capture,
        [&](int y, int x, RandomStream& random, std::vector<float>& values) {
          const Seen seen = scene(y, x);
          append_noisy_pixel(table, seen.signal_e_per_s, 1e4, seen.depth_bin, random, values);
        });
    pipeline->submit(view_of_frame(raw, 0));
    decode_frame(*pipeline, {}, 0, height, DecodedView::of(image));
    for (int i = 0; i < height * width; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const double bins = image.depth_m.pixels[at] / table.bin_m();
      const double error =
          std::remainder(bins - scene(i / width, i % width).depth_bin, table.bin_count());
      errors[at] += error * error;
      variances[at] += std::pow(image.deviation_m.pixels[at] / table.bin_m(), 2);
    }
  }
  for (int i = 0; i < height * width; ++i)
    if (part(i / width, i % width))
      ratios.push_back(errors[static_cast<std::size_t>(i)] /
                       variances[static_cast<std::size_t>(i)]);
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return *middle;
}

// Without the bias, the ratio is about six times as large.
TEST_P(FilterDeviation, IncludesTheBiasNearTheEdgeOfACurvedSurface) {
  const auto ball = [](int row, int column) {
    const double radius = std::hypot(row - 32.0, column - 48.0) / 24.0;
    return radius < 1.0 ? Seen{60.0 - 8.0 * std::sqrt(1.0 - radius * radius), 1e5}
                        : Seen{90.0, 5e4};
  };
  const auto beside_edge = [](int row, int column) {
    return std::abs(std::hypot(row - 32.0, column - 48.0) - 23.0) < 1.0;
  };
  EXPECT_LT(squared_error_ratio(setup, GetParam(), ball, beside_edge), 3.0);
}

TEST_P(FilterDeviation, IncludesNoBiasOnAFlatPlane) {
  const auto plane = [](int, int) { return Seen{61.3, 3e4}; };
  EXPECT_NEAR(squared_error_ratio(setup, GetParam(), plane, is_inner), 1.0, 0.2);
}

INSTANTIATE_TEST_SUITE_P(Strengths, FilterDeviation, testing::ValuesIn(all_filter_strengths),
                         [](const auto& strength) { return std::string(name_of(strength.param)); });

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "decode/filter/slope_kernel.hpp"
#include "decode_setup.hpp"
#include "each_target.hpp"
#include "tofsmith/decode/filter.hpp"
#include "tofsmith/decode/frame_pipeline.hpp"

namespace tofsmith {

namespace {

// Blending of a filter's sums over near neighbours with its sums over far neighbours.

/// Planes of near and far sums with a margin, rank 3 of 4 coordinates.
struct Sums {
  static constexpr int height = 15, width = 43, planes = 4, rank = 3, samples = 16;
  static constexpr double brightness = 4.0;
  FilterGrid grid{.height = height, .width = width, .stride = 96, .margin = 32};
  static constexpr std::ptrdiff_t rows_above = 12, plane_floats = 96 * (height + 2 * rows_above);
  std::vector<float> storage = std::vector<float>((2 * planes + 6) * plane_floats, 0.0f);
  std::vector<float> points = std::vector<float>(samples * planes);

  float* plane(int index) {
    return storage.data() + index * plane_floats + rows_above * grid.stride + grid.margin;
  }
  float* near(int k) { return plane(k); }
  float* far(int k) { return plane(planes + k); }
  float* usable() { return plane(2 * planes); }
  float* near_variance() { return plane(2 * planes + 1); }
  float* far_variance() { return plane(2 * planes + 2); }
  float* depth() { return plane(2 * planes + 5); }

  Sums() {
    for (int n = 0; n < samples; ++n)
      for (int k = 0; k < planes; ++k)
        points[static_cast<std::size_t>(n * planes + k)] = static_cast<float>(
            std::cos(2 * std::numbers::pi * (n / double{samples} + 0.2 * k)) + 0.3 * k);
    RandomStream random(3, 0);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const std::ptrdiff_t at = y * grid.stride + x;
        usable()[at] = (x + 3 * y) % 11 == 0 ? 0.0f : 1.0f;
        near_variance()[at] = static_cast<float>(1.0 + random.uniform());
        far_variance()[at] = static_cast<float>(0.1 + 1.2 * random.uniform());
        depth()[at] = static_cast<float>(0.999 * samples * random.uniform());
        // Differences well below the noise, equal to it on one line, and well above it.
        const double bins = x < 12 ? 0.01 : x < 32 ? (x == y + 15 ? 0.09 : 0.01) : 0.2;
        for (int k = 0; k < planes; ++k) {
          far(k)[at] = static_cast<float>(brightness * 40.0 * on(at, k));
          near(k)[at] = static_cast<float>(brightness * 70.0 *
                                               (on(at, k) + bins / brightness * per_bin(at, k)) +
                                           0.2 * (random.uniform() - 0.5));
        }
      }
  }

  double point(int n, int k) const {
    return points[static_cast<std::size_t>(n % samples * planes + k)];
  }
  double on(std::ptrdiff_t at, int k) {
    const int n = static_cast<int>(depth()[at]);
    return point(n, k) + (double{depth()[at]} - n) * per_bin(at, k);
  }
  double per_bin(std::ptrdiff_t at, int k) {
    const int n = static_cast<int>(depth()[at]);
    return point(n + 1, k) - point(n, k);
  }

  void keep() {
    NearAndFar sums{.planes = planes,
                    .rank = rank,
                    .usable = usable(),
                    .depth = depth(),
                    .near_variance = near_variance(),
                    .far_variance = far_variance(),
                    .difference = plane(2 * planes + 3),
                    .kept = plane(2 * planes + 4)};
    for (std::size_t k = 0; k < planes; ++k)
      sums.near[k] = near(static_cast<int>(k)), sums.far[k] = far(static_cast<int>(k));
    const CurvePoints curve{points.data(), samples, planes, rank};
    for (int y = 0; y < height; ++y) compare_sums(curve, sums, grid, y);
    for (int y = 0; y < height; ++y) keep_near(sums, grid, y);
  }

  double difference(std::ptrdiff_t at) {
    double far2 = 0.0, dot = 0.0, moved = 0.0, move2 = 0.0;
    for (int k = 0; k < rank; ++k)
      far2 += std::pow(far(k)[at], 2), dot += far(k)[at] * per_bin(at, k);
    for (int k = 0; k < rank; ++k) {
      const double move = per_bin(at, k) - dot / far2 * far(k)[at];
      moved += move * near(k)[at], move2 += move * move;
    }
    const double variance = near_variance()[at];
    if (far2 <= 25.0 * variance) return 0.0;
    return moved / std::sqrt(move2 * std::max(variance - far_variance()[at], 0.25 * variance));
  }

  double kept_around(int y, int x) {
    double squares = 0.0, count = 0.0;
    for (int dy = -6; dy <= 6; dy += 2)
      for (int dx = -6; dx <= 6; dx += 2) {
        const std::ptrdiff_t at = (y + dy) * grid.stride + x + dx;
        if (usable()[at] > 0.0f) squares += std::pow(difference(at), 2), ++count;
      }
    const double excess = std::max(0.0, squares / std::max(count, 1.0) - 2.3);
    return excess / (excess + 0.2);
  }

  /// Returns the kept share of near sums if all pixels around or along a line differ alike.
  double kept_alike(int y, int x) {
    double all = 0.0, usable_around = 0.0;
    for (int dy = -6; dy <= 6; dy += 2)
      for (int dx = -6; dx <= 6; dx += 2) {
        const std::ptrdiff_t at = (y + dy) * grid.stride + x + dx;
        if (usable()[at] > 0.0f) all += difference(at), ++usable_around;
      }
    const double n = std::max(usable_around, 1.0);
    const std::ptrdiff_t pixel = y * grid.stride + x;
    double square = 0.0;
    for (int k = 0; k < rank; ++k) square += std::pow(near(k)[pixel], 2);
    const bool is_bright = square > 2500.0 * near_variance()[pixel];
    double best = is_bright ? std::max(0.0, std::pow(all / n, 2) - 12.0 / n) : 0.0;
    for (const auto& [down, right] : {std::pair(0, 3), {3, 0}, {3, 3}, {3, -3}}) {
      double sum = 0.0, count = 0.0;
      for (int i = -4; i <= 4; ++i) {
        const std::ptrdiff_t at = (y + i * down) * grid.stride + x + i * right;
        if (usable()[at] > 0.0f) sum += difference(at), ++count;
      }
      if (count > 0.0) best = std::max(best, std::pow(sum / count, 2) - 2.0 * 9.0 / count);
    }
    return best / (best + 0.3);
  }
};

TEST(FilterSums, KeepsNearSumsLikeTheReference) {
  for_each_target([] {
    Sums before, after;
    after.keep();
    bool is_none = false, is_around = false, is_alike = false;
    for (int y = 0; y < Sums::height; ++y)
      for (int x = 0; x < Sums::width; ++x) {
        const double around = before.kept_around(y, x), alike = before.kept_alike(y, x);
        const double kept = std::max(around, alike);
        (kept <= 0.0 ? is_none : alike > around ? is_alike : is_around) = true;
        const std::ptrdiff_t at = y * before.grid.stride + x;
        ASSERT_NEAR(after.plane(2 * Sums::planes + 4)[at], kept, 1e-3) << y << ' ' << x;
        for (int k = 0; k < Sums::planes; ++k)
          ASSERT_NEAR(after.far(k)[at],
                      before.far(k)[at] + kept * (before.near(k)[at] - before.far(k)[at]), 0.2)
              << y << ' ' << x;
        ASSERT_NEAR(after.far_variance()[at],
                    before.far_variance()[at] +
                        1.6 * kept * kept *
                            std::max(0.0f, before.near_variance()[at] - before.far_variance()[at]),
                    4e-3);
      }
    EXPECT_TRUE(is_none && is_around && is_alike) << is_none << ' ' << is_around << ' ' << is_alike;
  });
}

/// Mean errors [bins] on balls of 13 pixels radius and 6 bins depth.
std::vector<double> errors_on_balls(double signal, const std::vector<FilterOptions>& filters) {
  const DecodeSetup setup("hamiltonian-k5", camera_with("paper-10f0"));
  const DecodingTable& table = setup.decoder.table();
  const auto outside = [](int y, int x) { return std::hypot(y % 32 - 15.5, x % 32 - 15.5) / 13.0; };
  const auto depth = [&](int y, int x) {
    return 60.0 - 6.0 * std::sqrt(std::max(0.0, 1.0 - std::pow(outside(y, x), 2)));
  };
  const RawFrames raw = frame_seen(table, 96, 128, [&](int y, int x) {
    return Seen{depth(y, x), outside(y, x) < 1.0 ? signal : 0.0};
  });
  std::vector<double> errors;
  for (const FilterOptions& options : filters) {
    const DepthImage image = decode_filtered(setup.decoder, Filter(table, options).apply(raw));
    double sum = 0.0, count = 0.0;
    for (int y = 0; y < 96; ++y)
      for (int x = 0; x < 128; ++x)
        if (outside(y, x) < 1.0) {
          sum += std::abs(
              std::remainder(image.depth_m(y, x) / table.bin_m() - depth(y, x), table.bin_count()));
          ++count;
        }
    errors.push_back(sum / count);
  }
  return errors;
}

TEST(FilterSums, ErrorOnSilhouettesIsAtMostFivePercentAboveNearSumsInBrightLight) {
  FilterOptions near;
  near.windows = 1;
  const auto errors = errors_on_balls(3e5, {{}, near});
  EXPECT_LE(errors[0], 1.05 * errors[1]) << errors[0] << ' ' << errors[1];
}

// Averaging over one side only, where the slope is unknown, biases depth; far neighbours on a
// slanted plane bias the slopes of adjacent pixels.
TEST(FilterSums, SlantedPlanesAreUnbiasedFarFromEdgesInBrightLight) {
  const DecodeSetup setup("hamiltonian-k5", camera_with("paper-10f0"));
  const DecodingTable& table = setup.decoder.table();
  constexpr int captures = 12, height = 72, width = 72;
  // Perspective view of a plane: inverse depth is linear, and light falls with distance.
  const auto depth = [](int y, int x) { return 60.0 / (1.0 - 0.004 * x - 0.0015 * y); };
  const auto surface = [&](int y, int x) {
    return Seen{depth(y, x), 1e5 * std::pow(60.0 / depth(y, x), 2)};
  };
  const Filter filter(table);
  std::vector<double> sum(height * width), squares(height * width);
  for (unsigned capture = 1; capture <= captures; ++capture) {
    const RawFrames raw = frame_seen(table, height, width, surface, 1e4, capture);
    const DepthImage image = decode_filtered(setup.decoder, filter.apply(raw));
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const double error = image.depth_m(y, x) / table.bin_m() - depth(y, x);
        sum[static_cast<std::size_t>(y * width + x)] += error;
        squares[static_cast<std::size_t>(y * width + x)] += error * error;
      }
  }
  double bias2 = 0.0, variance = 0.0;
  for (int y = 26; y < height - 26; ++y)
    for (int x = 26; x < width - 26; ++x) {
      const auto at = static_cast<std::size_t>(y * width + x);
      const double mean = sum[at] / captures;
      const double own = (squares[at] / captures - mean * mean) * captures / (captures - 1);
      bias2 += mean * mean - own / captures, variance += own;
    }
  EXPECT_LT(bias2, 0.2 * 0.2 * variance) << std::sqrt(std::max(0.0, bias2 / variance));
}

TEST(FilterSums, ErrorOnBallsIsAtMostTenPercentAboveTheLightFilter) {
  const auto light = FilterOptions::of(FilterStrength::light);
  for (const double signal : {3e4, 1e5}) {
    const auto errors = errors_on_balls(signal, {{}, light});
    EXPECT_LE(errors[0], 1.1 * errors[1]) << signal << ' ' << errors[0] << ' ' << errors[1];
  }
}

// Standard deviations that filtered frames report.

constexpr int height = 64, width = 96, captures = 32;

using Part = std::function<bool(int row, int column)>;

int from_border(int row, int column) {
  return std::min({row, column, height - 1 - row, width - 1 - column});
}
bool is_inner(int row, int column) { return from_border(row, column) >= 13; }
bool is_at_border(int row, int column) { return from_border(row, column) < 3; }

struct Repeats {
  std::vector<std::vector<double>> depth, deviation;

  /// @param with_bias  uses deviations of decode_frame(), which include the bias near edges
  Repeats(const DecodeSetup& setup, FilterStrength strength, const SceneOfPixels& scene,
          bool with_bias = false) {
    const DecodingTable& table = setup.decoder.table();
    const Filter filter(table, FilterOptions::of(strength));
    const std::unique_ptr<FrameBackend> backend =
        cpu_backend(make_decoder(DecodeMethod::zncc, table));
    const std::unique_ptr<FramePipeline> pipeline =
        backend->prepare({.filter = &filter, .keeps_filtered = true}, height, width);
    DepthImage image(height, width);
    for (unsigned capture = 1; capture <= captures; ++capture) {
      const RawFrames raw = frame_seen(table, height, width, scene, 1e4, capture);
      if (with_bias) {
        pipeline->submit(view_of_frame(raw, 0));
        decode_frame(*pipeline, {}, 0, height, DecodedView::of(image));
      } else {
        image = decode_filtered(setup.decoder, filter.apply(raw));
      }
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

  /// Square of the depth error over that of the deviation: median over pixels of the ratio of means
  /// over captures.
  double squared_error_ratio(const Part& part) const {
    std::vector<double> ratios;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        if (!part(y, x)) continue;
        const auto at = static_cast<std::size_t>(y * width + x);
        double errors = 0.0, variances = 0.0;
        for (std::size_t i = 0; i < captures; ++i)
          errors += std::pow(depth[i][at], 2), variances += std::pow(deviation[i][at], 2);
        ratios.push_back(errors / variances);
      }
    const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
    std::nth_element(ratios.begin(), middle, ratios.end());
    return *middle;
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
  const Repeats repeats(setup, GetParam(), ball, true);
  EXPECT_LT(repeats.squared_error_ratio(beside_edge), 3.0);
}

TEST_P(FilterDeviation, IncludesNoBiasOnAFlatPlane) {
  const auto plane = [](int, int) { return Seen{61.3, 3e4}; };
  const Repeats repeats(setup, GetParam(), plane, true);
  EXPECT_NEAR(repeats.squared_error_ratio(is_inner), 1.0, 0.2);
}

INSTANTIATE_TEST_SUITE_P(Strengths, FilterDeviation, testing::ValuesIn(all_values<FilterStrength>),
                         [](const auto& strength) { return std::string(name_of(strength.param)); });

}  // namespace

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/filter.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "decode/ambient_projection.hpp"
#include "decode/filter/filter_kernel.hpp"
#include "decode_setup.hpp"
#include "each_target.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/statistics.hpp"

namespace tofsmith {
namespace {

double bin_error(const DecodingTable& table, float depth_m, double depth_bin) {
  return std::remainder(depth_m / table.bin_m() - depth_bin, table.bin_count());
}

class FilterOfFrames : public testing::Test {
 protected:
  DecodeSetup setup{"hamiltonian-k4", camera_with("paper-10f0")};
  const DecodingTable& table = setup.decoder.table();
};

/// Reference of the first window of 5 x 5, pair by pair in double.
std::vector<double> reference_window(const DecodingTable& table, const RawFrames& raw,
                                     double max_difference_sigma) {
  const AmbientProjection projection(table);
  const int rank = projection.rank(), k_count = table.measurements();
  const Eigen::VectorXd share = projection.basis.rowwise().squaredNorm() / rank;
  const auto pixels = static_cast<Eigen::Index>(raw.pixels_per_frame());
  Eigen::MatrixXd y(pixels, k_count);
  for (Eigen::Index i = 0; i < pixels; ++i)
    for (int k = 0; k < k_count; ++k)
      y(i, k) = (raw.values[static_cast<std::size_t>(i * k_count + k)] - table.black_level[k]) *
                    table.gain_e_per_raw[k] -
                table.dark_electrons[k];
  const Eigen::MatrixXd u = y * projection.basis;
  const Eigen::VectorXd variance =
      (y.cwiseMax(0.0) * share).array() + share.dot(table.shot_dark() + table.constant_variance_e2);
  const auto inside = [&](int row, int column) {
    return row >= 0 && row < raw.height && column >= 0 && column < raw.width;
  };
  const auto at = [&](int row, int column) { return Eigen::Index{row} * raw.width + column; };
  const auto lambda = [&](int row, int column, int dy, int dx) {
    if (!inside(row, column) || !inside(row + dy, column + dx)) return rank - 1.0;
    const Eigen::Index p = at(row, column), q = at(row + dy, column + dx);
    const double a = u.row(p).squaredNorm() / variance[p], b = u.row(q).squaredNorm() / variance[q];
    const double c = std::max(0.0, u.row(p).dot(u.row(q)) / std::sqrt(variance[p] * variance[q]));
    return 0.5 * (a + b - std::sqrt((a - b) * (a - b) + 4 * c * c));
  };
  std::vector<double> means;
  for (int row = 0; row < raw.height; ++row)
    for (int column = 0; column < raw.width; ++column) {
      Eigen::RowVectorXd sum = y.row(at(row, column));
      double weights = 1.0;
      for (int dy = -2; dy <= 2; ++dy)
        for (int dx = -2; dx <= 2; ++dx) {
          if ((dy == 0 && dx == 0) || !inside(row + dy, column + dx)) continue;
          // The pair's own difference is clipped at the noise limit.
          const double noise_limit = chi2_limit(rank - 1, 3.0);
          double mean = -std::min(lambda(row, column, dy, dx), noise_limit) / 24;
          for (int py = -2; py <= 2; ++py)
            for (int px = -2; px <= 2; ++px) mean += lambda(row + py, column + px, dy, dx) / 24;
          const double difference = (mean - (rank - 1)) * std::sqrt(24.0 / (2 * (rank - 1)));
          const double w =
              std::pow(std::max(0.0, 1 - std::max(0.0, difference) / max_difference_sigma), 4);
          sum += w * y.row(at(row + dy, column + dx));
          weights += w;
        }
      for (int k = 0; k < k_count; ++k) means.push_back(sum[k] / weights);
    }
  return means;
}

TEST(Filter, FirstWindowEqualsTheReference) {
  const DecodeSetup setup("hamiltonian-k5", camera_with("paper-10f0"));
  const DecodingTable& table = setup.decoder.table();
  const RawFrames raw = frame_seen(table, 21, 37, [&](int row, int column) {
    return Seen{row < 10 ? 40.0 + column : 150.0, 2e4 + 1e3 * column};
  });
  const FilterOptions options = FilterOptions::of(FilterStrength::light);
  const std::vector<double> expected = reference_window(table, raw, options.max_difference_sigma);
  for_each_target([&] {
    const RawFrames filtered = Filter(table, options).apply(raw).values();
    ASSERT_EQ(filtered.values.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
      ASSERT_NEAR(filtered.values[i], expected[i], 2e-4 * (100 + std::abs(expected[i]))) << i;
  });
}

TEST_F(FilterOfFrames, SumsAreUnbiasedForAnyAlbedo) {
  RandomStream albedo(7, 0);
  const RawFrames raw = frame_seen(table, 96, 96, [&](int, int) {
    return Seen{70.3, 1e4 + 9e4 * albedo.uniform()};
  });
  for (const FilterStrength strength : all_values<FilterStrength>) {
    const DepthImage image =
        decode_filtered(setup.decoder, Filter(table, FilterOptions::of(strength)).apply(raw));
    double sum = 0.0, squares = 0.0;
    for (const float depth : image.depth_m.pixels) {
      const double error = bin_error(table, depth, 70.3);
      sum += error, squares += error * error;
    }
    const double count = 96.0 * 96.0;
    // Lower limit of the number of independent means: the number of disjoint windows.
    const double windows = strength == FilterStrength::light ? count / 25 : count / 625;
    EXPECT_LT(std::abs(sum / count), 4 * std::sqrt(squares / count / windows)) << name_of(strength);
    EXPECT_LT(std::sqrt(squares / count), 0.1) << name_of(strength);
  }
}

TEST_F(FilterOfFrames, IsInvariantToFlipsAndRotations) {
  const RawFrames raw = frame_seen(table, 40, 52, [&](int row, int column) {
    return Seen{column < 20 ? 60.0 : 100.0 + 0.2 * row, 5e4};
  });
  RawFrames turned = raw;
  const auto k = static_cast<std::ptrdiff_t>(raw.measurements);
  for (std::size_t i = 0; i < raw.pixels_per_frame(); ++i)
    std::copy_n(raw.values.begin() + static_cast<std::ptrdiff_t>(i) * k, k,
                turned.values.end() - static_cast<std::ptrdiff_t>(i + 1) * k);
  const Filter filter(table);
  const FilteredFrame one = filter.apply(raw), other = filter.apply(turned);
  const std::size_t last = raw.pixels_per_frame() - 1;
  for (std::size_t i = 0; i <= last; ++i)
    ASSERT_NEAR(one.averaged().pixels[i], other.averaged().pixels[last - i],
                1e-2 * one.averaged().pixels[i])
        << i;
}

TEST_F(FilterOfFrames, ErrorOnAConstantPlaneFallsWithTheNumberOfAveragedPixels) {
  const RawFrames raw = frame_seen(table, 128, 128, [&](int, int) { return Seen{120.4, 3e4}; });
  const auto deviation = [&](const DepthImage& image) {
    double squares = 0.0;
    int count = 0;
    for (int y = 16; y < 112; ++y)
      for (int x = 16; x < 112; ++x, ++count)
        squares += std::pow(bin_error(table, image.depth_m(y, x), 120.4), 2);
    return std::sqrt(squares / count);
  };
  const double alone = deviation(setup.decoder.decode(raw));
  const FilteredFrame light = Filter(table, FilterOptions::of(FilterStrength::light)).apply(raw);
  double added = 0.0;
  for (const float n : light.averaged().pixels) added += n / (128 * 128);
  EXPECT_GT(added, 18.5);
  EXPECT_NEAR(deviation(decode_filtered(setup.decoder, light)), alone / std::sqrt(added),
              0.15 * alone / std::sqrt(added));
  const FilteredFrame normal = Filter(table).apply(raw);
  EXPECT_GT(normal.averaged()(64, 64), 330.0f);  // 625 without the noise of slopes
  EXPECT_LT(deviation(decode_filtered(setup.decoder, normal)), 1.6 * alone / 25);
}

TEST_F(FilterOfFrames, SlantedPlanesKeepTheirDepth) {
  const auto depth = [](int row, int column) { return 60.0 + 0.31 * column + 0.12 * row; };
  const RawFrames raw = frame_seen(table, 96, 160, [&](int row, int column) {
    return Seen{depth(row, column), 1e5};
  });
  const DepthImage image = decode_filtered(setup.decoder, Filter(table).apply(raw));
  double at_left = 0.0, all = 0.0;
  for (int y = 0; y < 96; ++y)
    for (int x = 0; x < 160; ++x) {
      const double error = bin_error(table, image.depth_m(y, x), depth(y, x));
      all += error / (96 * 160);
      if (x < 4) at_left += error / (96 * 4);
    }
  EXPECT_NEAR(all, 0.0, 0.005);
  EXPECT_NEAR(at_left, 0.0, 0.1);  // all neighbours are farther
}

TEST_F(FilterOfFrames, KeepsAnEdgeOfFiveDeviations) {
  const auto flat = frame_seen(table, 32, 32, [&](int, int) { return Seen{80.0, 3e4}; });
  const DepthImage alone = setup.decoder.decode(flat);
  double sigma = 0.0;
  for (const float s : alone.deviation_m.pixels) sigma += s / 1024;
  const double step = 5 * sigma / table.bin_m();
  const auto depth = [&](int column) { return column < 40 ? 80.0 : 80.0 + step; };
  const RawFrames raw = frame_seen(table, 64, 80, [&](int, int column) {
    return Seen{depth(column), 3e4};
  });
  const DepthImage image = decode_filtered(setup.decoder, Filter(table).apply(raw));
  int on_wrong_side = 0;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 80; ++x) {
      const double error = bin_error(table, image.depth_m(y, x), depth(x));
      on_wrong_side += std::abs(error) > step / 2;
    }
  EXPECT_LE(on_wrong_side, 64);  // one pixel per row, half of it on either side
}

/// Shares of pixels with status ok, of those with light and those without.
struct FoundShares {
  double lit = 0.0, dark = 0.0;
};
FoundShares found_shares(const DepthImage& image, const std::function<bool(int, int)>& is_dark) {
  RunningStatistics lit, dark;
  for (int y = 0; y < image.status.height; ++y)
    for (int x = 0; x < image.status.width; ++x)
      (is_dark(y, x) ? dark : lit).add(image.status(y, x) == PixelStatus::ok);
  return {lit.mean(), dark.mean()};
}

TEST(Filter, GivesNoDepthWhereThereIsNoLight) {
  const DecodeSetup setup("hamiltonian-k4", camera_with("paper-10f0"), {.false_alarm_rate = 0.0});
  const DecodingTable& table = setup.decoder.table();
  const std::vector<std::function<bool(int, int)>> scenes = {
      [](int, int x) { return x >= 64; },                                            // an edge
      [](int y, int x) { return (y - 64) * (y - 64) + (x - 64) * (x - 64) < 900; },  // a hole
      [](int y, int x) { return y + 2 * x > 180; },                                  // aslant
      [](int, int x) { return x % 32 < 3 + x / 64; },                                // narrow gaps
  };
  for (const double signal : {2e3, 5e3, 5e4, 1e6})
    for (const auto& is_dark : scenes) {
      const RawFrames raw = frame_seen(table, 128, 128, [&](int y, int x) {
        return Seen{80.0, is_dark(y, x) ? 0.0 : signal};
      });
      const FoundShares alone = found_shares(setup.decoder.decode(raw), is_dark);
      for (const FilterOptions& options :
           {FilterOptions{.slope_rounds = 0}, FilterOptions::of(FilterStrength::light),
            FilterOptions::of(FilterStrength::normal), FilterOptions::of(FilterStrength::strong)}) {
        const std::string setting =
            fmt::format("windows {}, slope rounds {}, S = {}, scene {}", options.windows,
                        options.slope_rounds, signal, &is_dark - scenes.data());
        const FoundShares found = found_shares(
            decode_filtered(setup.decoder, Filter(table, options).apply(raw)), is_dark);
        // In dim light some pixels next to an edge cannot be distinguished from those with light.
        const double at_rims = signal < 5e3 ? 0.02 : signal < 5e4 ? 0.01 : 0.003;
        EXPECT_LE(found.dark, 1.2 * alone.dark + at_rims) << setting;
        EXPECT_GE(found.lit, signal < 5e3 ? 0.9 : 0.97) << setting;
      }
    }
}

TEST_F(FilterOfFrames, DarkPixelsBetweenTwoSurfacesAreWrongNoMoreOftenThanUnfilteredOnes) {
  constexpr int line = 32;
  const auto depth = [](int row) { return row < line ? 96.0 : 44.4; };
  const RawFrames raw = frame_seen(table, 64, 400, [&](int row, int) {
    return Seen{depth(row), row == line ? 1e3 : row < line ? 4.3e4 : 2e5};
  });
  const auto wrong = [&](const DepthImage& image) {
    int count = 0;
    for (int x = 0; x < 400; ++x)
      count += image.status(line, x) == PixelStatus::ok &&
               std::abs(bin_error(table, image.depth_m(line, x), depth(line))) > 7.0;
    return count;
  };
  const int unfiltered = wrong(setup.decoder.decode(raw));
  for (const FilterStrength strength : {FilterStrength::normal, FilterStrength::strong}) {
    const DepthImage image =
        decode_filtered(setup.decoder, Filter(table, FilterOptions::of(strength)).apply(raw));
    EXPECT_LE(wrong(image), unfiltered) << name_of(strength);
    for (int x = 0; x < 400; ++x) EXPECT_EQ(image.status(line + 2, x), PixelStatus::ok) << x;
  }
}

TEST(Filter, IgnoresAndKeepsInvalidAndSaturatedPixels) {
  Camera camera = camera_with("paper-10f0");
  camera.sensor.full_well_e = 1e4;
  const DecodeSetup setup("hamiltonian-k4", camera);
  const DecodingTable& table = setup.decoder.table();
  const Decoder decoder(table, {.false_alarm_rate = 0.0});
  RawFrames raw = frame_seen(table, 48, 48, [](int, int) { return Seen{55.0, 5e4}; });
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  for (int y = 20; y < 26; ++y)
    for (int x = 20; x < 26; ++x) raw.values[static_cast<std::size_t>((y * 48 + x) * 4 + 1)] = nan;
  for (int y = 30; y < 33; ++y)
    for (int x = 5; x < 9; ++x) raw.values[static_cast<std::size_t>((y * 48 + x) * 4)] = 1e4f;
  for (const FilterStrength strength : all_values<FilterStrength>) {
    const FilteredFrame filtered = Filter(table, FilterOptions::of(strength)).apply(raw);
    const DepthImage image = decode_filtered(decoder, filtered);
    for (int y = 0; y < 48; ++y)
      for (int x = 0; x < 48; ++x) {
        const bool is_invalid = y >= 20 && y < 26 && x >= 20 && x < 26;
        const bool is_saturated = y >= 30 && y < 33 && x >= 5 && x < 9;
        const PixelStatus expected = is_invalid     ? PixelStatus::invalid
                                     : is_saturated ? PixelStatus::saturated
                                                    : PixelStatus::ok;
        ASSERT_EQ(image.status(y, x), expected) << y << ' ' << x;
        if (expected != PixelStatus::ok) {
          ASSERT_EQ(filtered.averaged()(y, x), 1.0f);
          continue;
        }
        ASSERT_LT(std::abs(bin_error(table, image.depth_m(y, x), 55.0)), 0.5) << y << ' ' << x;
      }
  }
}

TEST_F(FilterOfFrames, IgnoresAndKeepsExcludedPixels) {
  RawFrames raw = frame_seen(table, 48, 48, [](int, int) { return Seen{55.0, 5e4}; });
  Image<std::uint8_t> left_out(48, 48);
  for (int y = 4; y < 44; ++y) left_out(y, 20) = 1;
  const Filter filter(table);
  FilteredFrame one, other;
  filter.apply(view_of_frame(raw, 0), one, {}, left_out);
  RawFrames changed = raw;
  for (int y = 4; y < 44; ++y)
    for (int k = 0; k < 4; ++k)
      changed.values[static_cast<std::size_t>((y * 48 + 20) * 4 + k)] *= 1.1f;
  filter.apply(view_of_frame(changed, 0), other, {}, left_out);
  const RawFrames values = one.values(), changed_values = other.values();
  for (std::size_t at = 0; at < values.values.size(); ++at) {
    const std::size_t pixel = at / 4;
    if (left_out.pixels[pixel] == 0) {
      ASSERT_EQ(values.values[at], changed_values.values[at]) << pixel;
      ASSERT_GT(one.averaged().pixels[pixel], 2.0f) << pixel;
    } else {
      ASSERT_EQ(values.values[at], raw.values[at]) << pixel;
      ASSERT_EQ(one.averaged().pixels[pixel], 1.0f) << pixel;
    }
  }
  EXPECT_THROW(filter.apply(view_of_frame(raw, 0), one, {}, Image<std::uint8_t>(3, 4)),
               std::invalid_argument);
}

TEST(Filter, WeighsMeansByTheNumberOfFramesAveraged) {
  for (const Readout readout : {Readout::separate, Readout::difference}) {
    const DecodeSetup setup("hamiltonian-k4", camera_with("paper-10f0", 2, readout));
    const DecodingTable& table = setup.decoder.table();
    constexpr int count = 4;
    const auto plane = [](int, int) { return Seen{55.0, 5e4}; };
    RawFrames mean = frame_seen(table, 48, 48, plane);
    for (int i = 1; i < count; ++i) {
      const RawFrames next = frame_seen(table, 48, 48, plane, 1e4, 1 + static_cast<unsigned>(i));
      for (std::size_t at = 0; at < mean.values.size(); ++at) mean.values[at] += next.values[at];
    }
    for (float& value : mean.values) value /= count;
    mean.values[static_cast<std::size_t>((20 * 48 + 20) * mean.measurements)] =
        std::numeric_limits<float>::quiet_NaN();
    std::vector<float> averaged(48 * 48, count);
    RawView view = view_of_frame(mean, 0);
    view.averaged = averaged.data();
    const Filter filter(table);
    FilteredFrame filtered;
    filter.apply(view, filtered);
    const FilteredFrame single = filter.apply(frame_seen(table, 48, 48, plane));
    double added = 0.0, added_to_single = 0.0;
    for (int y = 15; y < 33; ++y)
      for (int x = 24; x < 33; ++x)
        added += filtered.averaged()(y, x), added_to_single += single.averaged()(y, x);
    EXPECT_NEAR(added / added_to_single, count, 0.2 * count) << static_cast<int>(readout);
    EXPECT_EQ(filtered.averaged()(20, 20), count) << static_cast<int>(readout);
  }
}

TEST_F(FilterOfFrames, IsBitIdenticalForAnyNumberOfThreadsAndLayout) {
  const RawFrames raw = frame_seen(table, 150, 70, [](int row, int column) {
    return Seen{20.0 + 0.3 * row + (column > 33 ? 40.0 : 0.0), 3e4};
  });
  const Filter filter(table, FilterOptions::of(FilterStrength::strong));
  const FilteredFrame expected = filter.apply(raw);
  const std::vector<float> values = expected.values().values;
  for (const int threads : {1, 2, 3, 8}) {
    const ThreadLimit limit(threads);
    const FilteredFrame filtered = filter.apply(raw);
    EXPECT_EQ(filtered.values().values, values) << threads;
    EXPECT_EQ(filtered.averaged().pixels, expected.averaged().pixels) << threads;
  }
  std::vector<double> planar(raw.values.size());
  const std::size_t pixels = raw.pixels_per_frame();
  for (std::size_t i = 0; i < pixels; ++i)
    for (std::size_t k = 0; k < 4; ++k) planar[k * pixels + i] = raw.values[i * 4 + k];
  FilteredFrame filtered;
  filter.apply(RawView::planar(planar.data(), 150, 70, 4), filtered);
  EXPECT_EQ(filtered.values().values, values);
}

TEST_F(FilterOfFrames, ReusesTheMemoryOfAFrame) {
  const Filter filter(table);
  FilteredFrame reused;
  for (const int side : {40, 40, 7, 1, 33}) {
    const RawFrames raw = frame_seen(
        table, side, side + 3,
        [](int row, int) {
          return Seen{20.0 + row, 3e4};
        },
        1e4, static_cast<std::uint64_t>(side));
    filter.apply(view_of_frame(raw, 0), reused);
    EXPECT_EQ(reused.values().values, filter.apply(raw).values().values) << side;
  }
}

TEST(Filter, SupportsAnyCodeAndCamera) {
  Camera counts = camera_with("paper-10f0");
  counts.sensor.adc_bits = 12;
  counts.sensor.gain_e_per_dn = 20.0;
  counts.sensor.black_level_dn = 40.0;
  const auto plane = [](int, int) { return Seen{66.0, 1e5}; };
  for (const auto& [code, camera] :
       {std::pair{"hamiltonian-k3", camera_with("paper-10f0")},
        {"sinusoid-k4", camera_with("paper-10f0")},
        {"multifrequency-k5", camera_with("paper-10f0")},
        {"hamiltonian-k4", counts},
        {"square-k4", camera_with("paper-10f0", 2, Readout::difference)}}) {
    SCOPED_TRACE(code);
    const DecodeSetup setup(code, camera);
    const DecodingTable& table = setup.decoder.table();
    const RawFrames raw = frame_seen(table, 64, 64, plane, 1e3);
    const auto error = [&](const DepthImage& image) {
      double sum = 0.0;
      for (const float depth : image.depth_m.pixels)
        sum += std::abs(bin_error(table, depth, 66.0)) / 4096;
      return sum;
    };
    const double alone = error(setup.decoder.decode(raw));
    EXPECT_LT(error(decode_filtered(setup.decoder, Filter(table).apply(raw))), 0.12 * alone);
  }
}

TEST(Filter, NeedsMemoryOfAtMostSevenFrames) {
  constexpr int height = 480, width = 640, measurements = 4;
  const double frame_bytes = sizeof(float) * double{measurements} * height * width;
  const auto bytes = Filter::memory_bytes(FilterOptions::of(FilterStrength::normal), height, width,
                                          measurements, 1);
  EXPECT_LE(static_cast<double>(bytes), 7 * frame_bytes);
}

TEST_F(FilterOfFrames, RejectsInvalidInputs) {
  EXPECT_THROW(Filter(table, {.windows = 0}), InvalidArgument);
  EXPECT_THROW(Filter(table, {.slope_rounds = -1}), InvalidArgument);
  EXPECT_THROW(Filter(table, {.trusted_pixels = 0.5}), InvalidArgument);
  EXPECT_THROW(parse_word<FilterStrength>("filter strength", "heavy"), std::invalid_argument);
  const Filter filter(table);
  RawFrames raw{.frames = 1, .height = 2, .width = 2, .measurements = 5, .values = {}};
  raw.values.resize(20);
  EXPECT_THROW(filter.apply(raw), InvalidArgument);
  EXPECT_THROW(filter.apply(raw, 1), InvalidArgument);
  raw = {.frames = 1, .height = 0, .width = 2, .measurements = 4, .values = {}};
  EXPECT_THROW(filter.apply(raw), InvalidArgument);
  for (const FilterStrength strength : all_values<FilterStrength>)
    EXPECT_EQ(parse_word<FilterStrength>("filter strength", name_of(strength)), strength);
}

TEST(Filter, KeepsFramesWithoutUsablePixels) {
  const DecodeSetup setup("hamiltonian-k4", camera_with("paper-10f0"));
  RawFrames raw{.frames = 1, .height = 9, .width = 5, .measurements = 4, .values = {}};
  raw.values.assign(180, std::numeric_limits<float>::infinity());
  const FilteredFrame filtered = Filter(setup.decoder.table()).apply(raw);
  EXPECT_EQ(filtered.values().values, raw.values);
  for (const PixelStatus status : decode_filtered(setup.decoder, filtered).status.pixels)
    EXPECT_EQ(status, PixelStatus::invalid);
}

}  // namespace
}  // namespace tofsmith

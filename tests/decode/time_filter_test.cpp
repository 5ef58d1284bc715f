// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "decode_setup.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/decode/filter.hpp"

namespace tofsmith {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr int height = 37, width = 45;
constexpr float nan = std::numeric_limits<float>::quiet_NaN();
using DepthOfPixels = std::function<double(int row, int column)>;

RawFrames frame_of(const DecodingTable& table, const DepthOfPixels& depth, double signal_e_per_s,
                   double ambient_e_per_s, std::uint64_t seed) {
  return frame_seen(
      table, height, width,
      [&](int y, int x) {
        return Seen{depth(y, x), signal_e_per_s};
      },
      ambient_e_per_s, seed);
}

double slanted(int row, int column) { return 60.0 + 0.3 * row + 0.1 * column; }
double with_moved_corner(int row, int column) {
  return slanted(row, column) + (row < 9 && column < 12 ? 40.0 : 0.0);
}

std::vector<float> averaged_of(const RawView& raw) {
  return {raw.averaged, raw.averaged + raw.pixels()};
}

double mean_of(const std::vector<float>& values) {
  double sum = 0.0;
  for (const float value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

DecodingTable table_of(const std::string& code = "hamiltonian-k4",
                       const Camera& camera = camera_with("paper-10f0")) {
  return decoding_table_of(code, camera);
}

/// Returns the last result.
RawView add_static(TimeFilter& filter, int count, double signal, double ambient,
                   std::uint64_t seed) {
  RawView last;
  for (int i = 0; i < count; ++i) {
    const RawFrames raw =
        frame_of(filter.table(), slanted, signal, ambient, seed + static_cast<std::uint64_t>(i));
    last = *filter.add(view_of_frame(raw, 0));
  }
  return last;
}

TEST(TimeFilter, ReturnsTheFirstFrameUnchanged) {
  TimeFilter filter(table_of());
  const RawFrames raw = frame_of(filter.table(), slanted, 1e5, 1e4, 1);
  const RawView first = *filter.add(view_of_frame(raw, 0));
  EXPECT_EQ(values_of(first), raw.values);
  EXPECT_EQ(averaged_of(first), std::vector<float>(height * width, 1.0F));
  add_static(filter, 2, 1e5, 1e4, 2);
  filter.forget();
  EXPECT_EQ(values_of(*filter.add(view_of_frame(raw, 0))), raw.values);
}

TEST(TimeFilter, AtMostOneFrameChangesNothing) {
  TimeFilter filter(table_of(), {.max_frames = 1});
  for (std::uint64_t seed = 1; seed < 4; ++seed) {
    const RawFrames raw = frame_of(filter.table(), slanted, 1e5, 1e4, seed);
    const RawView same = *filter.add(view_of_frame(raw, 0));
    EXPECT_EQ(values_of(same), raw.values);
    EXPECT_EQ(averaged_of(same), std::vector<float>(height * width, 1.0F));
  }
}

struct Light {
  double signal, ambient;
};

/// Expects that a static scene has no bias and the variance implied by `averaged`.
void expect_static_scene_is_unbiased(const DecodingTable& table, const Light& light, int frames,
                                     double min_share) {
  constexpr int captures = 24;
  const auto pixels = static_cast<std::size_t>(height * width);
  const auto k_count = static_cast<std::size_t>(table.measurements());
  double n = 0.0, squares = 0.0, bias = 0.0;
  for (int capture = 0; capture < captures; ++capture) {
    TimeFilter filter(table);
    const RawView last = add_static(filter, frames, light.signal, light.ambient,
                                    static_cast<std::uint64_t>(1000 * (capture + 1)));
    const std::vector<float> values = values_of(last), averaged = averaged_of(last);
    double sum = 0.0;
    for (std::size_t i = 0; i < pixels; ++i) {
      const int row = static_cast<int>(i) / width, column = static_cast<int>(i) % width;
      for (int k = 0; k < table.measurements(); ++k) {
        const Moments of = moments_of(table, light.signal, light.ambient, slanted(row, column), k);
        const double electrons =
            (static_cast<double>(values[i * k_count + static_cast<std::size_t>(k)]) -
             table.black_level[k]) *
            table.gain_e_per_raw[k];
        const double deviations =
            (electrons - of.mean_e) / std::sqrt(of.variance_e2 / static_cast<double>(averaged[i]));
        sum += deviations;
        squares += deviations * deviations;
      }
    }
    bias += sum;
    n += mean_of(averaged);
  }
  const double count = static_cast<double>(pixels * k_count) * captures;
  EXPECT_LT(std::abs(bias / count), 4 / std::sqrt(count));
  EXPECT_NEAR(std::sqrt(squares / count), 1.0, 0.05);
  EXPECT_GT(n / captures, min_share * frames);
}

TEST(TimeFilter, StaticScenesAreAveragedWithoutBias) {
  const DecodingTable table = table_of();
  for (const Light light : {Light{1e3, 1e4}, Light{1e5, 1e4}, Light{1e7, 1e3}})
    for (const int frames : {2, 16}) {
      SCOPED_TRACE(testing::Message() << light.signal << " e/s, " << frames << " frames");
      expect_static_scene_is_unbiased(table, light, frames, 0.97);
    }
}

TEST(TimeFilter, StaticScenesAreAveragedForAnyReadout) {
  for (const auto& [code, camera] :
       {std::pair{"square-k4", camera_with("paper-10f0", 2)},
        std::pair{"square-k4", camera_with("paper-10f0", 2, Readout::difference)},
        std::pair{"sinusoid-k3", camera_with("paper-10f0")}}) {
    SCOPED_TRACE(code);
    expect_static_scene_is_unbiased(table_of(code, camera), {1e5, 0.0}, 16, 0.95);
  }
}

TEST(TimeFilter, OlderFramesLoseWeight) {
  TimeFilter filter(table_of(), {.max_frames = 4});
  const RawView last = add_static(filter, 30, 1e5, 1e4, 1);
  // The newest frame has weight 1/4: the squared weights sum to (1/16) / (1 - 9/16) = 1/7.
  for (const float n : averaged_of(last)) EXPECT_LE(n, 7.001F);
  EXPECT_GT(mean_of(averaged_of(last)), 6.8);
}

TEST(TimeFilter, PixelsThatMovedKeepNoPreviousFrames) {
  TimeFilter filter(table_of());
  add_static(filter, 20, 1e5, 1e4, 1);
  const RawFrames raw = frame_of(filter.table(), with_moved_corner, 1e5, 1e4, 99);
  const RawView view = *filter.add(view_of_frame(raw, 0));
  const std::vector<float> values = values_of(view), averaged = averaged_of(view);
  std::vector<float> stayed;
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      const auto i = static_cast<std::size_t>(row * width + column);
      if (row < 9 && column < 12) {
        EXPECT_EQ(averaged[i], 1.0F) << row << ' ' << column;
        for (std::size_t k = 4 * i; k < 4 * i + 4; ++k) EXPECT_EQ(values[k], raw.values[k]);
      } else if (row > 12 || column > 15) {
        stayed.push_back(averaged[i]);
      }
    }
  EXPECT_GT(mean_of(stayed), 20.0);
}

TEST(TimeFilter, ASinglePixelThatChangesRestarts) {
  TimeFilter filter(table_of());
  add_static(filter, 20, 1e5, 1e4, 1);
  RawFrames raw = frame_of(filter.table(), slanted, 1e5, 1e4, 99);
  const std::size_t pixel = 20 * width + 20;
  raw.values[4 * pixel + 1] *= 1.5F;
  const RawView view = *filter.add(view_of_frame(raw, 0));
  EXPECT_EQ(view.averaged[pixel], 1.0F);
  EXPECT_EQ(values_of(view)[4 * pixel + 1], raw.values[4 * pixel + 1]);
}

TEST(TimeFilter, SmallChangesSharedByNeighboursAreDetected) {
  const DecodingTable table = table_of();
  TimeFilter filter(table);
  add_static(filter, 30, 1e5, 1e4, 1);
  const RawFrames before = frame_of(table, slanted, 1e5, 1e4, 99);
  RawFrames after = before;
  for (float& value : after.values)
    value += 1.0F * std::sqrt(value + static_cast<float>(table.constant_variance_e2[0]));
  EXPECT_LT(mean_of(averaged_of(*filter.add(view_of_frame(after, 0)))), 2.0);
}

TEST(TimeFilter, BeforeAFilterSmallerChangesAreDetected) {
  // All pixels change by a fifth of the standard deviation of each value, or not.
  for (const bool changes : {true, false}) {
    TimeFilter alone(table_of()), before(table_of(), {.before_filter = true});
    RawFrames raw = frame_of(alone.table(), slanted, 1e5, 1e4, 99);
    const auto floor = static_cast<float>(alone.table().constant_variance_e2[0]);
    for (float& value : raw.values)
      value += changes ? 0.2F * std::sqrt(std::max(value, 0.0F) + floor) : 0.0F;
    add_static(alone, 20, 1e5, 1e4, 1);
    add_static(before, 20, 1e5, 1e4, 1);
    const double n_alone = mean_of(averaged_of(*alone.add(view_of_frame(raw, 0))));
    const double n_before = mean_of(averaged_of(*before.add(view_of_frame(raw, 0))));
    EXPECT_GT(n_alone, 15.0);
    if (changes)
      EXPECT_LT(n_before, 3.0);
    else
      EXPECT_GT(n_before, 18.0);
  }
}

TEST(TimeFilter, BeforeAFilterPixelsKeepNoMoreThanTheirNeighbours) {
  TimeFilter alone(table_of()), before(table_of(), {.before_filter = true});
  add_static(alone, 20, 1e5, 1e4, 1);
  add_static(before, 20, 1e5, 1e4, 1);
  RawFrames raw = frame_of(alone.table(), with_moved_corner, 1e5, 1e4, 99);
  // An invalid pixel does not limit its neighbours.
  const std::size_t invalid = 25 * width + 30;
  raw.values[4 * invalid] = nan;
  const RawView far_apart = *alone.add(view_of_frame(raw, 0)),
                beside = *before.add(view_of_frame(raw, 0));
  double kept_alone = 0.0;
  for (const auto& [row, column] : {std::pair{11, 5}, {12, 8}, {4, 14}, {6, 15}, {12, 15}}) {
    const auto i = static_cast<std::size_t>(row * width + column);
    EXPECT_EQ(beside.averaged[i], 1.0F) << row << ' ' << column;
    kept_alone += static_cast<double>(far_apart.averaged[i]);
  }
  EXPECT_GT(kept_alone, 5 * 18.0);
  for (const std::size_t i : {invalid + 1, invalid - width, invalid + 2 * width + 2})
    EXPECT_GT(beside.averaged[i], 18.0F);
  EXPECT_EQ(beside.averaged[invalid], 1.0F);
}

TEST(TimeFilter, PixelsWithoutMeasurementAreUnchangedAndRestart) {
  DecodingTable table = table_of();
  table.saturation_level = 1e6F;
  TimeFilter filter(table);
  add_static(filter, 5, 1e5, 1e4, 1);
  RawFrames raw = frame_of(table, slanted, 1e5, 1e4, 99);
  const std::size_t invalid = 10 * width + 10, saturated = 25 * width + 30;
  raw.values[4 * invalid + 2] = nan;
  raw.values[4 * saturated + 3] = 1e6F;
  for (int time = 0; time < 2; ++time) {
    const RawView view = *filter.add(view_of_frame(raw, 0));
    const std::vector<float> values = values_of(view);
    for (const std::size_t pixel : {invalid, saturated}) {
      EXPECT_EQ(view.averaged[pixel], 1.0F);
      for (std::size_t k = 4 * pixel; k < 4 * pixel + 4; ++k) {
        if (k == 4 * invalid + 2) continue;
        EXPECT_EQ(values[k], raw.values[k]);
      }
    }
    EXPECT_TRUE(std::isnan(values[4 * invalid + 2]));
    // Neighbours are tested with the valid part of their patches.
    EXPECT_GT(view.averaged[invalid + 1], 3.0F);
  }
  const RawFrames next = frame_of(table, slanted, 1e5, 1e4, 100);
  const RawView view = *filter.add(view_of_frame(next, 0));
  EXPECT_EQ(view.averaged[invalid], 1.0F);
  EXPECT_EQ(view.averaged[saturated], 1.0F);
  EXPECT_EQ(values_of(view)[4 * invalid], next.values[4 * invalid]);
  const RawFrames later = frame_of(table, slanted, 1e5, 1e4, 101);
  EXPECT_GT(filter.add(view_of_frame(later, 0))->averaged[invalid], 1.5F);
}

TEST(TimeFilter, WeighsMeansByTheNumberOfFramesAveraged) {
  // All frames are equal, so that no change is detected.
  TimeFilter filter(table_of());
  const RawFrames raw = frame_of(filter.table(), slanted, 1e5, 1e4, 1);
  const std::vector<float> three(height * width, 3.0F), two(height * width, 2.0F);
  RawView view = view_of_frame(raw, 0);
  view.averaged = three.data();
  EXPECT_EQ(averaged_of(*filter.add(view)), three);
  view.averaged = two.data();
  EXPECT_EQ(averaged_of(*filter.add(view)), std::vector<float>(height * width, 5.0F));
}

TEST(TimeFilter, IsBitIdenticalForAnyNumberOfThreadsAndLayout) {
  const DecodingTable table = table_of();
  std::vector<RawFrames> frames;
  for (std::uint64_t seed = 1; seed < 5; ++seed)
    frames.push_back(frame_of(
        table, [&](int row, int column) { return slanted(row, column + (seed > 2 && row < 9)); },
        1e6, 1e4, seed));
  const auto run = [&](int threads, bool planar) {
    const ThreadLimit limit(threads);
    TimeFilter filter(table, {.before_filter = true});
    std::vector<float> all;
    for (const RawFrames& raw : frames) {
      RawView view = view_of_frame(raw, 0);
      std::vector<double> planes(raw.values.size());
      if (planar) {
        const std::size_t pixels = raw.pixels_per_frame();
        for (std::size_t i = 0; i < raw.values.size(); ++i)
          planes[i % 4 * pixels + i / 4] = raw.values[i];
        view = RawView::planar(planes.data(), height, width, 4);
      }
      const RawView added = *filter.add(view);
      const std::vector<float> values = values_of(added), averaged = averaged_of(added);
      all.insert(all.end(), values.begin(), values.end());
      all.insert(all.end(), averaged.begin(), averaged.end());
    }
    return all;
  };
  const std::vector<float> one = run(1, false);
  EXPECT_EQ(one, run(2, false));
  EXPECT_EQ(one, run(4, true));
}

TEST(TimeFilter, FramesOfOnePixelAreAveraged) {
  TimeFilter filter(table_of());
  RandomStream random(1, 0);
  RawView last;
  RawFrames raw{.frames = 1, .height = 1, .width = 1, .measurements = 4, .values = {}};
  for (int i = 0; i < 8; ++i) {
    raw.values.clear();
    append_noisy_pixel(filter.table(), 1e5, 1e4, 70.0, random, raw.values);
    last = *filter.add(view_of_frame(raw, 0));
  }
  EXPECT_GT(last.averaged[0], 4.0F);
}

TEST(TimeFilter, RejectsFramesOfAnotherSizeAndInvalidOptions) {
  const DecodingTable table = table_of();
  TimeFilter filter(table);
  const RawFrames raw = frame_of(table, slanted, 1e5, 1e4, 1);
  filter.add(view_of_frame(raw, 0));
  RawView other = view_of_frame(raw, 0);
  other.height = height - 1;
  EXPECT_THAT([&] { filter.add(other); },
              ThrowsMessage<InvalidArgument>(HasSubstr("raw height = 36; must equal that of the "
                                                       "previous frames, 37")));
  other = view_of_frame(raw, 0);
  other.width = width - 1;
  EXPECT_THROW(filter.add(other), InvalidArgument);
  other = view_of_frame(raw, 0);
  other.measurements = 3;
  EXPECT_THROW(filter.add(other), InvalidArgument);
  other = view_of_frame(raw, 0);
  other.height = height - 1;
  filter.forget();
  EXPECT_EQ(filter.add(other)->height, height - 1);
  EXPECT_THROW(TimeFilter(table, {.max_frames = 0}), InvalidArgument);
  EXPECT_THROW(TimeFilter(table, {.max_difference_sigma = 0.0}), InvalidArgument);
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "decode_setup.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/decode/filter.hpp"

namespace tofsmith {
namespace {

using ::testing::Each;
using ::testing::FloatEq;

constexpr int height = 35, width = 43, pixels = height * width;
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

struct Out {
  std::vector<float> values, averaged;
  bool operator==(const Out&) const = default;
};

Out out_of(const RawView& raw) {
  return {.values = values_of(raw), .averaged = {raw.averaged, raw.averaged + raw.pixels()}};
}

std::vector<Out> filtered(TimeFilter& filter, const std::vector<RawFrames>& frames) {
  std::vector<Out> out;
  for (const RawFrames& raw : frames)
    if (const auto view = filter.add(view_of_frame(raw, 0))) out.push_back(out_of(*view));
  while (const auto view = filter.add_end()) out.push_back(out_of(*view));
  return out;
}

std::vector<Out> filtered(const DecodingTable& table, const TimeFilterOptions& options,
                          const std::vector<RawFrames>& frames) {
  TimeFilter filter(table, options);
  return filtered(filter, frames);
}

DecodingTable hamiltonian() {
  return decoding_table_of("hamiltonian-k4", camera_with("paper-10f0"));
}

/// A block of 12 columns moves `columns` per frame in front of a slanted plane.
std::vector<RawFrames> moving(const DecodingTable& table, int frames, int columns) {
  std::vector<RawFrames> recording;
  for (int frame = 0; frame < frames; ++frame) {
    const int first = 4 + frame * columns;
    const auto scene = [&](int row, int column) {
      const bool is_block = column >= first && column < first + 12 && row < 20;
      return Seen{60.0 + 0.3 * row + 0.1 * column - (is_block ? 30.0 : 0.0), 1e5};
    };
    recording.push_back(frame_seen(table, height, width, scene, 1e4, 100 + std::uint64_t(frame)));
  }
  return recording;
}

double mean_of(const std::vector<float>& values) {
  double sum = 0.0;
  for (const float value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

TEST(TimeFilterBothWays, StaticPixelsAreMeansOfAllFramesWithMatchingNoise) {
  const DecodingTable table = hamiltonian();
  constexpr int frames = 9;
  const auto recording = moving(table, frames, 0);
  const auto out = filtered(table, {.look_ahead = frames}, recording);
  ASSERT_EQ(out.size(), frames);
  std::vector<double> mean(recording[0].values.size());
  for (const RawFrames& raw : recording)
    for (std::size_t i = 0; i < mean.size(); ++i)
      mean[i] += static_cast<double>(raw.values[i]) / frames;
  for (const Out& frame : out) {
    EXPECT_GT(mean_of(frame.averaged), 0.97 * frames);
    for (std::size_t i = 0; i < mean.size(); ++i)
      if (frame.averaged[i / 4] > 8.999F) {
        EXPECT_NEAR(static_cast<double>(frame.values[i]), mean[i],
                    0.02 * std::sqrt(mean[i] + 400));  // relative to the noise of one frame
      }
  }
}

TEST(TimeFilterBothWays, AReversedRecordingGivesReversedOutput) {
  const DecodingTable table = hamiltonian();
  for (const bool before_filter : {false, true}) {
    auto recording = moving(table, 6, 3);
    const TimeFilterOptions options{.before_filter = before_filter, .look_ahead = 5};
    auto forwards = filtered(table, options, recording);
    std::reverse(recording.begin(), recording.end());
    const auto backwards = filtered(table, options, recording);
    std::reverse(forwards.begin(), forwards.end());
    EXPECT_TRUE(forwards == backwards);
  }
}

TEST(TimeFilterBothWays, AFrameDoesNotDependOnFramesBeyondItsLookAhead) {
  const DecodingTable table = hamiltonian();
  auto recording = moving(table, 7, 3);
  const auto all = filtered(table, {.look_ahead = 2}, recording);
  ASSERT_EQ(all.size(), 7U);
  recording.resize(5);
  const auto shorter = filtered(table, {.look_ahead = 2}, recording);
  ASSERT_EQ(shorter.size(), 5U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(all[i] == shorter[i]) << i;
  for (std::size_t i = 3; i < 5; ++i) EXPECT_FALSE(all[i] == shorter[i]) << i;
}

TEST(TimeFilterBothWays, OutputIsDelayedByTheLookAhead) {
  const DecodingTable table = hamiltonian();
  TimeFilter filter(table, {.look_ahead = 3});
  const auto recording = moving(table, 5, 0);
  for (std::size_t i = 0; i < recording.size(); ++i)
    EXPECT_EQ(filter.add(view_of_frame(recording[i], 0)).has_value(), i >= 3) << i;
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(filter.add_end().has_value());
  EXPECT_FALSE(filter.add_end().has_value());
  // After the end of a recording, the next frame starts a new one.
  RawView smaller = view_of_frame(recording[0], 0);
  smaller.height = 5;
  EXPECT_FALSE(filter.add(smaller).has_value());
  EXPECT_EQ(filter.add_end()->height, 5);
}

TEST(TimeFilterBothWays, LookAheadBeyondTheEndEqualsTheWholeRecording) {
  const DecodingTable table = hamiltonian();
  const auto recording = moving(table, 4, 3);
  EXPECT_TRUE(filtered(table, {.look_ahead = 3}, recording) ==
              filtered(table, {.look_ahead = 1000}, recording));
}

TEST(TimeFilterBothWays, ASingleFrameIsUnchanged) {
  const DecodingTable table = hamiltonian();
  const auto out = filtered(table, {.look_ahead = 4}, moving(table, 1, 0));
  ASSERT_EQ(out.size(), 1U);
  EXPECT_EQ(out[0].values, moving(table, 1, 0)[0].values);
  EXPECT_THAT(out[0].averaged, Each(1.0F));
}

TEST(TimeFilterBothWays, MovingObjectsAreNotAveragedWithOtherSurfaces) {
  const DecodingTable table = hamiltonian();
  // With 12 columns per frame, the block never overlaps its previous position.
  const auto recording = moving(table, 3, 12);
  const auto out = filtered(table, {.look_ahead = 2}, recording);
  const auto at = [](int row, int column) {
    return static_cast<std::size_t>(row * width + column);
  };
  for (int row = 0; row < 20; ++row)
    for (int column = 16; column < 28; ++column) {
      EXPECT_EQ(out[1].averaged[at(row, column)], 1.0F) << row << ' ' << column;
      for (std::size_t k = 0; k < 4; ++k)
        EXPECT_EQ(out[1].values[4 * at(row, column) + k],
                  recording[1].values[4 * at(row, column) + k]);
    }
  // Uncovered pixels are averaged with frames before or after.
  double uncovered = 0.0;
  for (int row = 2; row < 18; ++row)
    for (int column = 6; column < 14; ++column) uncovered += out[1].averaged[at(row, column)];
  EXPECT_GT(uncovered / (16 * 8), 1.9);
}

TEST(TimeFilterBothWays, InvalidRegionsStayAndAreIgnored) {
  const DecodingTable table = hamiltonian();
  auto recording = moving(table, 5, 0);
  for (std::size_t frame = 0; frame < 5; ++frame)
    for (int row = 20; row < 30; ++row)
      for (int column = 20; column < 30; ++column)
        if (frame == 2 || column < 25)
          recording[frame].values[static_cast<std::size_t>(4 * (row * width + column) + 1)] = nan;
  const auto out = filtered(table, {.look_ahead = 2}, recording);
  for (std::size_t frame = 0; frame < 5; ++frame)
    for (std::size_t i = 0; i < pixels; ++i) {
      const bool was_nan = std::isnan(recording[frame].values[4 * i + 1]);
      EXPECT_EQ(std::isnan(out[frame].values[4 * i + 1]), was_nan);
      for (const std::size_t k : {0U, 2U, 3U})
        EXPECT_TRUE(std::isfinite(out[frame].values[4 * i + k]));
      if (was_nan) {
        EXPECT_EQ(out[frame].averaged[i], 1.0F);
      }
    }
  // Frames around an invalid region are averaged on both sides of it.
  EXPECT_FLOAT_EQ(out[0].averaged[25 * width + 28], 2.0F);
  EXPECT_FLOAT_EQ(out[4].averaged[25 * width + 28], 2.0F);
}

TEST(TimeFilterBothWays, WeighsMeansByTheNumberOfFramesAveraged) {
  const DecodingTable table = hamiltonian();
  const RawFrames raw = moving(table, 1, 0)[0];
  TimeFilter filter(table, {.look_ahead = 2});
  const std::vector<float> counts[] = {std::vector<float>(pixels, 3.0F),
                                       std::vector<float>(pixels, 2.0F),
                                       std::vector<float>(pixels, 5.0F)};
  std::vector<Out> out;
  for (const auto& count : counts) {
    RawView view = view_of_frame(raw, 0);
    view.averaged = count.data();
    if (const auto added = filter.add(view)) out.push_back(out_of(*added));
  }
  while (const auto added = filter.add_end()) out.push_back(out_of(*added));
  ASSERT_EQ(out.size(), 3U);
  for (const Out& frame : out) EXPECT_THAT(frame.averaged, Each(FloatEq(10.0F)));
}

TEST(TimeFilterBothWays, IsBitIdenticalForAnyNumberOfThreads) {
  const DecodingTable table = hamiltonian();
  const auto recording = moving(table, 4, 2);
  const auto run = [&](int threads) {
    const ThreadLimit limit(threads);
    return filtered(table, {.before_filter = true, .look_ahead = 2}, recording);
  };
  const auto one = run(1);
  EXPECT_TRUE(one == run(2));
  EXPECT_TRUE(one == run(4));
}

TEST(TimeFilterBothWays, RejectsFramesOfAnotherSizeWhileFramesArePending) {
  const DecodingTable table = hamiltonian();
  TimeFilter filter(table, {.look_ahead = 2});
  const RawFrames raw = moving(table, 1, 0)[0];
  filter.add(view_of_frame(raw, 0));
  RawView other = view_of_frame(raw, 0);
  other.height = height - 1;
  EXPECT_THROW(filter.add(other), InvalidArgument);
  filter.forget();
  EXPECT_FALSE(filter.add(other).has_value());
  EXPECT_THROW(TimeFilter(table, {.look_ahead = -1}), InvalidArgument);
  EXPECT_THROW(TimeFilter(table, {.look_ahead = 1001}), InvalidArgument);
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Filtering of frame sequences on a device, compared with the CPU.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "device_setup.hpp"
#include "each_target.hpp"
#include "random_codes.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr float float_infinity = std::numeric_limits<float>::infinity();

/// A moving edge, a slowly drifting part and a part that brightens.
RawFrames frame_of_motion(const DecodingTable& table, int height, int width, int f) {
  const double samples = table.bin_count();
  const auto scene = [&](int y, int x) {
    const bool is_near = 3 * x < width + 3 * f;
    const double drift_bin = 2 * y > height ? 0.001 * f * samples : 0.0;
    return Seen{std::fmod((is_near ? 0.2 : 0.7) * samples + drift_bin, samples),
                is_near                   ? 2e4
                : f > 3 && 4 * y < height ? 3e4
                                          : 5e3};
  };
  return frame_seen(table, height, width, scene, 1e4, static_cast<std::uint64_t>(f + 1));
}

void spoil(RawFrames& raw, float saturated, int f) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  const auto frame = static_cast<std::size_t>(f);
  for (std::size_t i = 0; i < raw.values.size(); ++i)
    if ((i + frame) % 97 == 5)
      raw.values[i] = i % 4 == 0   ? nan
                      : i % 4 == 1 ? saturated
                      : i % 4 == 2 ? -saturated
                                   : float_infinity;
}

class DeviceFramesOf : public OnDevice {
 protected:
  /// Expects equal bits if the device divides like the CPU.
  void expect_same_numbers(const RawView& a, const RawView& b, bool has_thresholds) const {
    std::vector<float> x = values_of(a), y = values_of(b);
    ASSERT_EQ(x.size(), y.size());
    x.insert(x.end(), a.averaged, a.averaged + a.pixels());
    y.insert(y.end(), b.averaged, b.averaged + b.pixels());
    if (device().info().divides_as_processor || !has_thresholds)
      for (std::size_t i = 0; i < x.size(); ++i) {
        if (std::isnan(x[i]) && std::isnan(y[i])) continue;
        ASSERT_EQ(x[i], y[i]) << "number " << i;
      }
  }
  void expect_what_the_time_filter_gives(const DecodingTable& table,
                                         const TimeFilterOptions& options,
                                         const std::vector<RawView>& frames) const {
    TimeFilter here(table, options);
    const TimeFilter filter(table, options);
    DeviceFrames there(device(), table, &filter);
    const Decoder decoder(table);
    const DeviceDecoder after(device(), decoder);
    std::size_t came = 0;
    const auto expect_frame = [&](const std::optional<RawView>& expected) {
      SCOPED_TRACE(came);
      ASSERT_EQ(there.has_frame(), expected.has_value());
      if (!expected) return;
      ++came;
      expect_same_numbers(there.numbers(), *expected, true);
      if (!device().info().divides_as_processor) return;
      Outputs outputs(static_cast<std::size_t>(expected->pixels())), expected_outputs = outputs;
      there.decode(after, outputs.view());
      decoder.decode(*expected, expected_outputs.view());
      expect_alike(device().info(), true, outputs, expected_outputs, 1e6);
    };
    for (const RawView& frame : frames) {
      there.take(frame);
      expect_frame(here.add(frame));
    }
    EXPECT_EQ(came, frames.size());
  }
};

std::vector<RawView> views_of(const std::vector<RawFrames>& frames) {
  std::vector<RawView> views;
  for (const RawFrames& frame : frames) views.push_back(view_of_frame(frame, 0));
  return views;
}

std::vector<RawFrames> frames_of_motion(const DecodingTable& table, int height, int width,
                                        int count) {
  std::vector<RawFrames> frames;
  for (int f = 0; f < count; ++f) {
    frames.push_back(frame_of_motion(table, height, width, f));
    spoil(frames.back(), 5e4f, f);
  }
  return frames;
}

TEST_F(DeviceFramesOf, AreAveragedLikeByTheTimeFilter) {
  for (const auto& [code, camera] : filtered_codes()) {
    const DecodingTable table = clipped_at(decoding_table_of(code, camera), 5e4f);
    const std::vector<RawFrames> frames = frames_of_motion(table, 43, 61, 7);
    for (const bool before_filter : {false, true}) {
      SCOPED_TRACE(testing::Message() << code << (before_filter ? " before a filter" : ""));
      for (const int max_frames : {1, 4, 64})
        expect_what_the_time_filter_gives(
            table, {.max_frames = max_frames, .before_filter = before_filter}, views_of(frames));
    }
  }
}

TEST_F(DeviceFramesOf, AreAveragedLikeByEveryInstructionSet) {
  const std::vector<RawFrames> frames = frames_of_motion(table_, 30, 41, 4);
  for_each_target([&] {
    expect_what_the_time_filter_gives(table_, {.before_filter = true}, views_of(frames));
  });
}

TEST_F(DeviceFramesOf, MayBeMeansOfAnyTypeAndLayout) {
  std::vector<float> averaged;
  for (int i = 0; i < 20 * 31; ++i)
    averaged.push_back(i % 31 == 0 ? 0.0f : 0.5f * static_cast<float>(2 + i % 4));
  std::vector<std::vector<std::uint16_t>> words;
  std::vector<std::vector<double>> doubles;
  for (int f = 0; f < 3; ++f) {
    RawFrames raw = frame_of_motion(table_, 20, 31, f);
    for (float& value : raw.values) value = std::clamp(std::round(value), 0.0f, 65535.0f);
    words.emplace_back(raw.values.begin(), raw.values.end());
    doubles.emplace_back(raw.values.begin(), raw.values.end());
    doubles.back()[7] += 1e-3;
  }
  std::vector<RawView> views;
  for (std::size_t f = 0; f < 3; ++f) {
    views.push_back(RawView::interleaved(words[f].data(), 20, 31, 4));
    views.push_back(RawView::planar(doubles[f].data(), 20, 31, 4));
    views.back().averaged = averaged.data();
  }
  for (const bool before_filter : {false, true})
    expect_what_the_time_filter_gives(table_, {.before_filter = before_filter}, views);
}

TEST_F(DeviceFramesOf, AveragedFramesStayOnTheDeviceForFilterAndDecoder) {
  if (!device().info().divides_as_processor) GTEST_SKIP() << "it rounds otherwise";
  const std::vector<RawFrames> frames = frames_of_motion(table_, 130, 40, 3);
  const Filter filter(table_);
  Image<std::uint8_t> left_out(130, 40);
  for (std::size_t i = 0; i < left_out.pixels.size(); ++i) left_out.pixels[i] = i % 17 == 0;
  for (const double memory_mb : {0.001, 512.0}) {  // in bands, and whole
    const TimeFilterOptions options{.before_filter = true};
    const TimeFilter time_filter(table_, options);
    TimeFilter here(table_, options);
    DeviceFrames there(device(), table_, &time_filter);
    const DeviceDecoder decoder(device(), setup_.decoder, {.memory_mb = memory_mb});
    const DeviceFilter on_device(device(), filter, {.memory_mb = memory_mb});
    for (const RawFrames& frame : frames) {
      FilteredFrame filtered, expected;
      Outputs outputs(130 * 40), expected_outputs = outputs;
      there.take(view_of_frame(frame, 0));
      const std::optional<RawView> added = here.add(view_of_frame(frame, 0));
      ASSERT_TRUE(added);
      there.decode(on_device, decoder, outputs.view(), &filtered, {}, left_out);
      filter.apply(*added, expected, {}, left_out);
      EXPECT_EQ(filtered.averaged().pixels, expected.averaged().pixels);
      setup_.decoder.decode(expected.view(), expected_outputs.view());
      expect_alike(device().info(), true, outputs, expected_outputs, 1e6);
    }
  }
}

TEST_F(DeviceFramesOf, AreForgottenOnRequest) {
  const std::vector<RawFrames> frames = frames_of_motion(table_, 20, 30, 2);
  const TimeFilter filter(table_);
  DeviceFrames there(device(), table_, &filter);
  there.take(view_of_frame(frames[0], 0));
  there.forget();
  EXPECT_THROW(there.numbers(), InvalidArgument);
  there.take(view_of_frame(frames[1], 0));
  expect_same_numbers(there.numbers(), *TimeFilter(table_).add(view_of_frame(frames[1], 0)), true);
  there.forget();
  const RawFrames smaller = frame_of_motion(table_, 9, 7, 0);
  there.take(view_of_frame(smaller, 0));
  EXPECT_EQ(there.numbers().height, 9);
}

TEST_F(DeviceFramesOf, HaveExactMeans) {
  if (!device().info().has_doubles) GTEST_SKIP() << "it has no doubles";
  const DecodingTable table = clipped_at(table_, 5e4f);
  const Decoder decoder(table);
  const DeviceDecoder after(device(), decoder, {.memory_mb = 0.1});
  DeviceFrames there(device(), table, nullptr);
  for (int round = 0; round < 2; ++round) {
    std::vector<std::vector<double>> frames;
    std::vector<double> means(60 * 50 * 4, 0.0);
    for (int f = 0; f < 3; ++f) {
      RawFrames raw = frame_of_motion(table, 60, 50, f);
      spoil(raw, 5e4f, f);
      frames.emplace_back(raw.values.begin(), raw.values.end());
      for (std::size_t i = 0; i < means.size(); ++i) {
        double& value = frames.back()[i];
        value += 1e-5 * static_cast<double>(i % 1000);
        constexpr double unbounded = std::numeric_limits<double>::infinity();
        means[i] = !std::isfinite(value) || std::isnan(means[i])
                       ? std::numeric_limits<double>::quiet_NaN()
                   : std::isinf(means[i]) ? means[i]
                   : value >= 5e4         ? unbounded
                   : value <= -5e4        ? -unbounded
                                          : means[i] + value;
      }
      there.add(RawView::interleaved(frames.back().data(), 60, 50, 4));
    }
    for (double& mean : means) mean = std::isinf(mean) ? std::copysign(5e4, mean) : mean / 3;
    there.take_mean(2.0);
    RawView expected = RawView::interleaved(means.data(), 60, 50, 4);
    const std::vector<float> averaged(60 * 50, 6.0f);
    expected.averaged = averaged.data();
    const RawView found = there.numbers();
    for (std::size_t i = 0; i < means.size(); ++i) {
      const double value = std::get<const double*>(found.data)[(i % 4) * 60 * 50 + i / 4];
      ASSERT_TRUE(value == means[i] || (std::isnan(value) && std::isnan(means[i]))) << i;
    }
    expect_same_numbers(found, expected, false);
    Outputs outputs(60 * 50), expected_outputs = outputs;
    EXPECT_GT(there.decode(after, outputs.view()), 0) << "no pixel was open";
    decoder.decode(expected, expected_outputs.view());
    expect_alike(device().info(), true, outputs, expected_outputs, 1e6);
  }
}

TEST_F(DeviceFramesOf, MeansAreAveragedOverTime) {
  if (!device().info().has_doubles) GTEST_SKIP() << "it has no doubles";
  const TimeFilter filter(table_);
  TimeFilter here(table_, filter.options());
  DeviceFrames there(device(), table_, &filter);
  for (int f = 0; f < 4; ++f) {
    const RawFrames a = frame_of_motion(table_, 20, 30, f), b = frame_of_motion(table_, 20, 30, f);
    std::vector<double> means(a.values.begin(), a.values.end());
    for (std::size_t i = 0; i < means.size(); ++i) means[i] = (means[i] + double{b.values[i]}) / 2;
    const std::vector<float> averaged(20 * 30, 2.0f);
    RawView mean = RawView::interleaved(means.data(), 20, 30, 4);
    mean.averaged = averaged.data();
    there.add(view_of_frame(a, 0));
    there.add(view_of_frame(b, 0));
    there.take_mean();
    expect_same_numbers(there.numbers(), *here.add(mean), true);
  }
}

TEST_F(DeviceFramesOf, InvalidFramesAreRejected) {
  const DecodeSetup other("hamiltonian-k3", camera_with("paper-10f0"));
  const TimeFilter of_other(other.decoder.table()), filter(table_),
      looks_ahead(table_, {.look_ahead = 1});
  EXPECT_THAT([&] { DeviceFrames(device(), table_, &of_other); },
              ThrowsMessage<InvalidArgument>(HasSubstr("must equal those of the table")));
  EXPECT_THAT([&] { DeviceFrames(device(), table_, &looks_ahead); },
              ThrowsMessage<InvalidArgument>(HasSubstr("look_ahead = 1; must be 0 on devices")));
  EXPECT_THROW(DeviceFrames(device(), table_, &filter, {.memory_mb = -1.0}), InvalidArgument);
  DeviceFrames there(device(), table_, &filter);
  const std::vector<float> raw(400);
  EXPECT_THROW(there.take_mean(), InvalidArgument);
  EXPECT_THROW(there.take(RawView::interleaved(raw.data(), 2, 4, 5)), InvalidArgument);
  there.take(RawView::interleaved(raw.data(), 10, 10, 4));
  EXPECT_THAT(
      [&] { there.take(RawView::interleaved(raw.data(), 5, 10, 4)); },
      ThrowsMessage<InvalidArgument>(HasSubstr("must equal that of the previous frames, 10")));
  const DeviceDecoder elsewhere(Device::all().front(), setup_.decoder);
  Outputs outputs(100);
  EXPECT_THROW(there.decode(elsewhere, outputs.view()), InvalidArgument);
  DeviceFrames means(device(), table_, nullptr);
  EXPECT_THROW(means.take(RawView::interleaved(raw.data(), 10, 10, 4)), InvalidArgument);
}

}  // namespace
}  // namespace tofsmith

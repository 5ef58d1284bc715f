// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include "device_setup.hpp"
#include "each_target.hpp"
#include "random_codes.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

using DeviceFiltering = OnDevice;

/// Slanted surfaces, an edge, a dark part and a wrap of depth; dim and bright.
RawFrames frame_of_surfaces(const DecodingTable& table, int height, int width) {
  const double samples = table.bin_count();
  const auto scene = [&](int y, int x) {
    const bool is_near = 3 * x < width + y % 7;
    const double bin =
        is_near ? 0.2 * samples + 0.002 * samples * y : 0.95 * samples + 0.003 * samples * x;
    const bool is_dark = 5 * y > 4 * height && 2 * x > width;
    return Seen{std::fmod(bin, samples), is_dark ? 0.0 : is_near ? 2e4 : 4e3 + 1e3 * (y % 50)};
  };
  return frame_seen(table, height, width, scene);
}

void spoil(RawFrames& raw, float saturated) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 0; i < raw.values.size(); ++i)
    if (i % 97 == 5) raw.values[i] = i % 3 == 0 ? nan : i % 3 == 1 ? saturated : -saturated;
  for (std::size_t i = raw.values.size() / 3; i < raw.values.size() / 3 + 40; ++i)
    raw.values[i] = std::numeric_limits<float>::infinity();
}

/// Fraction of values and `averaged` with a relative difference above `most`.
double share_beyond(const FilteredFrame& a, const FilteredFrame& b, double most) {
  const RawFrames values = a.values(), expected = b.values();
  std::size_t count = 0;
  const auto differ = [&](float x, float y) {
    if (std::isnan(x) || std::isnan(y)) return std::isnan(x) != std::isnan(y);
    return x != y && !(std::abs(x - y) <= most * std::abs(y));
  };
  const auto compare = [&](const std::vector<float>& x, const std::vector<float>& y) {
    for (std::size_t i = 0; i < x.size(); ++i) count += differ(x[i], y[i]);
  };
  compare(values.values, expected.values);
  compare(a.averaged().pixels, b.averaged().pixels);
  EXPECT_EQ(a.deviation_factor().size(), b.deviation_factor().size());
  compare(a.deviation_factor().pixels, b.deviation_factor().pixels);
  return static_cast<double>(count) /
         static_cast<double>(values.values.size() + 2 * b.averaged().size());
}

/// Tolerance for devices with other rounding; small frames may exceed it.
void expect_near(const FilteredFrame& a, const FilteredFrame& b) {
  EXPECT_LT(share_beyond(a, b, 1e-4), 0.06);
  EXPECT_LT(share_beyond(a, b, 1e-3), 0.002);
}

/// Expects equal bits if the device divides like the CPU.
void expect_alike(const Device& device, const FilteredFrame& a, const FilteredFrame& b) {
  if (!device.info().divides_as_processor || !device.info().has_doubles) return expect_near(a, b);
  EXPECT_EQ(share_beyond(a, b, 0.0), 0.0);
}

/// Compares filtering, and filtering with decoding in one call.
void expect_what_the_filter_gives(const Device& device, const DecodingTable& table,
                                  const FilterOptions& options, const RawView& raw,
                                  const DeviceOptions& on_device_options = {},
                                  const Image<std::uint8_t>& left_out = {}) {
  const Filter filter(table, options);
  const DeviceFilter on_device(device, filter, on_device_options);
  FilteredFrame filtered, expected;
  filter.apply(raw, expected, {}, left_out);
  on_device.apply(raw, filtered, {}, left_out);
  expect_alike(device, filtered, expected);

  const Decoder decoder(table);
  const DeviceDecoder after(device, decoder);
  Outputs outputs(static_cast<std::size_t>(raw.pixels())), expected_outputs = outputs;
  FilteredFrame again;
  on_device.decode(raw, after, outputs.view(), &again, {}, left_out);
  expect_alike(device, again, expected);
  decoder.decode(again.view(), expected_outputs.view());
  tofsmith::expect_alike(device.info(), true, outputs, expected_outputs, 1e6);
}

TEST_F(DeviceFiltering, EqualsTheFilter) {
  for (const auto& [code, camera] : filtered_codes()) {
    SCOPED_TRACE(code);
    const DecodingTable table = clipped_at(decoding_table_of(code, camera), 5e4f);
    RawFrames raw = frame_of_surfaces(table, 71, 85);
    spoil(raw, 5e4f);
    for (const FilterStrength strength : all_values<FilterStrength>) {
      SCOPED_TRACE(name_of(strength));
      expect_what_the_filter_gives(device(), table, FilterOptions::of(strength),
                                   view_of_frame(raw, 0));
    }
  }
}

TEST_F(DeviceFiltering, RoundsLikeEveryInstructionSet) {
  const RawFrames raw = frame_of_surfaces(table_, 40, 50);
  for_each_target(
      [&] { expect_what_the_filter_gives(device(), table_, {}, view_of_frame(raw, 0)); });
}

// Simulates a device with other rounding: products are added in two steps instead of one.
TEST_F(DeviceFiltering, OtherRoundingChangesFewValuesByMoreThanRoundingError) {
  const RawFrames raw = frame_of_surfaces(table_, 120, 160);
  for (const FilterStrength strength : all_values<FilterStrength>) {
    const Filter filter(table_, FilterOptions::of(strength));
    std::vector<FilteredFrame> there, here;
    for_each_target([&] {
      DeviceFilter(device(), filter).apply(view_of_frame(raw, 0), there.emplace_back());
      here.push_back(filter.apply(raw));
    });
    expect_near(there.back(), here.front());
  }
}

TEST_F(DeviceFiltering, AcceptsFramesSmallerThanItsWindows) {
  const Filter filter(table_);
  const DeviceFilter on_device(device(), filter);
  FilteredFrame reused;
  for (const auto& [height, width] : {std::pair{1, 1}, {1, 40}, {40, 1}, {3, 7}, {33, 8}, {3, 7}}) {
    const RawFrames raw = frame_of_surfaces(table_, height, width);
    on_device.apply(view_of_frame(raw, 0), reused);
    expect_alike(device(), reused, filter.apply(raw));
  }
}

TEST_F(DeviceFiltering, SupportsAnyCodeAndOptions) {
  RandomStream random(4, 0);
  for (const RandomCode& code : {RandomCode{4, 64, 3}, {5, 1000, 4}, {16, 200, 6}}) {
    SCOPED_TRACE(code.measurements);
    const DecodingTable table = random_table(code, random);
    const RawFrames raw = frame_of_surfaces(table, 60, 44);
    for (const FilterOptions& options :
         {FilterOptions{.windows = 3, .slope_rounds = 1},
          FilterOptions{.windows = 1, .slope_rounds = 3, .same_depth_sigma = 2.0},
          FilterOptions{.slope_rounds = 0, .max_difference_sigma = 6.0, .trusted_pixels = 40.0},
          FilterOptions{.own_light_sigma = 0.5}})
      expect_what_the_filter_gives(device(), table, options, view_of_frame(raw, 0));
  }
}

TEST_F(DeviceFiltering, SupportsMeansAndExcludedPixels) {
  for (const Readout readout : {Readout::separate, Readout::difference}) {
    const DecodingTable table =
        decoding_table_of("square-k4", camera_with("paper-10f0", 2, readout));
    const RawFrames raw = frame_of_surfaces(table, 50, 45);
    RawView view = view_of_frame(raw, 0);
    std::vector<float> averaged;
    for (int i = 0; i < 50 * 45; ++i)
      averaged.push_back(i % 31 == 0 ? 0.0f : 0.5f * static_cast<float>(2 + i % 4));
    view.averaged = averaged.data();
    Image<std::uint8_t> left_out(50, 45);
    for (std::size_t i = 0; i < left_out.pixels.size(); ++i) left_out.pixels[i] = i % 13 == 0;
    expect_what_the_filter_gives(device(), table, {}, view, {}, left_out);
  }
}

TEST_F(DeviceFiltering, ReadsAllTypesAndLayouts) {
  RawFrames raw = frame_of_surfaces(table_, 30, 44);
  for (float& value : raw.values) value = std::clamp(std::round(value), 0.0f, 65535.0f);
  const std::vector<std::uint16_t> words(raw.values.begin(), raw.values.end());
  std::vector<double> doubles(raw.values.begin(), raw.values.end());
  doubles[7] += 1e-9;
  expect_what_the_filter_gives(device(), table_, {}, RawView::interleaved(words.data(), 30, 44, 4));
  expect_what_the_filter_gives(device(), table_, {}, RawView::planar(doubles.data(), 30, 44, 4));
}

TEST_F(DeviceFiltering, LargeFramesAreFilteredInBands) {
  RawFrames raw = frame_of_surfaces(table_, 230, 24);
  spoil(raw, 1e3f);
  Image<std::uint8_t> left_out(230, 24);
  for (std::size_t i = 0; i < left_out.pixels.size(); ++i) left_out.pixels[i] = i % 17 == 0;
  for (const FilterStrength strength : all_values<FilterStrength>)
    for (const double memory_mb : {0.001, 3.0})
      expect_what_the_filter_gives(device(), table_, FilterOptions::of(strength),
                                   view_of_frame(raw, 0), {.memory_mb = memory_mb}, left_out);
}

TEST_F(DeviceFiltering, RejectsInvalidFrames) {
  const Filter filter(table_);
  const DeviceFilter on_device(device(), filter);
  FilteredFrame filtered;
  const std::vector<float> raw(40);
  EXPECT_THROW(on_device.apply(RawView::interleaved(raw.data(), 2, 4, 5), filtered),
               InvalidArgument);
  EXPECT_THROW(on_device.apply(RawView::interleaved(raw.data(), 0, 4, 4), filtered),
               InvalidArgument);
  const RawView view = RawView::interleaved(raw.data(), 2, 5, 4);
  EXPECT_THROW(on_device.apply(view, filtered, {}, Image<std::uint8_t>(5, 2)), InvalidArgument);
  EXPECT_THROW(DeviceFilter(device(), filter, {.memory_mb = -1.0}), InvalidArgument);
  const DeviceDecoder elsewhere(Device::all().front(), setup_.decoder);
  Outputs outputs(10);
  EXPECT_THROW(on_device.decode(view, elsewhere, outputs.view()), InvalidArgument);
}

TEST_F(DeviceFiltering, StopsOnRequestAndContinuesAfterwards) {
  const Filter filter(table_);
  const DeviceFilter on_device(device(), filter);
  const RawFrames raw = frame_of_surfaces(table_, 40, 30);
  FilteredFrame filtered;
  double last = 0.0;
  EXPECT_THROW(on_device.apply(view_of_frame(raw, 0), filtered,
                               [&](double fraction, std::string_view) {
                                 EXPECT_GE(fraction, last);
                                 last = fraction;
                                 return fraction < 0.5;
                               }),
               Interrupted);
  EXPECT_LT(last, 1.0);
  on_device.apply(view_of_frame(raw, 0), filtered);
  expect_alike(device(), filtered, filter.apply(raw));
}

}  // namespace
}  // namespace tofsmith

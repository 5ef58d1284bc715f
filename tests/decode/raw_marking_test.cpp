// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "decode_setup.hpp"
#include "tofsmith/decode/decode_method.hpp"
#include "tofsmith/decode/depth_image.hpp"
#include "tofsmith/decode/filter.hpp"
#include "tofsmith/decode/merge_exposures.hpp"

namespace tofsmith {
namespace {

using testing::Each;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float float_infinity = std::numeric_limits<float>::infinity();

Camera converted(Camera camera, int bits, double black_level_dn = 0.0) {
  camera.sensor.adc_bits = bits;
  camera.sensor.gain_e_per_dn = 10.0;
  if (black_level_dn > 0.0) camera.sensor.black_level_dn = black_level_dn;
  return camera;
}

Camera difference_camera() { return camera_with("paper-10f0", 2, Readout::difference); }

Camera mixer_camera() {
  Camera camera = camera_with("paper-10f0");
  camera.sensor.demodulation = Demodulation::weight;
  return camera;
}

std::vector<float> pixel_of(const DecodingTable& table, int bin, double largest_dn) {
  std::vector<float> raw;
  const double scale = largest_dn / table.correlation.cwiseAbs().maxCoeff();
  for (int k = 0; k < table.measurements(); ++k)
    raw.push_back(
        static_cast<float>(table.black_level[k] + std::round(scale * table.correlation(bin, k))));
  return raw;
}

template <typename Number>
RawView row_of(const std::vector<Number>& raw, int measurements) {
  return RawView::interleaved(raw.data(), 1, static_cast<int>(raw.size()) / measurements,
                              measurements);
}

std::vector<std::unique_ptr<const DepthDecoder>> all_decoders(const Camera& camera) {
  std::vector<std::unique_ptr<const DepthDecoder>> decoders;
  for (const DecodeMethod method : all_values<DecodeMethod>)
    decoders.push_back(make_decoder(
        method, decoding_table_of(method == DecodeMethod::unwrap ? "sinusoid-k4" : "hamiltonian-k5",
                                  camera)));
  return decoders;
}

/// Expects `status` from every decoder if one measurement of a pixel is one of `numbers`, and
/// another status of the pixel itself.
void expect_status(const Camera& camera, const std::vector<float>& numbers, PixelStatus status) {
  for (const auto& decoder : all_decoders(camera)) {
    const std::vector<float> pixel = pixel_of(decoder->table(), 31, 400.0);
    std::vector<float> raw = pixel;
    for (std::size_t k = 0; k < pixel.size(); ++k)
      for (const float number : numbers) {
        raw.insert(raw.end(), pixel.begin(), pixel.end());
        raw[raw.size() - pixel.size() + k] = number;
      }
    std::vector<PixelStatus> found(raw.size() / pixel.size());
    decoder->decode(row_of(raw, static_cast<int>(pixel.size())), {.status = found.data()});
    EXPECT_NE(found.front(), status);
    found.erase(found.begin());
    EXPECT_THAT(found, Each(status));
  }
}

TEST(RawMarking, DifferencesAtTheLimitsOfTheConverterAreSaturated) {
  for (const int bits : {10, 12, 16}) {
    const auto half = static_cast<float>(1 << (bits - 1));
    const auto largest = static_cast<float>((1 << bits) - 1);
    expect_status(converted(difference_camera(), bits), {half - 1.0f, -half, largest, -largest},
                  PixelStatus::saturated);
  }
}

TEST(RawMarking, ValuesOfMixersAtTheLimitsAreSaturated) {
  expect_status(converted(mixer_camera(), 11), {1023.0f, -1024.0f, 1500.0f, -1500.0f},
                PixelStatus::saturated);
  expect_status(converted(mixer_camera(), 11, 1000.0), {0.0f, 2047.0f}, PixelStatus::saturated);
  Camera wells = mixer_camera();
  wells.sensor.full_well_e = 2000.0;
  expect_status(wells, {2000.0f, -2000.0f}, PixelStatus::saturated);
}

TEST(RawMarking, ADifferenceOfTheWholeFullWellIsSaturated) {
  Camera camera = difference_camera();
  camera.sensor.full_well_e = 3000.0;
  expect_status(camera, {3000.0f, -3000.0f}, PixelStatus::saturated);
}

TEST(RawMarking, UnsignedDifferencesDecodeAsSignedOnes) {
  // Around the black level, whose deviation does not cancel in any three-measurement code.
  const Camera camera = converted(difference_camera(), 12, 1900.0);
  const DecodingTable table = decoding_table_of("hamiltonian-k5", camera);
  const Decoder decoder(table);
  for (int bin = 0; bin < table.samples(); bin += 7) {
    const std::vector<float> pixel = pixel_of(table, bin, 1500.0);
    std::vector<std::uint16_t> around;
    for (const float number : pixel) around.push_back(static_cast<std::uint16_t>(number + 1900.0f));
    float depth_m = 0.0f, expected_m = 0.0f;
    decoder.decode(row_of(around, 5), {.depth_m = &depth_m});
    decoder.decode(row_of(pixel, 5), {.depth_m = &expected_m});
    EXPECT_EQ(depth_m, expected_m);
    for (const int rail : {0, 4095}) {
      std::vector<std::uint16_t> clipped = around;
      clipped[static_cast<std::size_t>(bin % 5)] = static_cast<std::uint16_t>(rail);
      PixelStatus status = PixelStatus::ok;
      decoder.decode(row_of(clipped, 5), {.status = &status});
      EXPECT_EQ(status, PixelStatus::saturated);
    }
  }
}

TEST(RawMarking, MarkersAreAppliedInEveryDecoder) {
  for (Camera camera : {camera_with("paper-10f0", 2), difference_camera(), mixer_camera()}) {
    camera.raw = {.saturated = {32767.0, -32768.0}, .invalid = {-7777.0, 0.5}};
    expect_status(camera, {32767.0f, -32768.0f}, PixelStatus::saturated);
    expect_status(camera, {-7777.0f, 0.5f, nan, float_infinity}, PixelStatus::invalid);
    camera.raw = {.saturated = {std::numeric_limits<double>::quiet_NaN()}, .invalid = {}};
    expect_status(camera, {nan}, PixelStatus::saturated);
    expect_status(camera, {float_infinity}, PixelStatus::invalid);
  }
}

TEST(RawMarking, MarkersTakePrecedenceOverTheLimitsOfTheConverter) {
  Camera camera = converted(camera_with("paper-10f0", 2), 12);
  camera.raw.invalid = {4095.0};
  expect_status(camera, {4095.0f}, PixelStatus::invalid);
  expect_status(camera, {4096.0f}, PixelStatus::saturated);
}

RawFrames frame_with(const DecodingTable& table, float number) {
  const auto plane = [](int, int) { return Seen{40.0, 2e4}; };
  RawFrames raw = frame_seen(table, 12, 12, plane, 0.0, 5);
  for (float& value : raw.values) value = std::round(value);
  raw.values[static_cast<std::size_t>((6 * 12 + 6) * table.measurements())] = number;
  return raw;
}

std::vector<float> around_the_middle(const RawView& raw) {
  std::vector<float> values = values_of(raw);
  const auto first = values.begin() + (6 * 12 + 6) * raw.measurements;
  values.erase(first, first + raw.measurements);
  return values;
}

TEST(RawMarking, FiltersDoNotSpreadSaturatedValues) {
  Camera camera = converted(difference_camera(), 10);
  camera.raw = {.saturated = {77.5}, .invalid = {78.5}};
  const DecodingTable table = decoding_table_of("hamiltonian-k4", camera);
  const Filter filter(table);
  const FilteredFrame expected = filter.apply(frame_with(table, nan));
  for (const float number : {511.0f, -512.0f, 1023.0f, -1023.0f, 77.5f, 78.5f}) {
    const RawFrames raw = frame_with(table, number);
    const FilteredFrame filtered = filter.apply(raw);
    EXPECT_EQ(around_the_middle(filtered.view()), around_the_middle(expected.view())) << number;
    PixelStatus statuses[144];
    Decoder(table).decode(filtered.view(), {.status = statuses});
    EXPECT_EQ(statuses[6 * 12 + 6],
              number == 78.5f ? PixelStatus::invalid : PixelStatus::saturated);

    TimeFilter in_time(table, {});
    in_time.add(view_of_frame(raw, 0));
    const RawFrames next = frame_with(table, 0.0f);
    const RawView added = in_time.add(view_of_frame(next, 0)).value();
    EXPECT_EQ(added.averaged[6 * 12 + 6], 1.0f) << "the pixel starts anew";
    EXPECT_GT(added.averaged[0], 1.0f);
  }
}

TEST(RawMarking, ExposuresSaturatedAtTheLowerLimitAreExcluded) {
  const DecodingTable table = decoding_table_of("hamiltonian-k4", converted(mixer_camera(), 12));
  const RawFrames clean = frame_with(table, 100.0f), clipped = frame_with(table, -2048.0f);
  const std::array exposures = {1.0, 2.0};
  const std::array views = {view_of_frame(clean, 0), view_of_frame(clipped, 0)};
  MergedExposures merged;
  merge_exposures(views, exposures, table, merged);
  const std::size_t middle = static_cast<std::size_t>((6 * 12 + 6) * 4);
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_NEAR(merged.values.values[middle + k], clean.values[middle + k], 1e-3);
  const std::array both = {views[1], views[1]};
  merge_exposures(both, exposures, table, merged);
  EXPECT_EQ(merged.values.values[middle], -2048.0f);
}

TEST(RawMarking, FilteredValuesAreNotMarkedAgain) {
  // 0 marks sensor pixels, but a filtered difference of 0 is a valid measurement.
  Camera camera = difference_camera();
  camera.raw.invalid = {0.0};
  const DecodingTable table = decoding_table_of("hamiltonian-k4", camera);
  const std::vector<float> raw = {0.0f, 500.0f, -300.0f, 200.0f};
  RawView view = row_of(raw, 4);
  PixelStatus status = PixelStatus::ok;
  Decoder(table).decode(view, {.status = &status});
  EXPECT_EQ(status, PixelStatus::invalid);
  view.is_marked = true;
  Decoder(table).decode(view, {.status = &status});
  EXPECT_NE(status, PixelStatus::invalid);
}

TEST(RawMarking, DifferencesAreMarkedIfTheirTapsAre) {
  Camera camera = converted(difference_camera(), 12, 64.0);
  camera.raw.invalid = {0.0};
  const RawMarking marking = decoding_table_of("hamiltonian-k4", camera).marking;
  EXPECT_EQ(marking.difference(3000.0, 100.0), 2900.0);
  EXPECT_EQ(marking.difference(100.0, 100.0), 0.0);
  EXPECT_EQ(marking.difference(4095.0, 3000.0), 4095.0 - 64.0);
  EXPECT_EQ(marking.difference(3000.0, 4095.0), -4095.0 + 64.0);
  EXPECT_TRUE(std::isnan(marking.difference(0.0, 4095.0)));
}

}  // namespace
}  // namespace tofsmith

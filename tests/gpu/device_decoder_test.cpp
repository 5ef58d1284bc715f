// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include "decode/output/shared/decoder_parts.hpp"
#include "device_setup.hpp"
#include "random_codes.hpp"
#include "rows_setup.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

using DeviceDecoding = OnDevice;

Outputs decoded(const Decoder& decoder, const RawView& raw, unsigned planes = ~0u) {
  Outputs outputs(static_cast<std::size_t>(raw.pixels()));
  decoder.decode(raw, outputs.view(planes));
  return outputs;
}

/// @param left  receives the number of pixels left to the decoder
Outputs decoded(const DeviceDecoder& decoder, const RawView& raw, std::int64_t& left,
                unsigned planes = ~0u) {
  Outputs outputs(static_cast<std::size_t>(raw.pixels()));
  left = decoder.decode(raw, outputs.view(planes));
  return outputs;
}

/// Appends pixels without a valid depth: dark, constant, saturated, NaN, and the largest and
/// smallest values.
void append_odd_pixels(const DecodingTable& table, std::vector<float>& raw) {
  using Limits = std::numeric_limits<float>;
  for (const float value : {0.0f, 1000.0f, 65535.0f, -65535.0f, -5.0f, Limits::quiet_NaN(),
                            Limits::infinity(), Limits::max(), Limits::denorm_min()})
    for (int odd = -1; odd < table.measurements(); ++odd)
      for (int k = 0; k < table.measurements(); ++k)
        raw.push_back(odd < 0 || k == odd ? value : 700.0f + 10.0f * static_cast<float>(k));
  // Ambient light only, up to rounding.
  for (int i = 0; i < 20; ++i)
    for (int k = 0; k < table.measurements(); ++k)
      raw.push_back(static_cast<float>(
          table.black_level[k] +
          (table.dark_electrons[k] + (1000.0 + i) * table.exposure_s[k] * table.ambient_gain[k]) /
              table.gain_e_per_raw[k]));
}

RawView row_of(const std::vector<float>& raw, int measurements) {
  return RawView::interleaved(raw.data(), 1, static_cast<int>(raw.size()) / measurements,
                              measurements);
}

/// Compares all planes.
void expect_planes_of(const Decoder& decoder, const DeviceDecoder& on_device, const RawView& view,
                      double brightest_e_per_s) {
  std::int64_t left = 0;
  expect_alike(on_device.device().info(), true, decoded(on_device, view, left),
               decoded(decoder, view), brightest_e_per_s);
}

/// Planes that do not require the confidence: all but confidence and status.
const unsigned without_confidence =
    ~(bit_of(DecodedPlane::confidence) | bit_of(DecodedPlane::status));

/// Compares all planes, and bins only.
void expect_what_the_decoder_gives(const Device& device, const DecodingTable& table,
                                   std::vector<float> raw, const DeviceOptions& options = {},
                                   const DecodeOptions& thresholds = {},
                                   double largest_share_left = 0.5) {
  const auto usual_pixels = static_cast<std::int64_t>(raw.size()) / table.measurements();
  append_odd_pixels(table, raw);
  const double brightest = *std::max_element(raw.begin(), raw.begin() + usual_pixels) *
                           table.gain_e_per_raw.maxCoeff() / table.exposure_s.minCoeff();
  const Decoder decoder(table, thresholds);
  const DeviceDecoder on_device(device, decoder, options);
  const RawView view = row_of(raw, table.measurements());
  const Outputs expected = decoded(decoder, view);
  const std::int64_t odd_pixels = view.pixels() - usual_pixels;
  std::int64_t left = 0;
  const Outputs all = decoded(on_device, view, left);
  expect_alike(device.info(), options.use_doubles, all, expected, brightest);
  // The CPU computes the confidence of most pixels in dim light, and the lobe of all pixels of a
  // table with close lobes.
  decoded(on_device, view, left, without_confidence);
  if (!parts_of(decoder).matcher.has_close_lobes()) {
    EXPECT_LT(static_cast<double>(left - 2 * odd_pixels),
              largest_share_left * static_cast<double>(usual_pixels))
        << "little was done on the device";
  }
  const Outputs bins = decoded(on_device, view, left, 1);
  expect_only(bins, expected, 1);
}

// For each search method (by angle, by cells of both ranks, by arcs): few bins with large angles
// between them, and many bins.
constexpr RandomCode codes[] = {{3, 8, 2}, {3, 1500, 2}, {4, 64, 3},  {4, 700, 3},
                                {5, 9, 4}, {5, 5000, 4}, {8, 400, 7}, {16, 2000, 6}};

TEST_F(DeviceDecoding, EqualsTheDecoderForRandomCodes) {
  RandomStream random(41, 0);
  for (const RandomCode& code : codes) {
    SCOPED_TRACE(testing::Message() << "K = " << code.measurements << ", N = " << code.samples);
    const DecodingTable table = clipped_at(random_table(code, random), 60000.0f);
    expect_what_the_decoder_gives(device(), table, random_pixels(table, 3000, random));
  }
}

struct Case {
  const char* code;
  const char* camera;
  int taps = 1;
  Readout readout = Readout::separate;
};
constexpr Case cases[] = {{"hamiltonian-k3", "paper-10f0"},
                          {"hamiltonian-k4", "paper-10f0"},
                          {"gray-k4", "paper-30x"},
                          {"multifrequency-k5", "paper-5f0"},
                          {"hamiltonian-k4", "paper-10f0", 2},
                          {"hamiltonian-k5", "paper-10f0", 2, Readout::difference}};

TEST_F(DeviceDecoding, EqualsTheDecoderAtAllLightLevels) {
  for (const Case& c : cases) {
    SCOPED_TRACE(c.code);
    const DecodeSetup setup(c.code, camera_with(c.camera, c.taps, c.readout));
    const DecodingTable& table = setup.decoder.table();
    expect_what_the_decoder_gives(device(), table, pixels_at_all_light_levels(table, 800));
  }
}

TEST_F(DeviceDecoding, EqualsTheDecoderForRows) {
  const DecodeSetup setup("hamiltonian-k4", rows_camera());
  const DecodingTable& table = setup.decoder.table();
  // Whitened vectors are short compared with the raw values, so that single precision proves no
  // bin: all pixels are left to the CPU twice, for bins and for chords.
  expect_what_the_decoder_gives(device(), table, noisy_pixels(table, 1e5, 1e3, 500, 4), {}, {},
                                2.1);
}

TEST_F(DeviceDecoding, UsesTheThresholdsOfTheDecoder) {
  for (const DecodeOptions& thresholds :
       {DecodeOptions{.low_signal_sigma = 50.0}, DecodeOptions{.min_confidence = 0.9999},
        DecodeOptions{.low_signal_sigma = 0.0, .min_confidence = 0.0}})
    expect_what_the_decoder_gives(device(), table_, pixels_at_all_light_levels(table_, 400), {},
                                  thresholds);
}

TEST_F(DeviceDecoding, DecodesMeasuredTables) {
  const DecodeSetup setup("hamiltonian-k5", camera_with("paper-10f0"));
  const std::vector<float> raw = pixels_at_all_light_levels(setup.decoder.table(), 300);
  for (const int samples : {30, 97})
    expect_what_the_decoder_gives(
        device(), make_decoding_table(setup.model.correlation_table(samples), 10.0), raw);
}

TEST_F(DeviceDecoding, ProvesAlmostAllPixels) {
  const std::vector<float> raw = noisy_pixels(table_, 1e5, 1e4, 20000, 3);
  const DeviceDecoder on_device(device(), setup_.decoder);
  std::int64_t left = 0;
  decoded(on_device, row_of(raw, 4), left);
  EXPECT_LT(left, 20000 / 50);
  decoded(on_device, row_of(raw, 4), left, 1);
  EXPECT_LT(left, 20000 / 500);
}

TEST_F(DeviceDecoding, WithoutDoublesOnlyAmbientLightIsRoundedDifferently) {
  Camera camera = camera_with("paper-10f0");
  camera.sensor.dark_current_e_per_s = 3e3;
  const DecodeSetup setup("hamiltonian-k4", camera);
  const DecodingTable& table = setup.decoder.table();
  expect_what_the_decoder_gives(device(), table, pixels_at_all_light_levels(table, 400),
                                {.use_doubles = false});
}

/// Values that fit into a byte, as another type in one of the supported layouts.
template <typename Number>
void expect_same_of(const DeviceDecoder& on_device, const Decoder& decoder, int height, int width,
                    const std::vector<float>& raw) {
  const int k_count = decoder.measurements();
  const std::vector<Number> numbers(raw.begin(), raw.end());
  const RawView rows = RawView::interleaved(numbers.data(), height, width, k_count);
  const RawView planes = RawView::planar(numbers.data(), height, width, k_count);
  RawView every_other = rows;
  every_other.width /= 2;
  every_other.column_stride *= 2;
  RawView upside_down = rows;
  upside_down.data = numbers.data() + (height - 1) * rows.row_stride;
  upside_down.row_stride = -rows.row_stride;
  for (const RawView& view : {rows, planes, every_other, upside_down}) {
    expect_planes_of(decoder, on_device, view, 1e5);
    std::int64_t left = 0;
    decoded(on_device, view, left, without_confidence);
    EXPECT_LT(left, view.pixels());
  }
}

TEST_F(DeviceDecoding, ReadsAllTypesAndLayouts) {
  constexpr int height = 17, width = 41;
  std::vector<float> raw = noisy_pixels(table_, 600.0, 300.0, height * width, 12);
  for (float& value : raw) value = std::clamp(std::round(value), 0.0f, 255.0f);
  const DeviceDecoder on_device(device(), setup_.decoder);
  expect_same_of<float>(on_device, setup_.decoder, height, width, raw);
  expect_same_of<std::uint16_t>(on_device, setup_.decoder, height, width, raw);
  expect_same_of<std::uint8_t>(on_device, setup_.decoder, height, width, raw);
  expect_same_of<double>(on_device, setup_.decoder, height, width, raw);
}

TEST_F(DeviceDecoding, UsesAllDigitsOfDoubles) {
  // In this ambient light, floats are integers and cannot represent the signal.
  RandomStream random(5, 0);
  std::vector<double> raw;
  for (const float value : noisy_pixels(table_, 1e4, 1e8, 4000, 8))
    raw.push_back(value + random.uniform());
  raw[5] = 1e300;  // a float would be infinite, and the pixel invalid
  const DeviceDecoder on_device(device(), setup_.decoder);
  expect_planes_of(setup_.decoder, on_device, RawView::interleaved(raw.data(), 40, 100, 4), 1e6);
}

TEST_F(DeviceDecoding, AccountsForTheNoiseOfMeans) {
  const DecodeSetup setup("hamiltonian-k5", camera_with("paper-10f0"));
  const std::vector<float> raw = noisy_pixels(setup.decoder.table(), 2e3, 1e4, 3000, 8);
  std::vector<float> averaged;
  for (int i = 0; i < 3000; ++i) averaged.push_back(0.5f * static_cast<float>(1 + i % 40));
  RawView view = row_of(raw, 5);
  view.averaged = averaged.data();
  expect_planes_of(setup.decoder, DeviceDecoder(device(), setup.decoder), view, 1e6);
}

TEST_F(DeviceDecoding, EachPlaneIsIndependentOfTheOtherRequestedPlanes) {
  const std::vector<float> raw = noisy_pixels(table_, 3e3, 1e4, 1000, 9);
  const DeviceDecoder on_device(device(), setup_.decoder);
  std::int64_t left = 0;
  const Outputs all = decoded(on_device, row_of(raw, 4), left);
  for (unsigned planes = 1; planes >> decoder_planes.size() == 0; planes = planes * 2 + planes % 3)
    expect_only(decoded(on_device, row_of(raw, 4), left, planes), all, planes);
}

TEST_F(DeviceDecoding, LargeFramesAreDecodedInParts) {
  const std::vector<float> raw = noisy_pixels(table_, 3e3, 1e4, 5000, 9);
  const DeviceDecoder in_parts(device(), setup_.decoder, {.memory_mb = 0.001});
  for (const int pixels : {0, 1, 63, 64, 65, 1024, 1025, 5000}) {
    const RawView view = RawView::interleaved(raw.data(), pixels > 0 ? 1 : 0, pixels, 4);
    expect_planes_of(setup_.decoder, in_parts, view, 1e6);
  }
}

TEST_F(DeviceDecoding, OverlappedCopiesChangeNothing) {
  constexpr int height = 370, width = 601;  // in four parts
  std::vector<float> raw = noisy_pixels(table_, 3e4, 1e4, height * width, 9);
  const RawView view = RawView::interleaved(raw.data(), height, width, 4);
  const Outputs expected = decoded(setup_.decoder, view);
  const DeviceDecoder on_device(device(), setup_.decoder);
  std::vector<double> fractions;
  Outputs outputs(static_cast<std::size_t>(view.pixels()));
  on_device.decode(view, outputs.view(), [&](double fraction, std::string_view) {
    fractions.push_back(fraction);
    return true;
  });
  expect_alike(device().info(), true, outputs, expected, 1e6);
  EXPECT_EQ(fractions.size(), 4u);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  std::int64_t left = 0;
  expect_only(decoded(on_device, view, left, 1), expected, 1);
}

TEST_F(DeviceDecoding, RejectsInvalidFrames) {
  const DeviceDecoder on_device(device(), setup_.decoder);
  const std::vector<float> raw(15);
  Outputs outputs(3);
  EXPECT_THROW(on_device.decode(RawView::interleaved(raw.data(), 1, 3, 5), outputs.view()),
               InvalidArgument);
  EXPECT_THROW(DeviceDecoder(device(), setup_.decoder, {.memory_mb = 0.0}), InvalidArgument);
}

TEST_F(DeviceDecoding, StopsOnRequest) {
  const std::vector<float> raw(4 * 5000);
  Outputs outputs(5000);
  const DeviceDecoder in_parts(device(), setup_.decoder, {.memory_mb = 0.001});
  EXPECT_THROW(in_parts.decode(row_of(raw, 4), outputs.view(),
                               [](double fraction, std::string_view) { return fraction < 0.3; }),
               Interrupted);
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "output_setup.hpp"
#include "reference_decoder.hpp"

namespace tofsmith {
namespace {

struct Layout {
  const char* name;
  std::ptrdiff_t row, column, measurement;
};

constexpr int height = 17, width = 41;  // tiles begin and end within rows
constexpr std::size_t frame_pixels = std::size_t{height} * width;

std::vector<Layout> layouts(std::ptrdiff_t k_count) {
  return {{"interleaved", width * k_count, k_count, 1},
          {"planar", width, 1, height * width},
          {"interleaved with padded rows", width * k_count + 5, k_count, 1},
          {"planar with padded rows", width + 3, 1, (width + 3) * (height + 2)},
          {"every other pixel of a wider frame", 3 * width * k_count, 2 * k_count, 1},
          {"measurements apart", width * (2 * k_count + 1), 2 * k_count + 1, 2},
          {"rows of measurements", width * k_count, 1, width},
          {"columns first", k_count, height * k_count, 1},
          {"upside down", -width * k_count, k_count, 1},
          {"mirrored planes", width, -1, height * width}};
}

template <typename Number>
class Frame {
 public:
  /// @param numbers  (pixels, K), exactly representable as Number
  template <typename Source>
  Frame(const std::vector<Source>& numbers, const Layout& layout) {
    const auto k_count = static_cast<std::ptrdiff_t>(numbers.size() / frame_pixels);
    std::ptrdiff_t lowest = 0, highest = 0;
    for (const std::ptrdiff_t reach : {(height - 1) * layout.row, (width - 1) * layout.column,
                                       (k_count - 1) * layout.measurement})
      (reach < 0 ? lowest : highest) += reach;
    memory_.assign(static_cast<std::size_t>(highest - lowest) + 1, Number{99});
    Number* const first = memory_.data() - lowest;
    const Source* number = numbers.data();
    for (int r = 0; r < height; ++r)
      for (int c = 0; c < width; ++c)
        for (std::ptrdiff_t k = 0; k < k_count; ++k)
          first[r * layout.row + c * layout.column + k * layout.measurement] =
              static_cast<Number>(*number++);
    view = {first,
            height,
            width,
            static_cast<int>(k_count),
            layout.row,
            layout.column,
            layout.measurement};
  }

  RawView view;

 private:
  std::vector<Number> memory_;
};

Outputs decoded(const Decoder& decoder, const RawView& raw, unsigned planes = 127) {
  Outputs outputs(frame_pixels);
  decoder.decode(raw, outputs.view(planes));
  return outputs;
}

std::vector<float> bytes_of_pixels(const DecodingTable& table) {
  std::vector<float> raw = noisy_pixels(table, 600.0, 300.0, static_cast<int>(frame_pixels), 12);
  for (float& value : raw) value = std::clamp(std::round(value), 0.0f, 255.0f);
  return raw;
}

template <typename Number>
void expect_same_in_all_layouts(const Decoder& decoder, const std::vector<float>& raw,
                                const Outputs& expected) {
  for (const Layout& layout : layouts(decoder.measurements())) {
    SCOPED_TRACE(layout.name);
    const Frame<Number> frame(raw, layout);
    expect_same(decoded(decoder, frame.view), expected);
    Outputs bins(frame_pixels);
    decoder.decode(frame.view, bins.view(1));
    expect_only(bins, expected, 1);
  }
}

struct Case {
  const char* code;
  const char* camera;
  int taps = 1;
};

class ViewsOfCode : public testing::TestWithParam<Case> {};

TEST_P(ViewsOfCode, GiveTheSamePlanesInEveryTypeAndLayout) {
  const Case& c = GetParam();
  const DecodeSetup setup(c.code, camera_with(c.camera, c.taps));
  const std::vector<float> raw = bytes_of_pixels(setup.decoder.table());
  const Outputs expected = decoded(
      setup.decoder, RawView::interleaved(raw.data(), height, width, setup.decoder.measurements()));
  const auto has_depth = [](float depth_m) { return std::isfinite(depth_m); };
  ASSERT_GT(
      std::count_if(expected.depth_m.pixels.begin(), expected.depth_m.pixels.end(), has_depth),
      static_cast<std::ptrdiff_t>(frame_pixels / 2));
  expect_same_in_all_layouts<float>(setup.decoder, raw, expected);
  expect_same_in_all_layouts<double>(setup.decoder, raw, expected);
  expect_same_in_all_layouts<std::uint16_t>(setup.decoder, raw, expected);
  expect_same_in_all_layouts<std::uint8_t>(setup.decoder, raw, expected);
}

// Searches on circles, by cells of both ranks, and along arcs.
INSTANTIATE_TEST_SUITE_P(
    Codes, ViewsOfCode,
    testing::Values(Case{"sinusoid-k4", "paper-10f0"}, Case{"hamiltonian-k3", "paper-30x"},
                    Case{"hamiltonian-k4", "paper-10f0"}, Case{"hamiltonian-k5", "paper-30x"},
                    Case{"hamiltonian-k5", "paper-10f0", 2}, Case{"hamiltonian-k6", "paper-30x"}));

TEST(Decoder, WritesOnlyRequestedPlanes) {
  for (const char* code : {"sinusoid-k4", "hamiltonian-k4", "hamiltonian-k6"}) {
    const DecodeSetup setup(code, camera_with("paper-10f0"));
    const Frame<float> frame(bytes_of_pixels(setup.decoder.table()),
                             layouts(setup.decoder.measurements()).front());
    const Outputs all = decoded(setup.decoder, frame.view);
    for (unsigned planes = 0; planes < 128; ++planes) {
      SCOPED_TRACE(planes);
      expect_only(decoded(setup.decoder, frame.view, planes), all, planes);
    }
  }
}

template <typename Number>
void expect_bins_of_the_reference(const Decoder& decoder, double signal, double ambient) {
  const ReferenceDecoder reference(decoder.table());
  const auto k_count = static_cast<std::size_t>(decoder.measurements());
  RandomStream random(3, 0);
  std::vector<double> raw;
  for (const float value :
       noisy_pixels(decoder.table(), signal, ambient, static_cast<int>(frame_pixels), 2)) {
    // Doubles use all their digits; integer types get integers.
    const double number = value + (std::is_same_v<Number, double> ? 1e-3 * random.uniform() : 0.0);
    raw.push_back(std::is_integral_v<Number>
                      ? std::clamp(std::round(number), 0.0,
                                   static_cast<double>(std::numeric_limits<Number>::max()))
                      : number);
  }
  std::vector<std::int32_t> expected;
  for (std::size_t i = 0; i < frame_pixels; ++i)
    expected.push_back(reference.bin(&raw[i * k_count]));
  for (const Layout& layout : layouts(decoder.measurements())) {
    SCOPED_TRACE(layout.name);
    const Frame<Number> frame(raw, layout);
    for_each_target([&] {
      EXPECT_EQ(decoded(decoder, frame.view).bin.pixels, expected);
      EXPECT_EQ(decoded(decoder, frame.view, 1).bin.pixels, expected);
    });
  }
}

TEST(Decoder, FindsTheReferenceBinsInEveryType) {
  for (const char* code : {"sinusoid-k4", "hamiltonian-k3", "hamiltonian-k5", "hamiltonian-k6"}) {
    SCOPED_TRACE(code);
    const DecodeSetup setup(code, camera_with("paper-30x"));
    expect_bins_of_the_reference<float>(setup.decoder, 3e3, 3e5);
    expect_bins_of_the_reference<double>(setup.decoder, 3e3, 3e5);
    expect_bins_of_the_reference<std::uint16_t>(setup.decoder, 3e3, 3e5);
    expect_bins_of_the_reference<std::uint8_t>(setup.decoder, 6e2, 3e2);
  }
}

TEST(Decoder, UsesAllDigitsOfDoubles) {
  // The signal is smaller than the last digit of a float.
  const DecodeSetup setup("hamiltonian-k4", camera_with("paper-10f0"));
  const DecodingTable& table = setup.decoder.table();
  std::vector<double> raw;
  for (std::size_t i = 0; i < frame_pixels; ++i) {
    const auto bin = static_cast<Eigen::Index>(i) % table.samples();
    for (int k = 0; k < 4; ++k) raw.push_back(1e9 + table.correlation(bin, k));
  }
  const ReferenceDecoder reference(table);
  const Frame<double> frame(raw, layouts(4).front());
  const Outputs outputs = decoded(setup.decoder, frame.view);
  for (std::size_t i = 0; i < frame_pixels; ++i)
    ASSERT_EQ(outputs.bin.pixels[i], reference.bin(&raw[4 * i])) << i;
  EXPECT_EQ(outputs.bin.pixels[77], 77);
}

template <typename Number>
void expect_zeros_without_return(const Decoder& decoder) {
  const std::vector<float> zeros(frame_pixels * static_cast<std::size_t>(decoder.measurements()));
  const Frame<Number> frame(zeros, layouts(decoder.measurements()).front());
  const Outputs outputs = decoded(decoder, frame.view);
  for (std::size_t i = 0; i < frame_pixels; ++i) {
    ASSERT_EQ(outputs.status.pixels[i], PixelStatus::no_return);
    ASSERT_TRUE(std::isnan(outputs.depth_m.pixels[i]) &&
                std::isnan(outputs.signal_e_per_s.pixels[i]));
    ASSERT_EQ(outputs.bin.pixels[i], outputs.bin.pixels[0]);
    ASSERT_GE(outputs.bin.pixels[i], 0);
  }
}

TEST(Decoder, DarknessIsNoReturnInEveryType) {
  for (const char* code : {"sinusoid-k4", "hamiltonian-k4", "hamiltonian-k6"}) {
    const DecodeSetup setup(code, camera_with("paper-10f0"));
    expect_zeros_without_return<float>(setup.decoder);
    expect_zeros_without_return<double>(setup.decoder);
    expect_zeros_without_return<std::uint16_t>(setup.decoder);
    expect_zeros_without_return<std::uint8_t>(setup.decoder);
  }
}

template <typename Number>
void expect_invalid(const Decoder& decoder, const std::vector<float>& raw, Number bad) {
  std::vector<Number> numbers(raw.begin(), raw.end());
  const auto k_count = static_cast<std::size_t>(decoder.measurements());
  for (std::size_t i = 0; i < frame_pixels; i += 7) numbers[i * k_count + i % k_count] = bad;
  const Frame<Number> frame(numbers, layouts(decoder.measurements()).front());
  const Outputs outputs = decoded(decoder, frame.view, ~0u);
  for (std::size_t i = 0; i < frame_pixels; ++i)
    ASSERT_EQ(outputs.status.pixels[i] == PixelStatus::invalid, i % 7 == 0) << i;
  for (const DecodedPlane plane : decoder_planes)
    with_plane(
        plane,
        [&]<typename Value>(const Image<Value>& values) {
          for (std::size_t i = 0; i < frame_pixels; i += 7)
            ASSERT_TRUE(same<Value>({values.pixels[i]}, {no_value<Value>})) << name_of(plane);
        },
        outputs);
}

TEST(Decoder, NonFiniteValuesAreInvalidInBothFloatingTypes) {
  for (const char* code : {"sinusoid-k4", "hamiltonian-k4", "hamiltonian-k6"}) {
    const DecodeSetup setup(code, camera_with("paper-10f0"));
    const std::vector<float> raw = bytes_of_pixels(setup.decoder.table());
    for_each_target([&] {
      for (const float bad :
           {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
            -std::numeric_limits<float>::infinity()}) {
        expect_invalid<float>(setup.decoder, raw, bad);
        expect_invalid<double>(setup.decoder, raw, static_cast<double>(bad));
      }
    });
  }
}

}  // namespace
}  // namespace tofsmith

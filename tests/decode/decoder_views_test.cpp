// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

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

Outputs decoded(const Decoder& decoder, const RawView& raw, unsigned planes = ~0u) {
  Outputs outputs(frame_pixels);
  decoder.decode(raw, outputs.view(planes));
  return outputs;
}

constexpr std::size_t dark_pixels = 20;

/// Whole numbers that fit into `Number`; the first pixels are dark.
template <typename Number>
std::vector<float> whole_pixels(const DecodingTable& table, double signal, double ambient) {
  std::vector<float> raw = noisy_pixels(table, signal, ambient, static_cast<int>(frame_pixels), 12);
  for (float& value : raw)
    value = std::clamp(std::round(value), 0.0f, float{std::numeric_limits<Number>::max()});
  std::fill_n(raw.begin(), dark_pixels * static_cast<std::size_t>(table.measurements()), 0.0f);
  return raw;
}
std::vector<float> bytes_of_pixels(const DecodingTable& table) {
  return whole_pixels<std::uint8_t>(table, 600.0, 300.0);
}

/// @param planes  as in Outputs::view()
template <typename Number>
void expect_same_in_all_layouts(const Decoder& decoder, const std::vector<float>& raw,
                                unsigned planes = ~0u) {
  const Outputs expected = decoded(
      decoder, RawView::interleaved(raw.data(), height, width, decoder.measurements()), planes);
  for (const Layout& layout : layouts(decoder.measurements())) {
    SCOPED_TRACE(layout.name);
    const Frame<Number> frame(raw, layout);
    expect_same(decoded(decoder, frame.view, planes), expected);
    for_each_target([&] {
      EXPECT_EQ(decoded(decoder, frame.view).bin.pixels, expected.bin.pixels);
      expect_only(decoded(decoder, frame.view, 1), expected, 1);
    });
  }
}

void expect_dark_pixels_without_return(const Outputs& outputs) {
  for (std::size_t i = 0; i < dark_pixels; ++i) {
    ASSERT_EQ(outputs.status.pixels[i], PixelStatus::no_return);
    ASSERT_TRUE(std::isnan(outputs.depth_m.pixels[i]) &&
                std::isnan(outputs.signal_e_per_s.pixels[i]));
    ASSERT_EQ(outputs.bin.pixels[i], outputs.bin.pixels[0]);
    ASSERT_GE(outputs.bin.pixels[i], 0);
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
  expect_dark_pixels_without_return(expected);
  expect_same_in_all_layouts<float>(setup.decoder, raw);
  expect_same_in_all_layouts<double>(setup.decoder, raw);
  expect_same_in_all_layouts<std::uint16_t>(setup.decoder, raw);
  expect_same_in_all_layouts<std::uint8_t>(setup.decoder, raw);
  const std::vector<float> words = whole_pixels<std::uint16_t>(setup.decoder.table(), 3e3, 3e5);
  expect_same_in_all_layouts<double>(setup.decoder, words, 1);
  expect_same_in_all_layouts<std::uint16_t>(setup.decoder, words, 1);
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
    for (unsigned planes = 0; planes >> decoder_planes.size() == 0; ++planes) {
      SCOPED_TRACE(planes);
      expect_only(decoded(setup.decoder, frame.view, planes), all, planes);
    }
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
  std::vector<std::int32_t> expected;
  for (std::size_t i = 0; i < frame_pixels; ++i) expected.push_back(reference.bin(&raw[4 * i]));
  EXPECT_EQ(expected[77], 77);
  for (const Layout& layout : layouts(4)) {
    SCOPED_TRACE(layout.name);
    const Frame<double> frame(raw, layout);
    for_each_target([&] { EXPECT_EQ(decoded(setup.decoder, frame.view).bin.pixels, expected); });
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

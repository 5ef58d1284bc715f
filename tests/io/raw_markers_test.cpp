// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <span>

#include "decode_recording_fixture.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/camera_toml.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Recordings in which one value of pixel 0 is clipped, and pixel 1 is invalid.
class RawMarkersOfRecordings : public DecodeRecording {
 protected:
  std::unique_ptr<FrameBackend> backend(const std::vector<std::string>& settings) {
    camera_ = with_settings(camera_, settings);
    return backend_of(camera_);
  }
  std::unique_ptr<FrameBackend> difference_backend(std::vector<std::string> settings = {}) {
    for (const char* setting : {"sensor.taps=2", "sensor.readout=difference"})
      settings.emplace_back(setting);
    return backend(settings);
  }

  template <typename Number>
  void write_array(const char* name, const std::vector<Number>& numbers) {
    const std::size_t frames = numbers.size() / (6 * 5 * 4);
    write_npy(path(name), NpyArray::of<Number>({frames, 6, 5, 4}, numbers),
              OutputPolicy::overwrite);
  }
  template <typename Number>
  void write_dump(const char* name, const std::vector<Number>& numbers) {
    const auto bytes = std::as_bytes(std::span(numbers));
    std::ofstream(path(name), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
  }
  template <typename Number>
  std::vector<Number> numbers(int per_pixel, double offset) {
    std::vector<Number> all;
    for (int i = 0; i < 6 * 5 * per_pixel; ++i)
      all.push_back(static_cast<Number>(offset + 10.0 + i * 37 % 101));
    return all;
  }
  std::vector<std::uint8_t> statuses(DecodeRequest request, const FrameBackend& backend) {
    request.output = path("out.npy");
    request.stack = true;
    request.policy = OutputPolicy::overwrite;
    request.outputs = {DecodedPlane::depth, DecodedPlane::status};
    notes_ = decode_recording(request, backend).notes;
    const NpyArray array = read_npy(path("out-status.npy"));
    std::vector<std::uint8_t> first(6 * 5);
    std::memcpy(first.data(), array.bytes().data(), first.size());
    return first;
  }
  void expect_first_two(const std::vector<std::uint8_t>& found) {
    for (std::size_t i = 0; i < found.size(); ++i) {
      SCOPED_TRACE(testing::Message() << "pixel " << i);
      const auto status = static_cast<PixelStatus>(found[i]);
      if (i < 2) {
        EXPECT_EQ(status, i == 0 ? PixelStatus::saturated : PixelStatus::invalid);
      } else {
        EXPECT_NE(status, PixelStatus::saturated);
        EXPECT_NE(status, PixelStatus::invalid);
      }
    }
  }

  std::vector<std::string> notes_;
};

TEST_F(RawMarkersOfRecordings, AreIndependentOfTheNumberType) {
  const std::unique_ptr<FrameBackend> of_markers =
      backend({"raw.saturated=[255, 127]", "raw.invalid=[0, 126]"});
  const auto check = [&]<typename Number>(Number saturated, Number invalid) {
    std::vector<Number> raw = numbers<Number>(4, 0.0);
    raw[2] = saturated;
    raw[5] = invalid;
    write_array("m.npy", raw);
    DecodeRequest request{.raw = {path("m.npy")}};
    expect_first_two(statuses(request, *of_markers));
    request.average = 1;
    request.memory_mb = 0.05;  // decode in bands
    expect_first_two(statuses(request, *of_markers));
  };
  check(std::uint8_t{255}, std::uint8_t{0});
  check(std::uint16_t{255}, std::uint16_t{0});
  check(std::int16_t{255}, std::int16_t{126});
  check(std::int32_t{127}, std::int32_t{0});
  check(std::uint32_t{127}, std::uint32_t{126});
  check(255.0F, 0.0F);
  check(127.0, 126.0);
}

TEST_F(RawMarkersOfRecordings, NaNCanMeanSaturated) {
  const std::unique_ptr<FrameBackend> of_markers =
      backend({"raw.saturated=[nan]", "raw.invalid=[inf]"});
  std::vector<float> raw = numbers<float>(4, 0.0);
  raw[3] = std::numeric_limits<float>::quiet_NaN();
  raw[4] = std::numeric_limits<float>::infinity();
  write_array("m.npy", raw);
  expect_first_two(statuses({.raw = {path("m.npy")}}, *of_markers));
}

TEST_F(RawMarkersOfRecordings, ApplyBeforeFramesAreAveraged) {
  const std::unique_ptr<FrameBackend> of_markers =
      backend({"raw.saturated=[65535]", "raw.invalid=[0]"});
  std::vector<std::uint16_t> raw = numbers<std::uint16_t>(4, 0.0);
  std::vector<std::uint16_t> second = raw;
  second[1] = 65535;
  raw[6] = 0;
  raw.insert(raw.end(), second.begin(), second.end());
  write_array("two.npy", raw);
  DecodeRequest request{.raw = {path("two.npy")}};
  request.average = 2;
  expect_first_two(statuses(request, *of_markers));
  request.filter = FilterOptions::of(FilterStrength::light);
  expect_first_two(statuses(request, *of_markers));
  request.average = 1;
  request.filter.reset();
  request.hdr = {1.0, 1.0};
  for (const std::uint8_t status : statuses(request, *of_markers))
    EXPECT_NE(static_cast<PixelStatus>(status), PixelStatus::invalid) << "one exposure is left";
}

TEST_F(RawMarkersOfRecordings, ApplyToEachFileOfOneMeasurement) {
  const std::unique_ptr<FrameBackend> of_markers =
      backend({"raw.saturated=[65535]", "raw.invalid=[0]"});
  const std::vector<std::uint16_t> raw = numbers<std::uint16_t>(4, 0.0);
  DecodeRequest request;
  for (std::size_t k = 0; k < 4; ++k) {
    std::vector<std::uint16_t> part;
    for (std::size_t i = k; i < raw.size(); i += 4) part.push_back(raw[i]);
    if (k == 3) part[0] = 65535;
    if (k == 1) part[1] = 0;
    request.raw.push_back(path(("part" + std::to_string(k) + ".npy").c_str()));
    write_npy(request.raw.back(), NpyArray::of<std::uint16_t>({6, 5}, part),
              OutputPolicy::overwrite);
  }
  expect_first_two(statuses(request, *of_markers));
}

TEST_F(RawMarkersOfRecordings, ApplyBeforeTheBlackLevelOfADump) {
  // 12-bit values without a saturation marker: the largest value of the converter is saturated.
  const std::unique_ptr<FrameBackend> of_markers =
      backend({"sensor.adc_bits=12", "sensor.gain_e_per_dn=5", "raw.invalid=[7]"});
  std::vector<std::uint16_t> raw = numbers<std::uint16_t>(4, 200.0);
  raw[0] = 4095;
  raw[4] = 7;
  write_dump("d.bin", raw);
  std::ofstream(path("d.raw.toml")) << "width = 5\nheight = 6\nmeasurements = 4\nbits = 12\n"
                                       "layout = 'interleaved'\nblack_level = 100\n";
  DecodeRequest request{.raw = {path("d.bin")}};
  request.raw_format = path("d.raw.toml");
  expect_first_two(statuses(request, *of_markers));
}

TEST_F(RawMarkersOfRecordings, ApplyToEachSubtractedTap) {
  const std::unique_ptr<FrameBackend> of_taps =
      difference_backend({"sensor.adc_bits=12", "sensor.gain_e_per_dn=5", "raw.invalid=[0]"});
  std::vector<std::uint16_t> raw = numbers<std::uint16_t>(8, 1500.0);
  raw[3] = 4095;
  raw[8] = 0;
  raw[16] = raw[17];  // a difference of 0 is a valid measurement
  write_dump("ab.bin", raw);
  std::ofstream(path("ab.raw.toml")) << "width = 5\nheight = 6\nmeasurements = 8\nbits = 12\n"
                                        "layout = 'interleaved'\ntaps = 'subtract'\n";
  DecodeRequest request{.raw = {path("ab.bin")}};
  request.raw_format = path("ab.raw.toml");
  expect_first_two(statuses(request, *of_taps));

  std::size_t at = 0;
  std::vector<std::uint8_t> of_stream;
  DecodedStream result;
  request.outputs = {DecodedPlane::status};
  decode_stream(
      request, *of_taps, stream_of(std::as_bytes(std::span(raw)), at),
      [&](std::span<const std::byte> plane) {
        for (const std::byte status : plane)
          of_stream.push_back(std::to_integer<std::uint8_t>(status));
      },
      {}, result);
  expect_first_two(of_stream);
}

TEST_F(RawMarkersOfRecordings, LimitsOfDifferencesApplyToStoredValues) {
  const std::vector<std::string> converter = {"sensor.adc_bits=12", "sensor.gain_e_per_dn=5",
                                              "raw.invalid=[1]"};
  const std::unique_ptr<FrameBackend> differences = difference_backend(converter);
  std::vector<std::int16_t> of_both_signs = numbers<std::int16_t>(4, -60.0);
  of_both_signs[1] = -2048;
  of_both_signs[4] = 1;
  write_array("signed.npy", of_both_signs);
  auto found = statuses({.raw = {path("signed.npy")}}, *differences);
  EXPECT_EQ(static_cast<PixelStatus>(found[0]), PixelStatus::saturated);
  EXPECT_EQ(static_cast<PixelStatus>(found[1]), PixelStatus::invalid);

  std::vector<std::uint32_t> around = numbers<std::uint32_t>(4, 2000.0);
  around[3] = 0;
  around[5] = 1;
  write_array("around.npy", around);
  const std::unique_ptr<FrameBackend> middle = difference_backend({"sensor.black_level_dn=2048"});
  expect_first_two(statuses({.raw = {path("around.npy")}}, *middle));
}

TEST_F(RawMarkersOfRecordings, ImpossibleMarkersAreRejected) {
  const auto refused = [&](const char* setting, const char* words) {
    camera_ = built_in_camera("paper-10f0");
    const std::unique_ptr<FrameBackend> of_markers = backend({setting});
    EXPECT_THAT([&] { statuses({.raw = {path("m.npy")}}, *of_markers); },
                ThrowsMessage<IoError>(HasSubstr(words)));
  };
  write_array("m.npy", numbers<std::uint16_t>(4, 0.0));
  refused("raw.saturated=[65535, 65536]",
          "m.npy: found numbers of type uint16; raw.saturated = 65536 of the camera must be a "
          "whole number from 0 to 65535, or it cannot occur");
  refused("raw.invalid=[-1]", "raw.invalid = -1");
  refused("raw.invalid=[0.5]", "raw.invalid = 0.5");
  refused("raw.invalid=[nan]", "raw.invalid = nan");
  write_array("m.npy", numbers<float>(4, 0.0));
  refused("raw.invalid=[16777217]", "raw.invalid = 16777217");
}

TEST_F(RawMarkersOfRecordings, ALimitSuppressesTheNoteOnElectrons) {
  write_array("m.npy", numbers<std::int16_t>(4, 0.0));
  const DecodeRequest request{.raw = {path("m.npy")}};
  const auto notes = [&](std::vector<std::string> settings) {
    camera_ = built_in_camera("paper-10f0");
    statuses(request, *difference_backend(std::move(settings)));
    return notes_;
  };
  const char* const words = "no gain, black level or saturation level is set";
  EXPECT_THAT(notes({}), testing::Contains(HasSubstr(words)));
  EXPECT_THAT(notes({"sensor.full_well_e=30000"}), testing::Each(Not(HasSubstr(words))));
  EXPECT_THAT(notes({"sensor.adc_bits=12", "sensor.gain_e_per_dn=1"}),
              testing::Each(Not(HasSubstr(words))));
  write_array("m.npy", numbers<float>(4, 0.0));  // electrons may be floats, counts are integers
  EXPECT_THAT(notes({}), testing::Each(Not(HasSubstr(words))));
}

TEST(RawMarkersOfCameras, AreReadAndWritten) {
  const char* const text =
      "fundamental_frequency_hz = 15e6\n[raw]\nsaturated = [32767, 0xFFF, nan]\n"
      "invalid = [-32768, \"-inf\", 0.5]\n";
  const Camera camera = parse_camera_toml(text, "c.toml");
  ASSERT_EQ(camera.raw.saturated.size(), 3u);
  EXPECT_EQ(camera.raw.saturated[0], 32767.0);
  EXPECT_EQ(camera.raw.saturated[1], 4095.0);
  EXPECT_TRUE(std::isnan(camera.raw.saturated[2]));
  EXPECT_EQ(camera.raw.invalid,
            (std::vector{-32768.0, -std::numeric_limits<double>::infinity(), 0.5}));
  EXPECT_EQ(parse_camera_toml(camera_to_toml(camera), "c.toml"), camera);
  EXPECT_EQ(camera_to_json(camera).find("null"), std::string::npos);
  EXPECT_THAT(camera_to_toml(built_in_camera("paper-10f0")), Not(HasSubstr("[raw]")));
}

TEST(RawMarkersOfCameras, WithTwoMeaningsAreRejectedWithTheirPlace) {
  const auto refused = [](const std::string& lines, const char* place, const char* words) {
    EXPECT_THAT(
        [&] { parse_camera_toml("fundamental_frequency_hz = 15e6\n[raw]\n" + lines, "c.toml"); },
        ThrowsMessage<IoError>(testing::AllOf(testing::StartsWith(place), HasSubstr(words))));
  };
  refused("saturated = [1, 65535]\ninvalid = [65535]\n", "c.toml:4:11",
          "raw.invalid = 65535; must not be in raw.saturated as well");
  refused("saturated = [nan]\ninvalid = [nan]\n", "c.toml:4:11", "raw.invalid = nan");
  refused("saturated = [3, 3]\n", "c.toml:3:13", "raw.saturated = 3; must be listed once");
  refused("saturated = [1e16]\n", "c.toml:3:13", "raw.saturated");
  refused("saturated = 65535\n", "c.toml:3:13", "expected a list of numbers");
  refused("saturated = ['max']\n", "c.toml:3:14", "expected a number, nan, inf or -inf");
  refused("saturate = [1]\n", "c.toml:3:1", "raw.saturate");
  EXPECT_EQ((RawMarkers{{nan}, {}}), (RawMarkers{{nan}, {}}));
  EXPECT_NE((RawMarkers{{1.0}, {}}), (RawMarkers{{}, {1.0}}));
}

}  // namespace
}  // namespace tofsmith

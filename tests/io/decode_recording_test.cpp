// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/decode_recording.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>

#include "core/shared/text_numbers.hpp"
#include "decode_recording_fixture.hpp"
#include "io/images/exr.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/decoding_table_file.hpp"
#include "tofsmith/io/depth_file.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/io/raw_frames.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

const std::vector depth_and_averaged = {DecodedPlane::depth, DecodedPlane::averaged};

TEST_F(DecodeRecording, EqualsTheDecoder) {
  const DecodedRecording result = decode_recording(request("d.npy"), *backend_);
  ASSERT_EQ(result.files.size(), 3u);
  EXPECT_EQ(result.frames.size(), 3u);
  EXPECT_EQ(result.total().pixels(), 3 * 6 * 5);
  EXPECT_EQ(result.outputs, std::vector{DecodedPlane::depth});
  for (int f = 0; f < 3; ++f) {
    RawFrames frame = raw_;
    frame.frames = 1;
    frame.values.assign(raw_.frame(f), raw_.frame(f) + 6 * 5 * 4);
    const DepthImage expected = backend_->decoder().correlation_decoder()->decode(frame);
    EXPECT_EQ(read_depth(result.files[static_cast<std::size_t>(f)]).pixels,
              expected.depth_m.pixels);
  }
}

TEST_F(DecodeRecording, KeepsAndReportsTheFinishedFilesWhenStopped) {
  for (const bool stack : {false, true}) {
    DecodeRequest asked = request("d.npy");
    asked.stack = stack;
    const int before = directory_.files();
    DecodedRecording result;
    const Progress progress = [](double fraction, std::string_view) { return fraction < 0.5; };
    EXPECT_THROW(decode_recording(asked, *backend_, progress, result), Interrupted);
    EXPECT_EQ(result.frame_count, 3);
    EXPECT_EQ(result.frames.size(), 1u);
    EXPECT_EQ(result.files.size(), stack ? 0u : 1u);
    EXPECT_EQ(directory_.files() - before, stack ? 0 : 1);
    for (const std::filesystem::path& file : result.files)
      EXPECT_TRUE(std::filesystem::exists(file));
  }
}

TEST_F(DecodeRecording, FiltersLikeTheFilter) {
  const FilterOptions options = FilterOptions::of(FilterStrength::light);
  DecodeRequest filtered = stack("f.npy", depth_and_averaged);
  filtered.filter = options;
  filtered.frame = 1;
  decode_recording(filtered, *backend_);
  const Decoder& decoder = *backend_->decoder().correlation_decoder();
  const FilteredFrame frame = Filter(decoder.table(), options).apply(raw_, 1);
  Image<float> depth_m(6, 5);
  decoder.decode(frame.view(), {.depth_m = depth_m.pixels.data()});
  EXPECT_EQ(plane("f.npy", 0), depth_m.pixels);
  EXPECT_EQ(plane("f-averaged.npy", 0), frame.averaged().pixels);
}

TEST_F(DecodeRecording, AveragesFramesLikeTheTimeFilter) {
  const TimeFilterOptions options{.max_frames = 5, .max_difference_sigma = 9.0};
  DecodeRequest added = stack("all.npy", depth_and_averaged);
  added.time_filter = options;
  added.filter = FilterOptions::of(FilterStrength::light);
  EXPECT_EQ(decode_recording(added, *backend_).frames.size(), 3u);
  const Decoder& decoder = *backend_->decoder().correlation_decoder();
  TimeFilterOptions before_filter = options;
  before_filter.before_filter = true;
  TimeFilter in_time(decoder.table(), before_filter);
  const Filter in_space(decoder.table(), *added.filter);
  FilteredFrame filtered;
  for (int f = 0; f < 3; ++f) {
    const RawView sum = *in_time.add(view_of_frame(raw_, f));
    EXPECT_EQ(std::ranges::max(std::span(sum.averaged, 6 * 5)) > 1.5F, f > 0);
    in_space.apply(sum, filtered);
    Image<float> depth_m(6, 5);
    decoder.decode(filtered.view(), {.depth_m = depth_m.pixels.data()});
    EXPECT_EQ(plane("all.npy", static_cast<std::size_t>(f)), depth_m.pixels);
    EXPECT_EQ(plane("all-averaged.npy", static_cast<std::size_t>(f)), filtered.averaged().pixels);
  }
}

TEST_F(DecodeRecording, ASingleFrameIsAveragedWithEarlierFrames) {
  for (const int average : {1, 2}) {
    SCOPED_TRACE(average);
    DecodeRequest all = stack("all.npy", depth_and_averaged);
    all.time_filter = TimeFilterOptions{.max_difference_sigma = 20.0};
    all.average = average;
    all.policy = OutputPolicy::overwrite;
    DecodeRequest one = all;
    one.output = path("one.npy");
    one.frame = 1;
    decode_recording(all, *backend_);
    const DecodedRecording result = decode_recording(one, *backend_);
    EXPECT_EQ(result.first_frame, 1);
    EXPECT_EQ(plane("one.npy", 0), plane("all.npy", 1));
    EXPECT_EQ(plane("one-averaged.npy", 0), plane("all-averaged.npy", 1));
    // Two frames, or a mean of two and a single frame.
    EXPECT_EQ(plane("all-averaged.npy", 1), std::vector<float>(6 * 5, average == 1 ? 2.0F : 3.0F));
  }
}

TEST_F(DecodeRecording, ASingleFrameIsAveragedWithItsLookAhead) {
  TimeFilter both_ways(backend_->decoder().table(),
                       {.max_difference_sigma = 20.0, .look_ahead = 1});
  DecodeRequest all = stack("all.npy", depth_and_averaged);
  all.time_filter = both_ways.options();
  EXPECT_EQ(decode_recording(all, *backend_).frames.size(), 3u);
  EXPECT_FALSE(both_ways.add(view_of_frame(raw_, 0)).has_value());
  for (int f = 0; f < 3; ++f) {
    const auto added = f < 2 ? both_ways.add(view_of_frame(raw_, f + 1)) : both_ways.add_end();
    EXPECT_EQ(plane("all-averaged.npy", static_cast<std::size_t>(f)),
              std::vector<float>(added->averaged, added->averaged + 6 * 5));
    EXPECT_FLOAT_EQ(added->averaged[7], f == 0 ? 2.0F : 3.0F);
    DecodeRequest one = all;
    one.output = path("one.npy");
    one.frame = f;
    one.policy = OutputPolicy::overwrite;
    decode_recording(one, *backend_);
    EXPECT_EQ(plane("one.npy", 0), plane("all.npy", static_cast<std::size_t>(f)));
  }
  // The look-ahead is limited to the recording.
  all.time_filter->look_ahead = 1000;
  all.output = path("farther.npy");
  all.memory_mb = 0.1;
  EXPECT_EQ(decode_recording(all, *backend_).frames.size(), 3u);
  EXPECT_EQ(plane("farther-averaged.npy", 0), std::vector<float>(6 * 5, 3.0F));
}

TEST_F(DecodeRecording, LookAheadEndsWithTheLastMean) {
  DecodeRequest all = stack("all.npy", {DecodedPlane::averaged});
  all.time_filter = TimeFilterOptions{.max_difference_sigma = 20.0, .look_ahead = 2};
  all.average = 2;
  EXPECT_EQ(decode_recording(all, *backend_).frames.size(), 2u);
  for (std::size_t f = 0; f < 2; ++f)  // a mean of two frames, and a single frame
    EXPECT_EQ(plane("all-averaged.npy", f), std::vector<float>(6 * 5, 3.0F));
}

TEST_F(DecodeRecording, MeansOfEqualFramesDifferOnlyInTheirNoise) {
  RawFrames equal = raw_;
  equal.frames = 5;
  equal.values.clear();
  for (int f = 0; f < 5; ++f) equal.values.insert(equal.values.end(), raw_.frame(0), raw_.frame(1));
  write_raw_frames(path("equal.npy"), equal, OutputPolicy::refuse_existing);
  DecodeRequest alone =
      stack("alone.npy", {DecodedPlane::depth, DecodedPlane::deviation, DecodedPlane::averaged});
  alone.raw = {path("equal.npy")};
  DecodeRequest mean = alone;
  mean.output = path("mean.npy");
  alone.frame = 0;
  mean.average = 3;
  decode_recording(alone, *backend_);
  const DecodedRecording result = decode_recording(mean, *backend_);
  EXPECT_EQ(result.frames.size(), 2u);
  for (std::size_t f = 0; f < 2; ++f) {
    const float frames = f == 0 ? 3.0F : 2.0F;  // the last mean is of the remaining two frames
    EXPECT_EQ(plane("mean.npy", f), plane("alone.npy", 0));
    EXPECT_EQ(plane("mean-averaged.npy", f), std::vector<float>(6 * 5, frames));
    const std::vector<float> single = plane("alone-deviation.npy", 0);
    const std::vector<float> less = plane("mean-deviation.npy", f);
    for (std::size_t i = 0; i < less.size(); ++i)
      EXPECT_NEAR(less[i] * std::sqrt(frames), single[i], 2e-3F * single[i]);
  }
  EXPECT_EQ(plane("alone-averaged.npy", 0), std::vector<float>(6 * 5, 1.0F));
}

TEST_F(DecodeRecording, AveragedInputHasTheNoiseOfAllItsMeasurements) {
  DecodeRequest single =
      stack("single.npy", {DecodedPlane::depth, DecodedPlane::deviation, DecodedPlane::averaged});
  DecodeRequest means = single;
  means.output = path("means.npy");
  means.averaged = 9.0;
  decode_recording(single, *backend_);
  decode_recording(means, *backend_);
  EXPECT_EQ(plane("means.npy", 2), plane("single.npy", 2));
  EXPECT_EQ(plane("means-averaged.npy", 2), std::vector<float>(6 * 5, 9.0F));
  const std::vector<float> more = plane("single-deviation.npy", 2),
                           less = plane("means-deviation.npy", 2);
  for (std::size_t i = 0; i < less.size(); ++i)
    EXPECT_NEAR(3.0F * less[i], more[i], 2e-3F * more[i]);
  means.output = path("both.npy");
  means.average = 2;
  decode_recording(means, *backend_);
  EXPECT_EQ(plane("both-averaged.npy", 0), std::vector<float>(6 * 5, 18.0F));
  EXPECT_EQ(plane("both-averaged.npy", 1), std::vector<float>(6 * 5, 9.0F));
}

TEST_F(DecodeRecording, OneFilePerMeasurementEqualsAnInterleavedRecording) {
  DecodeRequest together = stack("together.npy", {}), apart = stack("apart.npy", {});
  apart.raw.clear();
  for (std::size_t k = 0; k < 4; ++k) {
    NpyArray phase(NpyType::float32, {3, 6, 5});
    auto* const numbers = reinterpret_cast<float*>(phase.bytes().data());
    for (std::size_t i = 0; i < 3 * 6 * 5; ++i) numbers[i] = raw_.values[4 * i + k];
    apart.raw.push_back(path(("p" + std::to_string(k) + ".npy").c_str()));
    write_npy(apart.raw.back(), phase, OutputPolicy::refuse_existing);
  }
  decode_recording(together, *backend_);
  decode_recording(apart, *backend_);
  EXPECT_TRUE(std::ranges::equal(read_npy(path("together.npy")).bytes(),
                                 read_npy(path("apart.npy")).bytes()));
  DecodeRequest bands = apart;
  bands.output = path("bands.npy");
  bands.memory_mb = 0.001;
  decode_recording(bands, *backend_);
  EXPECT_TRUE(
      std::ranges::equal(read_npy(path("bands.npy")).bytes(), read_npy(path("apart.npy")).bytes()));
  // An input of several files may not be overwritten either.
  bands.raw = apart.raw;
  bands.output = apart.raw[2];
  bands.policy = OutputPolicy::overwrite;
  EXPECT_THROW(decode_recording(bands, *backend_), IoError);
}

TEST_F(DecodeRecording, MeansAreIndependentOfBandsAndFiltersUseTheirNoise) {
  DecodeRequest mean = stack("whole.npy", {DecodedPlane::depth, DecodedPlane::deviation});
  mean.average = 2;
  decode_recording(mean, *backend_);
  mean.output = path("bands.npy");
  mean.memory_mb = 0.001;
  decode_recording(mean, *backend_);
  for (const char* plane : {".npy", "-deviation.npy"})
    EXPECT_TRUE(std::ranges::equal(read_npy(path("whole").string() + plane).bytes(),
                                   read_npy(path("bands").string() + plane).bytes()));
  mean.memory_mb = 64;
  mean.output = path("filtered.npy");
  mean.outputs = depth_and_averaged;
  mean.filter = FilterOptions::of(FilterStrength::light);
  decode_recording(mean, *backend_);
  for (std::size_t f = 0; f < 2; ++f)
    for (const float n : plane("filtered-averaged.npy", f)) {
      const float frames = f == 0 ? 2.0F : 1.0F;
      EXPECT_GE(n, 0.95F * frames);
      EXPECT_LE(n, 25.1F * frames);
    }
}

TEST_F(DecodeRecording, ClippedAndInvalidPixelsOfOneFrameStaySoInTheMean) {
  camera_.sensor.full_well_e = 5000.0;
  const auto number = [&](int frame, int pixel) -> float& {
    return raw_.values[static_cast<std::size_t>((frame * 6 * 5 + pixel) * 4)];
  };
  number(1, 0) = 5000.0F;
  number(2, 1) = std::numeric_limits<float>::quiet_NaN();
  number(0, 2) = std::numeric_limits<float>::infinity();
  write_raw_frames(path("some.npy"), raw_, OutputPolicy::refuse_existing);
  DecodeRequest mean = request("d.npz");
  mean.raw = {path("some.npy")};
  mean.average = 3;
  const DecodedRecording result = decode_recording(mean, *backend_of(camera_));
  EXPECT_EQ(result.total().of(PixelStatus::saturated), 1);
  EXPECT_EQ(result.total().of(PixelStatus::invalid), 2);
}

TEST_F(DecodeRecording, MemoryIncludesThePlanesThatDepthLimitsRequire) {
  DecodeRequest asked = request("d.npz");
  asked.outputs = {DecodedPlane::depth};
  asked.memory_mb = 1e-6;
  const auto required_mb = [&] {
    try {
      decode_recording(asked, *backend_);
    } catch (const IoError& error) {
      const std::string text = error.what(), before = " require ";
      std::string_view rest = std::string_view(text).substr(text.find(before) + before.size());
      return take_number(rest).value_or(0.0);
    }
    return 0.0;
  };
  const double without_mb = required_mb();
  asked.max_depth_m = 1.0;
  constexpr double planes_mb = 1e-6 * 6 * 5 * 5;  // confidence and status
  EXPECT_NEAR(required_mb() - without_mb, planes_mb, 2e-6);
}

TEST_F(DecodeRecording, RejectsInvalidRequestsBeforeWriting) {
  const int before = directory_.files();
  DecodeRequest wrong;
  const auto decode = [&] { decode_recording(wrong, *backend_); };
  const auto refused = [&](const auto& change, const char* words) {
    wrong = request("d.npz");
    change(wrong);
    EXPECT_THAT(decode, ThrowsMessage<std::invalid_argument>(HasSubstr(words)));
  };
  refused([](DecodeRequest& r) { r.frame = 3; }, "frame = 3");
  refused([](DecodeRequest& r) { r.stack = true; }, "stack = true");
  refused([](DecodeRequest& r) { r.averaged = 0.0; }, "averaged = 0");
  refused([](DecodeRequest& r) { r.raw.clear(); }, "raw = no file");
  refused([](DecodeRequest& r) { r.outputs = {DecodedPlane::ratio}; }, "outputs = ratio");
  refused([](DecodeRequest& r) { r.memory_mb = 0.0; }, "memory_mb = 0; must be in (0, 1000000000]");
  refused([](DecodeRequest& r) { r.average = 0; }, "average = 0; must be >= 1");
  refused([](DecodeRequest& r) { r.average = 4; }, "average = 4; ");
  refused([](DecodeRequest& r) { r.time_filter = TimeFilterOptions{.max_frames = 0}; },
          "TimeFilterOptions::max_frames = 0; must be >= 1");
  refused([](DecodeRequest& r) { r.filter = FilterOptions{.windows = 4}; },
          "windows = 4; must be in [1, 3]");
  const auto signal_as_pfm = [&](DecodeRequest& r) {
    r.output = path("d.pfm");
    r.outputs = {DecodedPlane::signal};
  };
  refused(signal_as_pfm, "a .pfm file contains only depth");
  const auto third_mean = [](DecodeRequest& r) {
    r.average = 2;
    r.frame = 2;
  };
  refused(third_mean, "contains 3 frames, 2 means, counted from 0");
  wrong = request("d.npz");
  wrong.filter = FilterOptions{};
  wrong.memory_mb = 0.1;
  EXPECT_THAT(decode,
              ThrowsMessage<IoError>(HasSubstr(
                  "to be filtered and written to this output; expected at most 0.1 MB (without "
                  "filters, mixed and undistort")));
  wrong = request("raw.npy");
  wrong.frame = 0;
  wrong.policy = OutputPolicy::overwrite;
  EXPECT_THAT(decode, ThrowsMessage<IoError>(HasSubstr("choose another name")));
  EXPECT_EQ(directory_.files(), before);
}

TEST(DecodedPlanes, HaveUniqueNames) {
  std::set<std::string_view> names;
  for (const PlaneDescription& described : plane_descriptions) {
    names.insert(name_of(described.plane));
    for (const std::string_view word : {described.word, described.member})
      EXPECT_EQ(parse_word<DecodedPlane>("plane", word), described.plane);
    EXPECT_THAT(std::string(help_of_outputs()), HasSubstr(std::string(described.help)));
  }
  EXPECT_EQ(names.size(), plane_descriptions.size());
  EXPECT_EQ(parse_word<DecodedPlane>("plane", "amplitude"), DecodedPlane::signal);
  EXPECT_THROW(parse_word<DecodedPlane>("plane", "depth_mm"), std::invalid_argument);
}

TEST(DecodedPlanes, AreInEveryFileOfSeveralPlanes) {
  const TemporaryDirectory directory;
  std::vector<DecodedPlane> planes;
  for (const PlaneDescription& described : plane_descriptions) planes.push_back(described.plane);
  DepthImage image(planes, 2, 3);
  for (std::size_t p = 0; p < planes.size(); ++p)
    with_plane(
        planes[p],
        [p]<typename Value>(Image<Value>& values) {
          std::ranges::fill(values.pixels, static_cast<Value>(p + 1));
        },
        image);
  for (const char* name : {"d.npz", "d.exr", "d.ply"})
    write_decoded(directory / name, image, planes, PinholeView::centred(3, 2, 1.0),
                  OutputPolicy::refuse_existing, true);
  const NpzArrays arrays = read_npz(directory / "d.npz");
  const ExrPlanes channels = read_exr(directory / "d.exr");
  std::ifstream file(directory / "d.ply", std::ios::binary);
  const std::string points((std::istreambuf_iterator<char>(file)), {});
  const char* const scalars = points.data() + points.find("end_header\n") + 11 + 3 * sizeof(float);
  for (std::size_t p = 0; p < planes.size(); ++p) {
    const std::string word(name_of(planes[p]));
    SCOPED_TRACE(word);
    const std::vector<float> expected(6, static_cast<float>(p + 1));
    EXPECT_EQ(arrays.at(word).to_floats(), expected);
    EXPECT_EQ(channels.at(planes[p] == DecodedPlane::depth ? "Z" : word).pixels, expected);
    EXPECT_THAT(points, HasSubstr("property float " + word + "\n"));
    float scalar = 0.0f;
    std::memcpy(&scalar, scalars + p * sizeof(float), sizeof(float));
    EXPECT_EQ(scalar, expected.front());
  }
}

TEST(LoadDecodingTable, AcceptsOptionsOfTablesForTablesOnly) {
  EXPECT_THAT(
      [] {
        load_decoding_table("hamiltonian-k3", built_in_camera("paper-10f0"), {.range_m = 3.0});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("must be a measured table for range_m")));
}

std::size_t number_of_points(const std::filesystem::path& ply) {
  std::ifstream file(ply, std::ios::binary);
  std::string line;
  while (std::getline(file, line) && !line.starts_with("element vertex ")) {
  }
  return std::stoul(line.substr(15));
}

TEST_F(DecodeRecording, CloudsContainThePixelsWithStatusOk) {
  for (std::size_t i = 0; i < 40; ++i) raw_.values[i] = 1e6F;  // constant: no return
  raw_.values[40] = std::numeric_limits<float>::quiet_NaN();
  write_raw_frames(path("raw.npy"), raw_, OutputPolicy::overwrite);
  DecodeRequest asked = request("d.ply");
  EXPECT_THAT([&] { decode_recording(asked, *backend_); },
              ThrowsMessage<std::invalid_argument>(
                  HasSubstr("is required for points and z if the camera has no [lens]")));
  asked.view_deg = 60.0;
  asked.frame = 0;
  asked.outputs = {DecodedPlane::signal};
  const auto points_of = [&] {
    decode_recording(asked, *backend_);
    return number_of_points(asked.output);
  };
  DepthImage image = backend_->decoder().correlation_decoder()->decode(raw_, 0);
  const auto ok =
      static_cast<std::size_t>(std::ranges::count(image.status.pixels, PixelStatus::ok));
  const auto with_depth = static_cast<std::size_t>(std::ranges::count_if(
      image.depth_m.pixels, [](float depth_m) { return std::isfinite(depth_m); }));
  ASSERT_LT(ok, with_depth);
  EXPECT_EQ(points_of(), ok);
  asked.policy = OutputPolicy::overwrite;
  asked.all_points = true;
  EXPECT_EQ(points_of(), with_depth);

  asked.output = path("d.pcd");
  asked.all_points = false;
  decode_recording(asked, *backend_);
  std::ifstream file(asked.output, std::ios::binary);
  const std::string content((std::istreambuf_iterator<char>(file)), {});
  const auto data = content.find("DATA binary\n") + 12;
  EXPECT_THAT(content.substr(0, data),
              AllOf(HasSubstr("FIELDS x y z signal\n"), HasSubstr("WIDTH 5\nHEIGHT 6\n"),
                    HasSubstr("POINTS 30\n")));
  ASSERT_EQ(content.size() - data, 30 * 4 * sizeof(float));
  std::size_t points = 0;
  for (std::size_t i = 0; i < 30; ++i) {
    std::array<float, 4> point;
    std::memcpy(point.data(), content.data() + data + i * sizeof(point), sizeof(point));
    const bool is_ok = image.status.pixels[i] == PixelStatus::ok;
    EXPECT_EQ(std::isfinite(point[2]), is_ok) << i;
    if (!is_ok) continue;
    ++points;
    EXPECT_NEAR(std::hypot(point[0], point[1], point[2]), image.depth_m.pixels[i], 1e-5);
    EXPECT_EQ(point[3], image.signal_e_per_s.pixels[i]);
  }
  EXPECT_EQ(points, ok);
}

TEST_F(DecodeRecording, NotesThatAFilteredFrameHasOtherNoiseThanTheCamera) {
  RawFrames calm{.frames = 1, .height = 64, .width = 64, .measurements = 4, .values = {}};
  for (int i = 0; i < 64 * 64 * 4; ++i)
    calm.values.push_back(1000.0F + 300.0F * static_cast<float>(i % 4) +
                          static_cast<float>(i * 7919 % 101 - 50) / 25.0F);
  write_raw_frames(path("calm.npy"), calm, OutputPolicy::refuse_existing);
  DecodeRequest filtered{.raw = {path("calm.npy")},
                         .output = path("filtered.npy"),
                         .filter = FilterOptions::of(FilterStrength::light)};
  EXPECT_THAT(decode_recording(filtered, *backend_).notes,
              testing::Contains(testing::AllOf(testing::HasSubstr("times the noise"),
                                               testing::HasSubstr("calibrate noise"))));
  filtered.filter.reset();
  filtered.output = path("alone.npy");
  EXPECT_THAT(decode_recording(filtered, *backend_).notes,
              testing::Not(testing::Contains(testing::HasSubstr("calibrate noise"))));
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/recordings/decoded_output.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "decode_recording_fixture.hpp"
#include "temporary_directory.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/decode/frame_pipeline.hpp"
#include "tofsmith/decode/merge_exposures.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/decode_recording.hpp"
#include "tofsmith/io/decoding_table_file.hpp"
#include "tofsmith/io/image_file.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/io/raw_frames.hpp"
#include "tofsmith/simulate/capture.hpp"

namespace tofsmith {

namespace {

// Notes of decode_recording() on raw numbers in the wrong order.

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class Misfit : public testing::Test {
 protected:
  /// Frames of a ramp of depths, (1, 24, 32, K).
  RawFrames recorded(const std::string& code, double signal_e_per_s = 1e6) const {
    SceneImage scene(24, 32);
    for (std::size_t i = 0; i < scene.depth_m.size(); ++i)
      scene.depth_m.pixels[i] = 1.0f + 0.009f * static_cast<float>(i);
    return capture(
        scene, load_code(code, camera_), camera_,
        {.signal_e_per_s = signal_e_per_s, .ambient_e_per_s = 1e4, .falloff = false, .seed = 3});
  }
  /// With measurement order[k] of each pixel as its k-th.
  static RawFrames in_order(RawFrames raw, const std::vector<int>& order) {
    const std::vector<float> before = raw.values;
    for (std::size_t pixel = 0; pixel < before.size(); pixel += order.size())
      for (std::size_t k = 0; k < order.size(); ++k)
        raw.values[pixel + k] = before[pixel + static_cast<std::size_t>(order[k])];
    return raw;
  }
  template <typename Number>
  std::vector<std::string> notes(const std::string& code, const RawFrames& raw) const {
    const std::vector<Number> numbers(raw.values.begin(), raw.values.end());
    const TemporaryDirectory directory;
    write_npy(directory / "raw.npy",
              NpyArray::of<Number>({24, 32, static_cast<std::size_t>(raw.measurements)}, numbers),
              OutputPolicy::overwrite);
    const auto backend =
        cpu_backend(make_decoder(DecodeMethod::zncc, load_decoding_table(code, camera_).table));
    return decode_recording({.raw = {directory / "raw.npy"}, .output = directory / "d.npz"},
                            *backend)
        .notes;
  }

  Camera camera_ = load_camera("paper-10f0");
};

TEST_F(Misfit, IsNotReportedForNumbersInTheRightOrder) {
  for (const char* code : {"sinusoid-k4", "hamiltonian-k5", "multifrequency-1x4-5x4"})
    for (const double signal : {1e3, 1e5, 1e7})
      EXPECT_THAT(notes<float>(code, recorded(code, signal)), IsEmpty()) << code << " " << signal;
}

TEST_F(Misfit, NamesAnOrderThatFits) {
  const RawFrames phases = in_order(recorded("sinusoid-k4"), {0, 2, 1, 3});
  EXPECT_THAT(notes<float>("sinusoid-k4", phases),
              ElementsAre(AllOf(HasSubstr("raw numbers do not fit this code (residual"),
                                HasSubstr("--order 0,2,1,3;"), HasSubstr("others"))));
  const RawFrames exchanged =
      in_order(recorded("multifrequency-1x4-5x4"), {4, 5, 6, 7, 0, 1, 2, 3});
  EXPECT_THAT(notes<float>("multifrequency-1x4-5x4", exchanged),
              ElementsAre(HasSubstr("--order 4,5,6,7,0,1,2,3")));
  const RawFrames nested = in_order(recorded("multifrequency-1x4-5x4"), {0, 4, 1, 5, 2, 6, 3, 7});
  EXPECT_THAT(notes<float>("multifrequency-1x4-5x4", nested),
              ElementsAre(HasSubstr("--order 0,4,1,5,2,6,3,7")));
}

TEST_F(Misfit, NamesTheByteOrder) {
  camera_ = load_camera("paper-10f0",
                        std::vector<std::string>{"sensor.adc_bits=16", "sensor.gain_e_per_dn=10"});
  RawFrames raw = recorded("hamiltonian-k4");
  EXPECT_THAT(notes<std::uint16_t>("hamiltonian-k4", raw), IsEmpty());
  for (float& number : raw.values) {
    const auto word = static_cast<std::uint16_t>(number);
    number = static_cast<float>(static_cast<std::uint16_t>(word << 8 | word >> 8));
  }
  EXPECT_THAT(notes<std::uint16_t>("hamiltonian-k4", raw),
              ElementsAre(HasSubstr("the other byte order")));
}

TEST_F(Misfit, NamesNoOrderForAnotherCode) {
  EXPECT_THAT(notes<float>("hamiltonian-k4", recorded("gray-k4")),
              ElementsAre(AllOf(HasSubstr("check --order, --code"), Not(HasSubstr("Better fit")))));
}

using testing::HasSubstr;
using testing::ThrowsMessage;

/// Two groups of three frames of 6 x 5 pixels.
class DecodeExposures : public DecodeRecording {
 protected:
  DecodeExposures() : DecodeRecording(6) {
    request_ = stack("hdr.npy", {DecodedPlane::depth, DecodedPlane::averaged});
    request_.hdr = {1.0, 2.0, 4.0};
  }

  DecodeRequest request_;
};

TEST_F(DecodeExposures, AreMergedLikeFramesInMemory) {
  EXPECT_EQ(decode_recording(request_, *backend_).frames.size(), 2u);
  const Decoder& decoder = *backend_->decoder().correlation_decoder();
  std::vector<float> depth_m, averaged;
  for (int group = 0; group < 2; ++group) {
    std::vector<RawView> frames;
    for (int f = 0; f < 3; ++f)
      frames.push_back(RawView::interleaved(raw_.frame(3 * group + f), 6, 5, 4));
    MergedExposures merged;
    merge_exposures(frames, request_.hdr, decoder.table(), merged);
    Image<float> depth(6, 5);
    decoder.decode(merged.view(), {.depth_m = depth.pixels.data()});
    depth_m.insert(depth_m.end(), depth.pixels.begin(), depth.pixels.end());
    averaged.insert(averaged.end(), merged.averaged.pixels.begin(), merged.averaged.pixels.end());
  }
  EXPECT_EQ(read_npy(path("hdr.npy")).to_floats(), depth_m);
  EXPECT_EQ(read_npy(path("hdr-averaged.npy")).to_floats(), averaged);
}

TEST_F(DecodeExposures, RejectsInvalidGroups) {
  const auto refused = [&](const std::vector<double>& hdr, int average, const char* words) {
    request_.hdr = hdr;
    request_.average = average;
    EXPECT_THAT([&] { decode_recording(request_, *backend_); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(words)));
  };
  refused({1.0, 2.0, 4.0, 8.0}, 1, "hdr = 4 exposures");  // of six frames
  refused({2.0, 4.0, 8.0}, 1, "hdr = 2; must contain 1");
  refused({1.0, 2.0, 4.0}, 3, "average = 3; cannot be combined with hdr");
  EXPECT_FALSE(std::filesystem::exists(path("hdr.npy")));
}

/// Two surfaces with mixed pixels between them.
RawFrames edge_seen(const ForwardModel& model, int height, int width) {
  RawFrames raw{.frames = 1,
                .height = height,
                .width = width,
                .measurements = model.measurements(),
                .values = {}};
  for (int i = 0; i < height * width; ++i) {
    const int x = i % width;
    const double near = x < width / 2 ? 1e5 : x == width / 2 ? 6e4 : 0.0;
    const std::array returns = {Return{near, 70.0}, Return{1e5 - near, 120.0}};
    for (const double e : model.expected_electrons(returns, 1e4))
      raw.values.push_back(static_cast<float>(e));
  }
  return raw;
}

/// A recording of one frame of `edge_seen()`.
class MixedRecording : public testing::Test {
 protected:
  MixedRecording() {
    request_.raw = {directory_ / "raw.npy"};
    request_.output = directory_ / "depth.npy";
    request_.policy = OutputPolicy::overwrite;
    write_raw_frames(request_.raw.front(), raw_, OutputPolicy::refuse_existing);
  }
  void expect_decoded(const Image<float>& expected) const {
    decode_recording(request_, *cpu_backend(make_decoder(DecodeMethod::zncc, table_)));
    const Image<float> depth = read_float_image(request_.output, "depth");
    ASSERT_EQ(depth.size(), expected.size());
    for (std::size_t i = 0; i < depth.size(); ++i)
      EXPECT_TRUE(depth.pixels[i] == expected.pixels[i] ||
                  (std::isnan(depth.pixels[i]) && std::isnan(expected.pixels[i])))
          << i;
  }

  const TemporaryDirectory directory_;
  const Camera camera_ = built_in_camera("paper-10f0");
  const ForwardModel model_{build_family("hamiltonian-k5", camera_), camera_};
  const DecodingTable table_ = make_decoding_table(model_, camera_);
  const Decoder decoder_{table_};
  const RawFrames raw_ = edge_seen(model_, 24, 31);
  DecodeRequest request_;
};

TEST_F(MixedRecording, FilesEqualTheMarkedFrameEvenIfOnlyDepthIsWritten) {
  for (const MixedPixels mixed : all_values<MixedPixels>) {
    DepthImage expected = decoder_.decode(raw_);
    EXPECT_GT(mark_mixed_pixels(table_, view_of_frame(raw_, 0), mixed, DecodedView::of(expected)),
              raw_.height - 3);
    request_.mixed = mixed;
    expect_decoded(expected.depth_m);
  }
}

TEST_F(MixedRecording, FilteredFramesAreFilteredAgainWithoutMixedPixels) {
  const RawView measured = view_of_frame(raw_, 0);
  const Filter filter(table_);
  FilteredFrame filtered;
  filter.apply(measured, filtered);
  DepthImage first(raw_.height, raw_.width);
  decoder_.decode(filtered.view(), DecodedView::of(first));
  UnfilteredPixels unfiltered{.measured = &measured};
  EXPECT_GT(mark_mixed_pixels(table_, filtered.view(), MixedPixels::label, DecodedView::of(first),
                              {}, {}, unfiltered),
            raw_.height - 3);
  unfiltered.mixed = Image<std::uint8_t>(raw_.height, raw_.width);
  for (std::size_t i = 0; i < first.status.size(); ++i)
    unfiltered.mixed.pixels[i] = first.status.pixels[i] == PixelStatus::mixed ? 1 : 0;
  filter.apply(measured, filtered, {}, unfiltered.mixed);

  request_.filter = FilterOptions();
  for (const MixedPixels mixed : all_values<MixedPixels>) {
    DepthImage expected(raw_.height, raw_.width);
    decoder_.decode(filtered.view(), DecodedView::of(expected));
    mark_mixed_pixels(table_, filtered.view(), mixed, DecodedView::of(expected), {}, {},
                      unfiltered);
    request_.mixed = mixed;
    expect_decoded(expected.depth_m);
  }
}

using testing::Contains;
using testing::Not;

class OffsetNotes : public DecodeRecording {
 protected:
  /// Notes on a camera with a playback offset and an offset map of one value per column.
  std::vector<std::string> notes(double playback_m, std::vector<float> columns_m,
                                 double offset_m = 0.0) {
    camera_.playback = Playback{.offset_m = playback_m};
    Image<float> map(6, 5);
    for (std::size_t i = 0; i < map.size(); ++i) map.pixels[i] = columns_m[i % 5];
    write_float_image(path("map.npy"), map, "offset", OutputPolicy::overwrite);
    DecodeRequest request = this->request("d.npz");
    request.policy = OutputPolicy::overwrite;
    request.offset_map = path("map.npy");
    request.offset_m = offset_m;
    return decode_recording(request, *backend_of(camera_)).notes;
  }
};

TEST_F(OffsetNotes, ReportAConstantThatIsInTheMapAndInPlayback) {
  const auto sum = Contains(HasSubstr("their sum of 0.5 m is subtracted"));
  EXPECT_THAT(notes(0.25, {0.24F, 0.26F, 0.25F, 0.24F, 0.26F}), sum);
  EXPECT_THAT(notes(0.25, {0.0F, 0.0F, 0.0F, 0.0F, 0.0F}, 0.25), sum);
}

TEST_F(OffsetNotes, AcceptAMapOfDifferencesBetweenPixels) {
  const auto both = Contains(HasSubstr("[playback]"));
  EXPECT_THAT(notes(0.25, {-0.02F, 0.01F, 0.03F, -0.01F, 0.0F}), Not(both));
  EXPECT_THAT(notes(0.0, {0.24F, 0.26F, 0.25F, 0.24F, 0.26F}), Not(both));
}

PinholeView view_with(double k1) {
  return {.fx_px = 60.0,
          .fy_px = 62.0,
          .cx_px = 39.0,
          .cy_px = 30.5,
          .width = 80,
          .height = 60,
          .distortion = LensDistortion{DistortionModel::opencv, {k1, 0.0, 1e-3, -1e-3}}};
}

TEST(Undistortion, UsesTheNearestPixelOfTheRay) {
  const PinholeView view = view_with(-0.2);
  Image<std::int32_t> places(view.height, view.width);
  for (std::size_t i = 0; i < places.size(); ++i) places.pixels[i] = static_cast<std::int32_t>(i);
  Undistortion(view).apply(places, std::int32_t{-1});
  for (int row = 0; row < view.height; ++row)
    for (int column = 0; column < view.width; ++column) {
      const auto seen_at = view.pixel_of(view.ideal().ray(row, column));
      ASSERT_TRUE(seen_at);
      const int source = places(row, column);
      ASSERT_GE(source, 0);  // a barrel lens has a wider view than the pinhole
      EXPECT_LE(std::abs(source % view.width - seen_at->x()), 0.5);
      EXPECT_LE(std::abs(source / view.width - seen_at->y()), 0.5);
    }
}

TEST(Undistortion, APlanePerpendicularToTheAxisStaysFlat) {
  const PinholeView view = view_with(-0.2);
  const Undistortion undistortion(view);
  Image<float> depth_m = radial_from_z(Image<float>(view.height, view.width, 2.0f), view);
  undistortion.apply(depth_m, NAN);
  undistortion.turn_radial(depth_m);
  for (const float z_m : z_from_radial(depth_m, view.ideal()).pixels) EXPECT_NEAR(z_m, 2.0, 1e-6);
}

TEST(Undistortion, PixelsOutsideTheLensViewAreEmpty) {
  const PinholeView view = view_with(0.3);  // a pincushion lens has a narrower view
  Image<float> plane(view.height, view.width, 1.0f);
  Undistortion(view).apply(plane, NAN);
  EXPECT_TRUE(std::isnan(plane(0, 0)));
  EXPECT_EQ(plane(30, 39), 1.0f);
}

TEST(Undistortion, WithoutDistortionNothingChanges) {
  PinholeView view = view_with(0.0);
  view.distortion->coefficients = {0.0, 0.0, 0.0, 0.0};
  Image<float> depth_m(view.height, view.width);
  for (std::size_t i = 0; i < depth_m.size(); ++i) depth_m.pixels[i] = 1.0f + static_cast<float>(i);
  const Image<float> before = depth_m;
  const Undistortion undistortion(view);
  undistortion.apply(depth_m, NAN);
  undistortion.turn_radial(depth_m);
  EXPECT_EQ(depth_m.pixels, before.pixels);
}

TEST(CodeOfAFile, IsResampledToTheCamera) {
  const TemporaryDirectory directory;
  Camera camera = built_in_camera("paper-10f0");
  const CodeSet code = build_family("hamiltonian-k5", camera);
  for (const char* name : {"code.json", "code.npz"}) {
    const std::string file = directory.path() / name;
    write_code(file, code, OutputPolicy::refuse_existing);
    camera.samples = 2 * code.samples();
    const CodeSet fine = load_camera_code(file, camera);
    EXPECT_EQ(fine.samples(), camera.samples);
    const ForwardModel of_file(fine, camera),
        of_code(build_family("hamiltonian-k5", camera), camera);
    EXPECT_LT((of_file.correlation(100.5) - of_code.correlation(100.5)).norm(),
              1e-9 * of_code.correlation(100.5).norm())
        << name;
  }
}

TEST(TableOfACode, IsFineEnoughForAnyNumberOfSamples) {
  Camera camera = built_in_camera("paper-30x");
  for (const int samples : {8, 60, 1200}) {
    camera.samples = samples;
    const LoadedDecodingTable loaded = load_decoding_table("multifrequency-k5", camera);
    EXPECT_EQ(loaded.table.bin_count(), samples);
    EXPECT_EQ(furthest_turn_rad(loaded.table), 0.0);
    EXPECT_THAT(loaded.notes,
                testing::Not(testing::Contains(testing::HasSubstr("from row to row"))));
  }
}

}  // namespace

}  // namespace tofsmith

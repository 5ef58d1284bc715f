// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/recordings/decoded_output.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <string>

#include "decode_recording_fixture.hpp"
#include "temporary_directory.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/decode/merge_exposures.hpp"
#include "tofsmith/io/decode_recording.hpp"
#include "tofsmith/io/decoding_table_file.hpp"
#include "tofsmith/io/image_file.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/io/raw_frames.hpp"

namespace tofsmith {

namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// Two groups of three frames of 6 x 5 pixels.
class DecodeExposures : public testing::Test {
 protected:
  DecodeExposures() {
    raw_ = {.frames = 6, .height = 6, .width = 5, .measurements = 4, .values = {}};
    for (int i = 0; i < 6 * 6 * 5 * 4; ++i)
      raw_.values.push_back(1000.0F + static_cast<float>(i * 37 % 101));
    write_raw_frames(path("raw.npy"), raw_, OutputPolicy::refuse_existing);
    request_.raw = {path("raw.npy")};
    request_.output = path("hdr.npy");
    request_.hdr = {1.0, 2.0, 4.0};
    request_.stack = true;
  }
  std::filesystem::path path(const char* name) const { return directory_.path() / name; }

  TemporaryDirectory directory_;
  RawFrames raw_;
  DecodeRequest request_;
  std::unique_ptr<FrameBackend> backend_ = cpu_backend(
      make_decoder(DecodeMethod::zncc,
                   load_decoding_table("hamiltonian-k4", built_in_camera("paper-10f0")).table));
};

TEST_F(DecodeExposures, AreMergedLikeFramesInMemory) {
  request_.outputs = {DecodedPlane::depth, DecodedPlane::averaged};
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

DecodeRequest request_of(const RawFrames& raw, const std::string& name) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / name;
  std::filesystem::create_directories(folder);
  DecodeRequest request;
  request.raw = {folder / "raw.npy"};
  request.output = folder / "depth.npy";
  request.policy = OutputPolicy::overwrite;
  write_npy(request.raw.front(),
            NpyArray::of<float>(
                {static_cast<std::size_t>(raw.height), static_cast<std::size_t>(raw.width),
                 static_cast<std::size_t>(raw.measurements)},
                raw.values),
            OutputPolicy::overwrite);
  return request;
}

void expect_decoded(const DecodeRequest& request, const FrameBackend& backend,
                    const Image<float>& expected) {
  decode_recording(request, backend);
  const Image<float> depth = read_float_image(request.output, "depth");
  ASSERT_EQ(depth.size(), expected.size());
  for (std::size_t i = 0; i < depth.size(); ++i)
    EXPECT_TRUE(depth.pixels[i] == expected.pixels[i] ||
                (std::isnan(depth.pixels[i]) && std::isnan(expected.pixels[i])))
        << i;
}

TEST(MixedRecording, FilesEqualTheMarkedFrameEvenIfOnlyDepthIsWritten) {
  const Camera camera = built_in_camera("paper-10f0");
  const ForwardModel model(build_family("hamiltonian-k5", camera), camera);
  const DecodingTable table = make_decoding_table(model, camera);
  const RawFrames raw = edge_seen(model, 24, 31);
  DecodeRequest request = request_of(raw, "mixed_recording");
  const Decoder decoder(table);
  const std::unique_ptr<FrameBackend> backend =
      cpu_backend(make_decoder(DecodeMethod::zncc, table));
  for (const MixedPixels mixed : all_mixed_pixels) {
    DepthImage expected = decoder.decode(raw);
    EXPECT_GT(mark_mixed_pixels(table, view_of_frame(raw, 0), mixed, DecodedView::of(expected)),
              raw.height - 3);
    request.mixed = mixed;
    expect_decoded(request, *backend, expected.depth_m);
  }
}

TEST(MixedRecording, FilteredFramesAreFilteredAgainWithoutMixedPixels) {
  const Camera camera = built_in_camera("paper-10f0");
  const ForwardModel model(build_family("hamiltonian-k5", camera), camera);
  const DecodingTable table = make_decoding_table(model, camera);
  const RawFrames raw = edge_seen(model, 24, 31);
  const RawView measured = view_of_frame(raw, 0);
  const Decoder decoder(table);
  const Filter filter(table);
  FilteredFrame filtered;
  filter.apply(measured, filtered);
  DepthImage first(raw.height, raw.width);
  decoder.decode(filtered.view(), DecodedView::of(first));
  UnfilteredPixels unfiltered{.measured = &measured};
  EXPECT_GT(mark_mixed_pixels(table, filtered.view(), MixedPixels::label, DecodedView::of(first),
                              {}, {}, unfiltered),
            raw.height - 3);
  unfiltered.mixed = Image<std::uint8_t>(raw.height, raw.width);
  for (std::size_t i = 0; i < first.status.size(); ++i)
    unfiltered.mixed.pixels[i] = first.status.pixels[i] == PixelStatus::mixed ? 1 : 0;
  filter.apply(measured, filtered, {}, unfiltered.mixed);

  DecodeRequest request = request_of(raw, "mixed_and_filtered");
  request.filter = FilterOptions();
  for (const MixedPixels mixed : all_mixed_pixels) {
    DepthImage expected(raw.height, raw.width);
    decoder.decode(filtered.view(), DecodedView::of(expected));
    mark_mixed_pixels(table, filtered.view(), mixed, DecodedView::of(expected), {}, {}, unfiltered);
    request.mixed = mixed;
    expect_decoded(request, *cpu_backend(make_decoder(DecodeMethod::zncc, table)),
                   expected.depth_m);
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
    const auto backend = cpu_backend(
        make_decoder(DecodeMethod::zncc, load_decoding_table("hamiltonian-k4", camera_).table));
    Image<float> map(6, 5);
    for (std::size_t i = 0; i < map.size(); ++i) map.pixels[i] = columns_m[i % 5];
    write_float_image(path("map.npy"), map, "offset", OutputPolicy::overwrite);
    DecodeRequest request = this->request("d.npz");
    request.policy = OutputPolicy::overwrite;
    request.offset_map = path("map.npy");
    request.offset_m = offset_m;
    return decode_recording(request, *backend).notes;
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

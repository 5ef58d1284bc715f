// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <span>

#include "decode_recording_fixture.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

using testing::Each;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// The windows of `exposures` consecutive exposures, as frames in the order of the code.
RawFrames windows_as_frames(const RawFrames& raw, int exposures) {
  const auto measurements = static_cast<std::size_t>(raw.measurements);
  const std::size_t per_exposure = measurements / static_cast<std::size_t>(exposures);
  RawFrames windows = raw;
  windows.frames = (raw.frames - 1) * exposures + 1;
  windows.values.clear();
  for (int window = 0; window < windows.frames; ++window)
    for (std::size_t pixel = 0; pixel < raw.pixels_per_frame(); ++pixel)
      for (int exposure = 0; exposure < exposures; ++exposure) {
        // Newest frame whose exposure of this kind is in the window.
        const int frame = (window + exposures - 1 - exposure) / exposures;
        const float* const first = raw.frame(frame) + pixel * measurements +
                                   static_cast<std::size_t>(exposure) * per_exposure;
        windows.values.insert(windows.values.end(), first, first + per_exposure);
      }
  return windows;
}

class SlidingRecording : public DecodeRecording {
 protected:
  /// A stack of depth and deviation of 6 x 5 pixels.
  DecodeRequest stack(const char* raw, const char* output) const {
    DecodeRequest request =
        DecodeRecording::stack(output, {DecodedPlane::depth, DecodedPlane::deviation});
    request.raw = {path(raw)};
    request.policy = OutputPolicy::overwrite;
    return request;
  }
  DecodeRequest sliding(const char* raw, const char* output) const {
    DecodeRequest request = stack(raw, output);
    request.sliding = true;
    return request;
  }
  /// Decodes both ways, and expects the windows as frames to be the sliding windows.
  void expect_windows(const RawFrames& raw, int exposures, const FrameBackend& backend) {
    write_raw_frames(path("frames.npy"), raw, OutputPolicy::overwrite);
    write_raw_frames(path("windows.npy"), windows_as_frames(raw, exposures),
                     OutputPolicy::overwrite);
    const std::size_t count = static_cast<std::size_t>((raw.frames - 1) * exposures + 1);
    EXPECT_EQ(decode_recording(sliding("frames.npy", "s.npy"), backend).frames.size(), count);
    decode_recording(stack("windows.npy", "w.npy"), backend);
    decode_recording(stack("frames.npy", "f.npy"), backend);
    for (const char* suffix : {"", "-deviation"})
      for (std::size_t i = 0; i < count; ++i) {
        const auto of = [&](const char* name, std::size_t frame) {
          return plane((std::string(name) + suffix + ".npy").c_str(), frame);
        };
        EXPECT_THAT(of("s", i), testing::Pointwise(testing::NanSensitiveFloatEq(), of("w", i)));
        if (i % static_cast<std::size_t>(exposures) == 0) {
          const std::size_t frame = i / static_cast<std::size_t>(exposures);
          EXPECT_THAT(of("s", i),
                      testing::Pointwise(testing::NanSensitiveFloatEq(), of("f", frame)));
        }
      }
  }
};

Camera phase_camera(int taps, Readout readout) {
  Camera camera = built_in_camera("paper-10f0");
  camera.sensor.taps = taps;
  camera.sensor.readout = readout;
  camera.sensor.drain = taps == 1;
  return camera;
}

TEST_F(SlidingRecording, WindowsDecodeAsFramesOfTheirExposures) {
  expect_windows(raw_, 4, *backend_);
  RawFrames one = raw_;
  one.frames = 1;
  one.values.resize(one.values.size() / 3);
  expect_windows(one, 4, *backend_);
}

TEST_F(SlidingRecording, WindowsMoveByAllTapsOfAnExposure) {
  expect_windows(raw_, 4, *backend_of(phase_camera(2, Readout::difference), "sinusoid-k4"));
  RawFrames two_taps = raw_;
  two_taps.measurements = 8;
  two_taps.values.insert(two_taps.values.end(), raw_.values.rbegin(), raw_.values.rend());
  expect_windows(two_taps, 4, *backend_of(phase_camera(2, Readout::separate), "sinusoid-k4"));
}

TEST_F(SlidingRecording, WindowsOfOneExposureAreTheFrames) {
  MeasuredTable measured{.correlation = Eigen::MatrixXd(60, 4), .taps = 4};
  for (int n = 0; n < 60; ++n)
    for (int k = 0; k < 4; ++k)
      measured.correlation(n, k) = 1.0 + std::cos(2.0 * std::numbers::pi * (n / 60.0 - k / 4.0));
  expect_windows(
      raw_, 1,
      *cpu_backend(make_decoder(DecodeMethod::zncc, make_decoding_table(measured, camera_))));
}

TEST_F(SlidingRecording, AWindowIsTheSameAlone) {
  for (const bool in_time : {false, true}) {
    DecodeRequest all = sliding("raw.npy", "all.npy"), one = sliding("raw.npy", "one.npy");
    if (in_time)
      all.time_filter = one.time_filter = TimeFilterOptions{.max_difference_sigma = 20.0};
    decode_recording(all, *backend_);
    for (const int window : {0, 3, 4, 6, 8}) {
      one.frame = window;
      const DecodedRecording result = decode_recording(one, *backend_);
      EXPECT_EQ(result.first_frame, window);
      EXPECT_EQ(plane("one.npy", 0), plane("all.npy", static_cast<std::size_t>(window)));
    }
  }
}

TEST_F(SlidingRecording, TheTimeFilterAveragesWindowsThatShareNoExposure) {
  DecodeRequest filtered = sliding("raw.npy", "s.npy");
  filtered.time_filter = TimeFilterOptions{.max_difference_sigma = 20.0};
  filtered.outputs = {DecodedPlane::depth, DecodedPlane::averaged};
  decode_recording(filtered, *backend_);
  const RawFrames windows = windows_as_frames(raw_, 4);
  const DepthDecoder& decoder = backend_->decoder();
  for (int phase = 0; phase < 4; ++phase) {
    TimeFilter filter(decoder.table(), *filtered.time_filter);
    for (int window = phase; window < windows.frames; window += 4) {
      const RawView mean = *filter.add(view_of_frame(windows, window));
      Image<float> depth_m(6, 5);
      decoder.decode(mean, {.depth_m = depth_m.pixels.data()}, {});
      EXPECT_EQ(plane("s.npy", static_cast<std::size_t>(window)), depth_m.pixels);
      EXPECT_EQ(plane("s-averaged.npy", static_cast<std::size_t>(window)),
                std::vector<float>(mean.averaged, mean.averaged + 6 * 5));
    }
  }
}

/// Four phases of a surface whose left half moves from frame 0 to frame 1 and then rests.
RawFrames moving_surface(double phase_change) {
  RawFrames raw{.frames = 3, .height = 6, .width = 5, .measurements = 4};
  for (int f = 0; f < 3; ++f)
    for (int i = 0; i < 6 * 5; ++i) {
      const double phase = 0.3 + 0.02 * i + (i % 5 < 2 && f > 0 ? phase_change : 0.0);
      for (int k = 0; k < 4; ++k)
        raw.values.push_back(
            static_cast<float>(1e5 * std::cos(phase - k * std::numbers::pi / 2.0)));
    }
  return raw;
}

TEST_F(SlidingRecording, SurfacesThatMoveWithinAWindowAreInconsistent) {
  Camera camera = phase_camera(2, Readout::difference);
  const auto backend = backend_of(camera, "sinusoid-k4");
  write_raw_frames(path("moving.npy"), moving_surface(0.5), OutputPolicy::overwrite);
  write_raw_frames(path("still.npy"), moving_surface(0.0), OutputPolicy::overwrite);
  const auto inconsistent = [&](const char* raw) {
    DecodeRequest request = sliding(raw, "d.npy");
    request.outputs = {DecodedPlane::depth, DecodedPlane::status};
    std::vector<std::int64_t> counts;
    for (const StatusCounts& window : decode_recording(request, *backend).frames)
      counts.push_back(window.of(PixelStatus::inconsistent));
    return counts;
  };
  EXPECT_THAT(inconsistent("still.npy"), Each(0));
  // Windows 1 to 3 have exposures of both frames; two of five columns move.
  EXPECT_EQ(inconsistent("moving.npy"), (std::vector<std::int64_t>{0, 12, 12, 12, 0, 0, 0, 0, 0}));
  // Inconsistent windows are compared with a frame of the recording, which has fewer than windows.
  DecodeRequest third = sliding("moving.npy", "d.npy");
  third.outputs = {DecodedPlane::depth, DecodedPlane::status};
  third.frame = 3;
  EXPECT_EQ(decode_recording(third, *backend).total().of(PixelStatus::inconsistent), 12);
}

TEST_F(SlidingRecording, RejectsMeansMergedExposuresAndLookAhead) {
  const auto rejects = [&](const auto& change, const char* field) {
    DecodeRequest request = sliding("raw.npy", "d.npy");
    change(request);
    EXPECT_THAT([&] { decode_recording(request, *backend_); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(field)));
  };
  rejects([](DecodeRequest& r) { r.average = 2; }, "average = 2; is not valid with sliding");
  rejects([](DecodeRequest& r) { r.averaged = 3.0; }, "averaged = 3; is not valid with sliding");
  rejects([](DecodeRequest& r) { r.hdr = {1.0, 4.0, 16.0}; }, "hdr = 3 exposures");
  rejects([](DecodeRequest& r) { r.time_filter = TimeFilterOptions{.look_ahead = 1}; },
          "look_ahead = 1");
  rejects([](DecodeRequest& r) { r.frame = 9; }, "contains 3 frames, 9 windows");
}

class DecodeStream : public DecodeRecording {
 protected:
  DecodeStream() {
    std::ofstream(path("s.raw.toml")) << "width = 5\nheight = 6\nmeasurements = 4\nbits = 32\n"
                                         "numbers = \"float\"\nlayout = \"interleaved\"\n"
                                         "header_bytes = 3\n";
    const auto bytes = std::as_bytes(std::span(raw_.values));
    stream_.assign(3, std::byte{7});
    stream_.insert(stream_.end(), bytes.begin(), bytes.end());
    std::ofstream(path("dump.bin"), std::ios::binary)
        .write(reinterpret_cast<const char*>(stream_.data()), std::ssize(stream_));
  }

  /// Decodes the first `bytes` of the stream. Each frame is written before the next one is read,
  /// apart from the look-ahead of a time filter.
  DecodedStream run(DecodeRequest request, std::size_t bytes) {
    request.raw_format = path("s.raw.toml");
    std::size_t at = 0;
    written_.clear();
    DecodedStream result;
    const ReadStream stream = stream_of(std::span(stream_).first(bytes), at);
    const ReadStream read = [&](std::span<std::byte> into) {
      const std::size_t frames = at < 3 ? 0 : (at - 3) / (6 * 5 * 4 * sizeof(float));
      const std::size_t waiting =
          request.time_filter ? static_cast<std::size_t>(request.time_filter->look_ahead) : 0;
      if (request.average == 1 && !request.sliding) {
        EXPECT_EQ(result.frames, static_cast<std::int64_t>(frames - std::min(frames, waiting)));
      }
      return stream(into);
    };
    const WriteStream write = [&](std::span<const std::byte> bytes_of_plane) {
      written_.insert(written_.end(), bytes_of_plane.begin(), bytes_of_plane.end());
    };
    decode_stream(request, *backend_, read, write, {}, result);
    return result;
  }
  std::vector<std::byte> of_files(DecodeRequest request) {
    request.raw = {path("dump.bin")};
    request.raw_format = path("s.raw.toml");
    request.output = path("stack.npy");
    request.stack = true;
    request.policy = OutputPolicy::overwrite;
    const DecodedRecording result = decode_recording(request, *backend_);
    std::vector<std::byte> bytes;
    for (std::size_t frame = 0; frame < result.frames.size(); ++frame)
      for (const std::filesystem::path& file : result.files) {
        const NpyArray array = read_npy(file);
        const std::size_t size = array.bytes().size() / result.frames.size();
        const auto part = array.bytes().subspan(frame * size, size);
        bytes.insert(bytes.end(), part.begin(), part.end());
      }
    return bytes;
  }

  std::vector<std::byte> stream_, written_;
};

TEST_F(DecodeStream, GivesTheBytesOfFilesFrameByFrame) {
  DecodeRequest plain, filtered, means, ahead;
  ahead.outputs = {DecodedPlane::depth};
  plain.outputs = {DecodedPlane::depth, DecodedPlane::status};
  filtered.outputs = {DecodedPlane::depth, DecodedPlane::bin};
  filtered.filter = FilterOptions{};
  filtered.time_filter = TimeFilterOptions{};
  filtered.offset_m = 0.5;
  means.outputs = {DecodedPlane::signal};
  means.average = 2;
  for (const int frames : {1, 2, 7}) {
    ahead.time_filter = TimeFilterOptions{.look_ahead = frames};
    EXPECT_EQ(run(ahead, stream_.size()).frames, 3);
    EXPECT_EQ(written_, of_files(ahead));
  }
  for (const DecodeRequest& request : {plain, filtered, means}) {
    const DecodedStream result = run(request, stream_.size());
    EXPECT_EQ(result.frames, request.average == 2 ? 2 : 3);
    EXPECT_EQ(written_, of_files(request));
  }
  EXPECT_EQ(run(plain, stream_.size()).statuses.pixels(), 3 * 6 * 5);
  run({}, stream_.size());
  DecodeRequest depth;
  depth.outputs = {DecodedPlane::depth};
  EXPECT_EQ(written_, of_files(depth)) << "depth, if nothing is asked for";
}

TEST_F(DecodeStream, GivesTheBytesOfSlidingWindows) {
  DecodeRequest request;
  request.sliding = true;
  request.outputs = {DecodedPlane::depth, DecodedPlane::status};
  for (const bool in_time : {false, true}) {
    if (in_time) request.time_filter = TimeFilterOptions{};
    EXPECT_EQ(run(request, stream_.size()).frames, 2 * 4 + 1);
    EXPECT_EQ(written_, of_files(request));
  }
}

TEST_F(DecodeStream, GivesAnImageAfterEachExposureOfPlanarFrames) {
  const std::size_t image = 6 * 5 * sizeof(float);
  std::vector<std::byte> planar;
  for (int f = 0; f < 3; ++f)
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t i = 0; i < 6 * 5; ++i) {
        const auto bytes = std::as_bytes(std::span(raw_.frame(f) + 4 * i + k, 1));
        planar.insert(planar.end(), bytes.begin(), bytes.end());
      }
  std::ofstream(path("p.raw.toml")) << "width = 5\nheight = 6\nmeasurements = 4\nbits = 32\n"
                                       "numbers = \"float\"\nlayout = \"planar\"\n";
  DecodeRequest request;
  request.sliding = true;
  request.outputs = {DecodedPlane::depth};
  const std::vector<std::byte> expected = of_files(request);
  request.raw_format = path("p.raw.toml");
  std::size_t at = 0;
  std::vector<std::byte> written;
  std::vector<std::size_t> images_read;  // before each image that comes out
  const WriteStream write = [&](std::span<const std::byte> plane) {
    images_read.push_back(at / image);
    written.insert(written.end(), plane.begin(), plane.end());
  };
  DecodedStream result;
  decode_stream(request, *backend_, stream_of(planar, at), write, {}, result);
  EXPECT_EQ(images_read, (std::vector<std::size_t>{4, 5, 6, 7, 8, 9, 10, 11, 12}));
  EXPECT_EQ(written, expected);
}

TEST_F(DecodeStream, SupportsRotatedImagesAndTrailers) {
  std::ofstream(path("s.raw.toml"), std::ios::app)
      << "rotate_deg = 90\nnegate_rows = \"odd\"\ntrailer_bytes = 2\n";
  stream_.resize(stream_.size() + 2);
  std::ofstream(path("dump.bin"), std::ios::app | std::ios::binary) << "  ";
  DecodeRequest request;
  request.outputs = {DecodedPlane::depth, DecodedPlane::status};
  const DecodedStream result = run(request, stream_.size());
  EXPECT_EQ(result.frames, 3);
  EXPECT_EQ(result.height, 5);
  EXPECT_EQ(result.width, 6);
  EXPECT_EQ(written_, of_files(request));
}

TEST_F(DecodeStream, KeepsTheFramesBeforeATruncation) {
  const std::size_t frame = 6 * 5 * 4 * sizeof(float);
  EXPECT_THAT([&] { run({}, 3 + 2 * frame + 7); },
              ThrowsMessage<IoError>(AllOf(HasSubstr("found 7 bytes and the end"),
                                           HasSubstr("expected 480 of frame 2"))));
  EXPECT_EQ(written_.size(), 2 * 6 * 5 * sizeof(float));
  EXPECT_THAT([&] { run({}, 3); }, ThrowsMessage<IoError>(HasSubstr("frame 0")));
  EXPECT_THAT([&] { run({}, 2); }, ThrowsMessage<IoError>(HasSubstr("header")));
  DecodeRequest stack;
  stack.stack = true;
  EXPECT_THAT([&] { run(stack, 3); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("is only valid with files")));
}

}  // namespace

}  // namespace tofsmith

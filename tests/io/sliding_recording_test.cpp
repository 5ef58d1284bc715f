// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

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
  /// A stack of depth, deviation and status of 6 x 5 pixels.
  DecodeRequest stack(const char* raw, const char* output) const {
    DecodeRequest request = this->request(output);
    request.raw = {path(raw)};
    request.stack = true;
    request.outputs = {DecodedPlane::depth, DecodedPlane::deviation};
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

std::unique_ptr<FrameBackend> backend_of(const Camera& camera, const char* code) {
  return cpu_backend(make_decoder(DecodeMethod::zncc, load_decoding_table(code, camera).table));
}

Camera phase_camera(int taps, Readout readout) {
  Camera camera = built_in_camera("paper-10f0");
  camera.sensor.taps = taps;
  camera.sensor.readout = readout;
  camera.sensor.drain = taps == 1;
  return camera;
}

TEST_F(SlidingRecording, WindowsDecodeAsFramesOfTheirExposures) {
  expect_windows(raw_, 4, *backend_);
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

TEST_F(SlidingRecording, ASingleFrameIsOneWindow) {
  RawFrames one = raw_;
  one.frames = 1;
  one.values.resize(one.values.size() / 3);
  expect_windows(one, 4, *backend_);
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

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Devices that fail half-way.
#if __has_include(<CL/cl.h>)
#include "device_setup.hpp"
#include "rows_setup.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/simulate/depth_error.hpp"
#include "watched_opencl.hpp"

namespace tofsmith {
namespace {

/// A frame, and what the processor makes of it.
class FailingDevice : public OnDevice {
 protected:
  static constexpr int height = 90, width = 30;

  FailingDevice()
      : setup_("hamiltonian-k4", camera_with("paper-10f0")),
        filter_(setup_.decoder.table()),
        raw_(noisy_pixels(setup_.decoder.table(), 1e5, 1e4, height * width, 3)),
        expected_(raw_.size() / 4) {
    setup_.decoder.decode(filter_.apply(frame(), 0).view(), expected_.view());
  }
  void SetUp() override {
    OnDevice::SetUp();
    failure = {};
  }
  void TearDown() override { failure = {}; }

  RawFrames frame() const {
    return {.frames = 1, .height = height, .width = width, .measurements = 4, .values = raw_};
  }
  RawView view() const { return RawView::interleaved(raw_.data(), height, width, 4); }
  /// Filters and decodes a frame on the device. @return whether the device failed
  bool fails(const DeviceFilter& filter, const DeviceDecoder& decoder, Outputs& outputs) const {
    try {
      filter.decode(view(), decoder, outputs.view());
      return false;
    } catch (const IoError& error) {
      EXPECT_NE(std::string(error.what()).find(device().info().name), std::string::npos);
      return true;
    }
  }

  DecodeSetup setup_;
  Filter filter_;
  std::vector<float> raw_;
  Outputs expected_;
};

TEST_F(FailingDevice, IsAnErrorWhereverItFailsAndWorksAgainWhenItIsBack) {
  for (const cl_int error : {CL_DEVICE_NOT_AVAILABLE, CL_INVALID_COMMAND_QUEUE})
    for (int first = 0;; first += first < 25 ? 1 : 7) {
      const DeviceDecoder decoder(device(), setup_.decoder);
      const DeviceFilter filter(device(), filter_);
      Outputs outputs(expected_.bin.size());
      failure = {.first = first, .error = error};
      const bool has_failed = fails(filter, decoder, outputs);
      const int calls = failure.calls;
      failure = {};
      EXPECT_FALSE(has_failed && fails(filter, decoder, outputs)) << first;
      expect_alike(device().info(), true, outputs, expected_, 1e6);
      EXPECT_EQ(has_failed, first < calls);
      if (!has_failed) break;
    }
}

TEST_F(FailingDevice, ForgetsFramesThatItAddedUpAndStartsAnewWhenItIsBack) {
  const DeviceDecoder decoder(device(), setup_.decoder);
  for (const int look_ahead : {0, 2}) {
    const TimeFilter time_filter(setup_.decoder.table(),
                                 {.before_filter = true, .look_ahead = look_ahead});
    DeviceFrames frames(device(), setup_.decoder.table(), &time_filter);
    const auto add_up = [&](Outputs& outputs) {
      frames.forget();
      frames.take(view());
      if (device().info().has_doubles) {
        frames.add(view());
        frames.add(view());
        frames.take_mean();
      } else {
        frames.take(view());
      }
      for (int waits = 0; waits < look_ahead; ++waits) EXPECT_TRUE(frames.take_end());
      frames.decode(decoder, outputs.view());
    };
    Outputs expected(expected_.bin.size());
    add_up(expected);
    for (const cl_int error :
         {CL_DEVICE_NOT_AVAILABLE, CL_OUT_OF_RESOURCES, CL_MEM_OBJECT_ALLOCATION_FAILURE})
      for (int first = 0;; ++first) {
        Outputs outputs(expected.bin.size());
        failure = {.first = first, .error = error};
        bool has_failed = false;
        try {
          add_up(outputs);
        } catch (const IoError& lost) {
          EXPECT_NE(std::string(lost.what()).find(device().info().name), std::string::npos);
          has_failed = true;
        }
        ASSERT_EQ(has_failed, failure.calls > first);
        failure = {};
        if (!has_failed) break;
        add_up(outputs);
        expect_same(outputs, expected);
      }
  }
}

TEST_F(FailingDevice, HasNoFrameWaitingWhereOneWasLost) {
  const TimeFilter time_filter(setup_.decoder.table(), {.look_ahead = 2});
  DeviceFrames frames(device(), setup_.decoder.table(), &time_filter);
  const auto expect_none = [&] {
    EXPECT_FALSE(frames.has_frame());
    failure = {};
    EXPECT_FALSE(frames.take_end());
  };
  frames.take(view());
  frames.take(view());
  failure = {.first = 0, .error = CL_DEVICE_NOT_AVAILABLE};
  EXPECT_THROW(frames.take_end(), IoError);
  expect_none();
  frames.take(view());
  frames.take(view());
  failure = {.first = 9, .error = CL_DEVICE_NOT_AVAILABLE};
  EXPECT_THROW(frames.take(view()), IoError);
  expect_none();
}

TEST_F(FailingDevice, HasNoFrameWhereOneWasLost) {
  const TimeFilter time_filter(setup_.decoder.table());
  DeviceFrames frames(device(), setup_.decoder.table(), &time_filter);
  frames.take(view());
  EXPECT_TRUE(frames.has_frame());
  failure = {.first = 0, .error = CL_DEVICE_NOT_AVAILABLE};
  EXPECT_THROW(frames.take(view()), IoError);
  EXPECT_THROW(DeviceFrames(device(), setup_.decoder.table(), &time_filter), IoError);
  failure = {};
  EXPECT_FALSE(frames.has_frame());
  EXPECT_THROW(frames.numbers(), InvalidArgument);
  frames.take(view());  // the first again, which comes as it is
  const RawView first = frames.numbers();
  std::vector<float> numbers(raw_.size());
  copy_pixels(first, 0, first.pixels(), numbers.data());
  EXPECT_EQ(numbers, raw_);
}

TEST_F(FailingDevice, DecodesWhatItDecodedInPartsWhereverItFails) {
  setup_.decoder.decode(view(), expected_.view());
  const DeviceDecoder decoder(device(), setup_.decoder, {.memory_mb = 1e-3});
  for (const cl_int error : {CL_DEVICE_NOT_AVAILABLE, CL_OUT_OF_RESOURCES})
    for (int first = 0;; ++first) {
      Outputs outputs(expected_.bin.size());
      failure = {.first = first, .last = first, .error = error};
      bool has_failed = false;
      try {
        decoder.decode(view(), outputs.view());
      } catch (const IoError&) {
        has_failed = true;
      }
      ASSERT_EQ(has_failed, failure.calls > first);
      if (!has_failed) break;
      failure = {};
      decoder.decode(view(), outputs.view());
      expect_alike(device().info(), true, outputs, expected_, 1e6);
    }
}

TEST_F(FailingDevice, ThatLacksMemoryOnceHasTheRestInParts) {
  for (const cl_int error : {CL_MEM_OBJECT_ALLOCATION_FAILURE, CL_OUT_OF_RESOURCES})
    for (int call = 0; call < 60; call += call < 25 ? 1 : 7) {
      const DeviceDecoder decoder(device(), setup_.decoder);
      const DeviceFilter filter(device(), filter_);
      Outputs outputs(expected_.bin.size());
      failure = {.first = call, .last = call, .error = error};
      EXPECT_FALSE(fails(filter, decoder, outputs)) << call;
      failure = {};
      expect_alike(device().info(), true, outputs, expected_, 1e6);
    }
}

/// A scene and what the processor captures of it.
class FailingCapture : public FailingDevice {
 protected:
  FailingCapture() : scene_(height, width) {
    RandomStream random(1, 0);
    for (float& depth_m : scene_.depth_m.pixels)
      depth_m = static_cast<float>(1.0 + 8.0 * random.uniform());
    longer_.tail = ExponentialTail{1.0, 0.3};
  }
  void SetUp() override {
    FailingDevice::SetUp();
    if (!IsSkipped() && !device().info().has_doubles) GTEST_SKIP() << "the device has no doubles";
  }

  /// Of direct light, and of light that is collected before.
  RawFrames captured(bool is_direct, const ExposeBy& expose_by) const {
    return capture(scene_, is_direct ? SceneLight() : longer_, code_, setup_.camera, {.frames = 2},
                   {}, expose_by);
  }
  /// Nothing where the device failed.
  std::optional<RawFrames> tried(bool is_direct, const DeviceCapture& there) const {
    try {
      return captured(is_direct, there.expose_by());
    } catch (const IoError& error) {
      EXPECT_NE(std::string(error.what()).find(device().info().name), std::string::npos);
      return std::nullopt;
    }
  }

  CodeSet code_ = build_family("hamiltonian-k4", setup_.camera);
  SceneImage scene_;
  SceneLight longer_;
};

TEST_F(FailingCapture, IsAnErrorWhereverItFailsAndWorksAgainWhenItIsBack) {
  for (const bool is_direct : {true, false}) {
    const std::vector<float> expected = captured(is_direct, {}).values;
    for (const cl_int error : {CL_DEVICE_NOT_AVAILABLE, CL_INVALID_COMMAND_QUEUE})
      for (int first = 0;; ++first) {
        const DeviceCapture there(device(), {.memory_mb = 1e-3});
        failure = {.first = first, .error = error};
        const std::optional<RawFrames> made = tried(is_direct, there);
        ASSERT_EQ(made.has_value(), failure.calls <= first);
        failure = {};
        EXPECT_EQ(captured(is_direct, there.expose_by()).values, expected) << first;
        if (made) break;
      }
  }
}

TEST_F(FailingCapture, ThatLacksMemoryOnceHasTheRestInParts) {
  for (const bool is_direct : {true, false}) {
    const std::vector<float> expected = captured(is_direct, {}).values;
    for (const cl_int error : {CL_MEM_OBJECT_ALLOCATION_FAILURE, CL_OUT_OF_RESOURCES})
      for (int call = 0;; ++call) {
        const DeviceCapture there(device());
        failure = {.first = call, .last = call, .error = error};
        const std::optional<RawFrames> made = tried(is_direct, there);
        ASSERT_TRUE(made) << call;
        EXPECT_EQ(made->values, expected) << call;
        if (failure.calls <= call) break;
      }
  }
}

TEST_F(FailingCapture, ThatLacksMemoryForAllIsAnError) {
  const DeviceCapture there(device());
  failure = {.first = 0, .error = CL_OUT_OF_RESOURCES};
  EXPECT_FALSE(tried(true, there));
  failure = {.first = 0, .error = CL_DEVICE_NOT_AVAILABLE};
  EXPECT_FALSE(tried(true, there));
  failure = {};
  EXPECT_EQ(tried(true, there)->values, captured(true, {}).values);
}

/// Trials in the plane that ZNCC looks at, of counts and of rows, and what the processor finds.
class FailingTrials : public FailingDevice {
 protected:
  void SetUp() override {
    FailingDevice::SetUp();
    if (!IsSkipped() && !device().info().has_doubles) GTEST_SKIP() << "the device has no doubles";
  }

  struct Kind {
    CodeSet code;
    Camera camera;
    double expected_m;
  };
  static Kind kind_of(const char* code, Camera camera) {
    CodeSet built = build_family(code, camera);
    const double expected_m = evaluate(built, camera, options).linear.geometric_mean_m.value;
    return {std::move(built), std::move(camera), expected_m};
  }
  static std::vector<Kind> kinds() {
    Camera camera = camera_with("paper-10f0");
    camera.operating.signal_e_per_s = {1e5};
    camera.operating.ambient_e_per_s = {1e4};
    Camera counts = camera, rows = rows_camera();
    counts.sensor.noise = rows.sensor.noise = NoiseModel::poisson;
    counts.sensor.adc_bits = 12;
    counts.sensor.gain_e_per_dn = 4.0;
    std::vector<Kind> kinds;
    kinds.push_back(kind_of("hamiltonian-k4", camera));
    kinds.push_back(kind_of("hamiltonian-k4", counts));
    kinds.push_back(kind_of("fourier-k5", rows));
    return kinds;
  }

  /// Nothing where the device failed.
  std::optional<DepthErrorReport> tried(const Kind& kind, const DeviceTrials& there) const {
    try {
      return evaluate(kind.code, kind.camera, options, {}, there.trials_by());
    } catch (const IoError& error) {
      EXPECT_NE(std::string(error.what()).find(device().info().name), std::string::npos);
      return std::nullopt;
    }
  }
  void expect_right(const Kind& kind, const DepthErrorReport& report) const {
    const double rounding = device().info().divides_as_processor ? 0.0 : 1e-6;
    EXPECT_NEAR(report.linear.geometric_mean_m.value, kind.expected_m, rounding * kind.expected_m);
  }

  static constexpr EvaluateOptions options{.trials = 2500, .bounds = false};
};

TEST_F(FailingTrials, AreAnErrorWhereverItFailsAndRunAgainWhenItIsBack) {
  const DeviceTrials there(device(), {.memory_mb = 1e-3});
  for (const Kind& kind : kinds())
    for (const cl_int error : {CL_DEVICE_NOT_AVAILABLE, CL_INVALID_COMMAND_QUEUE})
      for (int first = 0;; ++first) {
        failure = {.first = first, .error = error};
        const std::optional<DepthErrorReport> made = tried(kind, there);
        ASSERT_EQ(made.has_value(), failure.calls <= first);
        failure = {};
        if (first % 8 == 0 || made) expect_right(kind, *tried(kind, there));
        if (made) break;
      }
}

TEST_F(FailingTrials, ThatLackMemoryOnceAreRunInPartsOrAnError) {
  const DeviceTrials there(device());
  for (const Kind& kind : kinds())
    for (const cl_int error : {CL_MEM_OBJECT_ALLOCATION_FAILURE, CL_OUT_OF_RESOURCES}) {
      int failed = 0;
      for (int call = 0;; ++call) {
        failure = {.first = call, .last = call, .error = error};
        const std::optional<DepthErrorReport> made = tried(kind, there);
        if (made) expect_right(kind, *made);
        failed += made ? 0 : 1;
        if (failure.calls <= call) break;
      }
      EXPECT_LE(failed, 8);  // the tables', without which there is no trial
      failure = {.first = 0, .error = error};
      EXPECT_FALSE(tried(kind, there));
      failure = {};
    }
}

TEST_F(FailingDevice, ThatLacksMemoryForAllIsAnError) {
  const DeviceDecoder decoder(device(), setup_.decoder);
  const DeviceFilter filter(device(), filter_);
  Outputs outputs(expected_.bin.size());
  failure = {.first = 0, .error = CL_OUT_OF_RESOURCES};
  EXPECT_TRUE(fails(filter, decoder, outputs));
  EXPECT_THROW(decoder.decode(view(), outputs.view()), IoError);
  failure = {.first = 0, .error = CL_DEVICE_NOT_AVAILABLE};
  EXPECT_THROW(DeviceFilter(device(), filter_), IoError);
  EXPECT_THROW(DeviceDecoder(device(), setup_.decoder), IoError);
}

}  // namespace
}  // namespace tofsmith
#endif

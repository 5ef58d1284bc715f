// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Devices that fail half-way.
#if __has_include(<CL/cl.h>)
#include "device_setup.hpp"
#include "tofsmith/core/error.hpp"
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

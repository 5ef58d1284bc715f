// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Devices that fail half-way, with one injected failure per stage.
#if __has_include(<CL/cl.h>)
#include <functional>

#include "device_setup.hpp"
#include "tofsmith/core/error.hpp"
#include "watched_opencl.hpp"

namespace tofsmith {
namespace {

class FailingDevice : public OnDevice {
 protected:
  static constexpr int height = 90, width = 30, pixels = height * width;
  using Work = std::function<void(Outputs& outputs)>;

  void SetUp() override {
    OnDevice::SetUp();
    failure = {};
  }
  void TearDown() override { failure = {}; }

  RawView view() const { return RawView::interleaved(raw_.data(), height, width, 4); }

  static Outputs outputs_of(const Work& work) {
    Outputs outputs(static_cast<std::size_t>(height) * width);
    work(outputs);
    return outputs;
  }
  /// The error must contain the name of the device.
  void expect_failure(const Work& work) const {
    try {
      outputs_of(work);
      FAIL() << "no error";
    } catch (const IoError& error) {
      EXPECT_NE(std::string(error.what()).find(device().info().name), std::string::npos);
    }
  }
  /// Expects an error if the device fails in the middle of the work, and correct planes after it
  /// has recovered.
  void expect_error_then_recovery(const Work& work) const {
    failure = {};
    const Outputs expected = outputs_of(work);
    const int middle = failure.calls / 2;
    failure = {.first = middle, .error = CL_DEVICE_NOT_AVAILABLE};
    expect_failure(work);
    failure = {};
    expect_same(outputs_of(work), expected);
  }
  /// Expects correct planes if one allocation in the middle of the work fails, and an error if all
  /// allocations fail.
  void expect_parts_if_memory_is_short(const Work& work) const {
    failure = {};
    const Outputs expected = outputs_of(work);
    const int middle = failure.calls / 2;
    failure = {.first = middle, .last = middle, .error = CL_MEM_OBJECT_ALLOCATION_FAILURE};
    expect_same(outputs_of(work), expected);
    failure = {.first = 0, .error = CL_OUT_OF_RESOURCES};
    expect_failure(work);
  }

  Filter filter_{table_};
  std::vector<float> raw_ = noisy_pixels(table_, 1e5, 1e4, pixels, 3);
};

TEST_F(FailingDevice, FailsToDecodeAndRecovers) {
  const DeviceDecoder decoder(device(), setup_.decoder, {.memory_mb = 1e-3});
  expect_error_then_recovery([&](Outputs& outputs) { decoder.decode(view(), outputs.view()); });
}

TEST_F(FailingDevice, FailsToFilterAndRecovers) {
  const DeviceDecoder decoder(device(), setup_.decoder);
  const DeviceFilter filter(device(), filter_);
  expect_error_then_recovery(
      [&](Outputs& outputs) { filter.decode(view(), decoder, outputs.view()); });
}

TEST_F(FailingDevice, FailsToAddFramesAndForgetsThem) {
  const DeviceDecoder decoder(device(), setup_.decoder);
  const TimeFilter time_filter(table_, {.before_filter = true});
  DeviceFrames frames(device(), table_, &time_filter);
  expect_error_then_recovery([&](Outputs& outputs) {
    EXPECT_FALSE(frames.has_frame());
    frames.take(view());
    frames.take(view());
    frames.decode(decoder, outputs.view());
    frames.forget();
  });
  frames.take(view());
  failure = {.first = 0, .error = CL_DEVICE_NOT_AVAILABLE};
  EXPECT_THROW(frames.take(view()), IoError);
  failure = {};
  EXPECT_FALSE(frames.has_frame());
  EXPECT_THROW(frames.numbers(), InvalidArgument);
}

TEST_F(FailingDevice, FailsToAverageAndForgetsTheFrames) {
  if (!device().info().has_doubles) GTEST_SKIP() << "the device has no doubles";
  const DeviceDecoder decoder(device(), setup_.decoder);
  DeviceFrames frames(device(), table_, nullptr);
  expect_error_then_recovery([&](Outputs& outputs) {
    frames.add(view());
    frames.add(view());
    frames.take_mean();
    frames.decode(decoder, outputs.view());
    frames.forget();
  });
}

TEST_F(FailingDevice, DecodesInPartsIfMemoryIsShort) {
  const DeviceDecoder decoder(device(), setup_.decoder);
  expect_parts_if_memory_is_short(
      [&](Outputs& outputs) { decoder.decode(view(), outputs.view()); });
}

TEST_F(FailingDevice, FiltersInBandsIfMemoryIsShort) {
  const DeviceDecoder decoder(device(), setup_.decoder);
  const DeviceFilter filter(device(), filter_);
  expect_parts_if_memory_is_short(
      [&](Outputs& outputs) { filter.decode(view(), decoder, outputs.view()); });
}

TEST_F(FailingDevice, FailsToCompile) {
  failure = {.first = 0, .error = CL_DEVICE_NOT_AVAILABLE};
  EXPECT_THROW(DeviceFilter(device(), filter_), IoError);
  EXPECT_THROW(DeviceDecoder(device(), setup_.decoder), IoError);
}

}  // namespace
}  // namespace tofsmith
#endif

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "device_setup.hpp"
#include "gpu/device_frames.hpp"
#include "gpu/device_queue.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

using testing::HasSubstr;

std::string refusal_of(std::string_view name) {
  try {
    Device::named(name);
  } catch (const IoError& error) {
    return error.what();
  }
  return "none";
}

using DeviceNames = OnDevice;

TEST_F(DeviceNames, AcceptNumbersAndPartsOfNamesInAnyCase) {
  EXPECT_EQ(Device::named("0").info().name, device().info().name);
  std::string part = device().info().platform;
  for (char& letter : part) letter = static_cast<char>(std::toupper(letter));
  EXPECT_EQ(Device::named(part).info().platform, device().info().platform);
}

TEST_F(DeviceNames, UnknownNamesAreRejectedWithTheKnownOnes) {
  for (const char* name : {"7000", "no such device", "", "-1"})
    EXPECT_THAT(refusal_of(name), HasSubstr("0 " + device().info().name)) << name;
}

TEST(DeviceNamesWithoutDriver, AreRejectedWithTheMissingComponent) {
  if (!device_of_tests()) {
    EXPECT_THAT(refusal_of("gpu"), HasSubstr("OpenCL"));
  }
}

using DeviceQueues = OnDevice;

TEST_F(DeviceQueues, ReportCompilerErrors) {
  const DeviceQueue queue(device());
  try {
    queue.kernel("kernel void broken(global int* a) { a[0] = no_such_name; }", "", "broken");
    FAIL() << "compiled";
  } catch (const IoError& error) {
    EXPECT_THAT(error.what(), HasSubstr("no_such_name"));
    EXPECT_THAT(error.what(), HasSubstr(device().info().name));
  }
}

TEST_F(DeviceQueues, DistinguishInsufficientMemory) {
  const DeviceQueue queue(device());
  EXPECT_THROW(queue.allocate(std::size_t{1} << 60), OutOfDeviceMemory);
}

TEST_F(DeviceQueues, DownloadWhatWasUploaded) {
  const DeviceQueue queue(device());
  const std::vector<std::int32_t> sent = {3, 1, 4, 1, 5};
  const DeviceMemory a = queue.allocate(20), b = queue.allocate(20);
  queue.upload(sent.data(), 20, a);
  queue.copy(a, 0, b, 0, 20);
  std::vector<std::int32_t> back(5);
  queue.download(b, 20, back.data());
  EXPECT_EQ(back, sent);
}

TEST_F(DeviceQueues, WaitForOneAnotherOnRequest) {
  const DeviceQueue first(device()), second(device());
  const DeviceKernel count =
      first.kernel("kernel void count(global int* a) { a[get_global_id(0)] += 1; }", "", "count");
  constexpr int items = 1 << 16, times = 50;
  const std::size_t bytes = items * sizeof(std::int32_t);
  const DeviceMemory a = first.allocate(bytes), b = first.allocate(bytes);
  std::vector<std::int32_t> back(items);
  for (int round = 1; round <= 5; ++round) {
    if (round == 1) first.clear(a);
    for (int i = 0; i < times; ++i) first.run(count, items, &a);
    second.follow(first.mark());
    second.copy(a, 0, b, 0, bytes);
    first.follow(second.mark());  // the copied memory changes afterwards
    for (int i = 0; i < times; ++i) first.run(count, items, &a);
    second.download(b, bytes, back.data());
    EXPECT_EQ(back, std::vector<std::int32_t>(items, (2 * round - 1) * times));
  }
}

class DevicePipelines : public OnDevice {
 protected:
  static constexpr int height = 45, width = 34, frames = 5;

  DevicePipelines() {
    for (std::uint64_t f = 0; f < frames; ++f)
      raw_.push_back(noisy_pixels(table_, 1e5, 1e4, height * width, f + 1));
  }

  std::unique_ptr<FrameBackend> backend(std::string_view device_name,
                                        DecodeMethod method = DecodeMethod::zncc) const {
    return frame_backend(device_name, make_decoder(method, table_));
  }

  /// Frames are filtered again without mixed pixels.
  static std::vector<Outputs> decoded(const FrameBackend& backend, const FrameSteps& steps,
                                      const PlaneCorrections& corrections,
                                      const std::vector<std::vector<float>>& raw) {
    const std::unique_ptr<FramePipeline> pipeline = backend.prepare(steps, height, width);
    std::vector<Outputs> all;
    const auto decode = [&] {
      Outputs& outputs = all.emplace_back(static_cast<std::size_t>(height) * width);
      decode_frame(*pipeline, corrections, 0, height, outputs.view());
      if (steps.keeps_filtered) {
        EXPECT_EQ(pipeline->numbers().pixels(), height * width);
      }
    };
    for (std::size_t f = 0; f < raw.size(); ++f) {
      const bool completes = (f + 1) % static_cast<std::size_t>(steps.average) == 0;
      if (pipeline->submit(RawView::interleaved(raw[f].data(), height, width, 4), completes))
        decode();
    }
    while (pipeline->submit_end()) decode();
    return all;
  }

  std::vector<std::vector<float>> raw_;
};

TEST_F(DevicePipelines, EqualTheCpu) {
  const Filter light(table_, FilterOptions::of(FilterStrength::light)), normal(table_);
  const TimeFilterOptions in_time{.max_frames = 3}, ahead{.max_frames = 3, .look_ahead = 2};
  const std::vector<FrameSteps> all_steps = {{},
                                             {.filter = &light},
                                             {.filter = &normal},
                                             {.time_filter = in_time},
                                             {.time_filter = in_time, .filter = &light},
                                             {.time_filter = ahead},
                                             {.time_filter = ahead, .filter = &light},
                                             {.average = 2, .averaged = 3.0},
                                             {.average = 2, .filter = &light},
                                             {.average = 2, .time_filter = in_time},
                                             {.average = 2, .time_filter = ahead}};
  const std::unique_ptr<FrameBackend> here = backend("cpu"), there = backend("0");
  EXPECT_EQ(here->device(), "cpu");
  EXPECT_EQ(there->device(), device().info().name);
  for (FrameSteps steps : all_steps)
    for (const bool finds_mixed : {false, true}) {
      PlaneCorrections corrections;
      if (finds_mixed) corrections.mixed = MixedPixels::label;
      steps.keeps_filtered = finds_mixed;
      const std::vector<Outputs> expected = decoded(*here, steps, corrections, raw_),
                                 found = decoded(*there, steps, corrections, raw_);
      ASSERT_EQ(found.size(), expected.size());
      EXPECT_EQ(found.size(), (raw_.size() + static_cast<std::size_t>(steps.average) - 1) /
                                  static_cast<std::size_t>(steps.average));
      for (std::size_t f = 0; f < found.size(); ++f)
        expect_alike(device().info(), true, found[f], expected[f], 1e6);
    }
}

TEST_F(DevicePipelines, FilterWithoutDecoding) {
  const Filter filter(table_);
  const FrameSteps steps{.filter = &filter, .keeps_filtered = true};
  const RawView raw = RawView::interleaved(raw_[0].data(), height, width, 4);
  FilteredFrame expected;
  filter.apply(raw, expected);
  for (const char* name : {"cpu", "0"}) {
    const std::unique_ptr<FrameBackend> on = backend(name);
    const std::unique_ptr<FramePipeline> pipeline = on->prepare(steps, height, width);
    EXPECT_TRUE(pipeline->submit(raw));
    if (device().info().divides_as_processor) {
      EXPECT_EQ(values_of(pipeline->numbers()), expected.values().values) << name;
    }
  }
}

TEST_F(DevicePipelines, NeedNoHostMemoryForDataOnTheDevice) {
  const FrameSteps steps{.time_filter = TimeFilterOptions{}};
  const auto whole = [&](const char* name) {
    return backend(name)->prepare(steps, height, width)->memory(frames).whole;
  };
  EXPECT_EQ(whole("0"), 0.0);
  EXPECT_GT(whole("cpu"), 4.0 * height * width * 6);
}

TEST_F(DevicePipelines, LeaveSmallAndUnfilteredFramesToTheCpuIfAutomatic) {
  int searches = 0;
  const auto find_device = [&] {
    ++searches;
    return std::optional(device());
  };
  const std::unique_ptr<FrameBackend> on =
      automatic_backend(find_device, make_decoder(DecodeMethod::zncc, table_), {});
  const Filter filter(table_, FilterOptions::of(FilterStrength::light));
  const auto host_bytes = [&](const Filter* in_space, int rows) {
    const FrameSteps steps{.time_filter = TimeFilterOptions{}, .filter = in_space};
    return on->prepare(steps, rows, 1000)->memory(frames).whole;
  };
  EXPECT_GT(host_bytes(nullptr, 1000), 0.0);  // on the CPU
  EXPECT_GT(host_bytes(&filter, 74), 0.0);
  EXPECT_EQ(on->device(), "cpu");
  EXPECT_EQ(searches, 0);
  EXPECT_EQ(host_bytes(&filter, 75), 0.0);
  EXPECT_EQ(host_bytes(&filter, 76), 0.0);
  EXPECT_EQ(on->device(), device().info().name);
  EXPECT_EQ(searches, 1);
}

TEST_F(DevicePipelines, AreChosenByName) {
  EXPECT_EQ(backend("auto", DecodeMethod::ml)->device(), "cpu");
  EXPECT_THROW(backend("0", DecodeMethod::ml), InvalidArgument);
  EXPECT_THROW(backend("no such device"), IoError);
  EXPECT_THROW(frame_backend("0", make_decoder(DecodeMethod::zncc, table_), {.memory_mb = 0.0}),
               InvalidArgument);
}

}  // namespace

}  // namespace tofsmith

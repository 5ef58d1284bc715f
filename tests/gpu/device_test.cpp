// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "device_setup.hpp"
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

}  // namespace
}  // namespace tofsmith

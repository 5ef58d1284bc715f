// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Decoding in Monte Carlo loops must not allocate on the heap. This file counts all allocations of
// the test program.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "decode_setup.hpp"
#include "tofsmith/core/parallel.hpp"

namespace {
std::atomic<std::int64_t> allocations{0};

void* counted(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size > 0 ? size : 1);
}

void* counted(std::size_t size) {
  if (void* memory = counted(size, std::nothrow)) return memory;
  throw std::bad_alloc();
}
}  // namespace

// GCC 14 warns of `free` for memory from `operator new` where it inlines only one of them.
[[gnu::noinline]] void* operator new(std::size_t size) { return counted(size); }
[[gnu::noinline]] void* operator new[](std::size_t size) { return counted(size); }
// Without this overload, memory from the sanitizer's nothrow new would be freed by free() below.
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t& tag) noexcept {
  return counted(size, tag);
}
[[gnu::noinline]] void* operator new[](std::size_t size, const std::nothrow_t& tag) noexcept {
  return counted(size, tag);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete[](void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace tofsmith {
namespace {

template <typename Work>
std::int64_t allocations_of(const Work& work) {
  const std::int64_t before = allocations;
  work();
  return allocations - before;
}

TEST(Decoder, AllocatesNothingInBatches) {
  const DecodeSetup setup("hamiltonian-k5", camera_with("paper-10f0"));
  const std::vector<float> raw = noisy_pixels(setup.decoder.table(), 1e3, 1e4, 3000, 1);
  std::vector<std::int32_t> bins(3000);
  std::vector<double> positions(3000);
  ASSERT_GT(allocations_of([] { std::vector<int> seen(10); }), 0);
  EXPECT_EQ(allocations_of([&] { setup.decoder.decode_bins(raw.data(), 3000, bins.data()); }), 0);
  EXPECT_EQ(
      allocations_of([&] { setup.decoder.decode_depth_bins(raw.data(), 3000, positions.data()); }),
      0);
}

TEST(UnwrapDecoder, AllocatesNothing) {
  const UnwrapSetup setup("multifrequency-k5", camera_with("paper-10f0"));
  const std::vector<float> raw = noisy_pixels(setup.decoder.table(), 1e3, 1e4, 4000, 1);
  std::vector<std::int32_t> bins(4000);
  std::vector<double> positions(4000);
  const auto batch = [&] {
    setup.decoder.decode_depth_bins(raw.data(), 4000, positions.data());
    setup.decoder.decode_bins(raw.data(), 4000, bins.data());
  };
  EXPECT_EQ(allocations_of(batch), 0);
  const auto of_frame = [&](int pixels) {
    const RawFrames frame = frame_of({raw.begin(), raw.begin() + 5 * pixels}, 5);
    return allocations_of([&] { setup.decoder.decode(frame); });
  };
  of_frame(64);  // the first use of threads allocates
  EXPECT_LE(of_frame(4000), of_frame(400) + 2);
}

TEST(LikelihoodDecoder, AllocatesNothingPerPixel) {
  const LikelihoodSetup setup("hamiltonian-k5", camera_with("paper-10f0"));
  const std::vector<float> raw = noisy_pixels(setup.decoder.table(), 1e3, 1e4, 4000, 1);
  std::vector<std::int32_t> bins(4000);
  std::vector<double> positions(4000);
  const auto of_batch = [&](int pixels) {
    return allocations_of([&] {
      setup.decoder.decode_depth_bins(raw.data(), pixels, positions.data());
      setup.decoder.decode_bins(raw.data(), pixels, bins.data());
    });
  };
  EXPECT_EQ(of_batch(1), 2);         // work space: once per call ...
  EXPECT_EQ(of_batch(4000), 1 + 8);  // ... or per 512 pixels
  const auto of_frame = [&](int pixels) {
    const RawFrames frame = frame_of({raw.begin(), raw.begin() + 5 * pixels}, 5);
    return allocations_of([&] { setup.decoder.decode(frame); });
  };
  const ThreadLimit limit(1);  // every thread has its own work space
  of_frame(64);
  // Work space and raw values for each block of 1024 pixels; the larger frame has 3 more blocks.
  EXPECT_LE(of_frame(4000), of_frame(400) + 2 + 2 * 3);
}

TEST(Decoder, AllocatesNothingPerPixelInFrames) {
  const DecodeSetup setup("hamiltonian-k5", camera_with("paper-10f0"));
  const auto of_frame = [&](int pixels) {
    const RawFrames frame = frame_of(noisy_pixels(setup.decoder.table(), 1e3, 1e4, pixels, 1), 5);
    return allocations_of([&] { setup.decoder.decode(frame); });
  };
  of_frame(64);  // the first use of threads allocates
  EXPECT_LE(of_frame(4000), of_frame(400) + 2);
}

}  // namespace
}  // namespace tofsmith

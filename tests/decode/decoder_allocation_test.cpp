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

template <typename Setup>
std::int64_t allocations_of_batch(const Setup& setup, int pixels) {
  const std::vector<float> raw = noisy_pixels(setup.decoder.table(), 1e3, 1e4, pixels, 1);
  std::vector<std::int32_t> bins(static_cast<std::size_t>(pixels));
  std::vector<double> positions(static_cast<std::size_t>(pixels));
  return allocations_of([&] {
    setup.decoder.decode_depth_bins(raw.data(), pixels, positions.data());
    setup.decoder.decode_bins(raw.data(), pixels, bins.data());
  });
}

/// Returns the number of allocations by which a large frame exceeds a small one.
template <typename Setup>
std::int64_t more_allocations_of_large_frame(const Setup& setup) {
  const auto of_frame = [&](int pixels) {
    const RawFrames frame = frame_of(noisy_pixels(setup.decoder.table(), 1e3, 1e4, pixels, 1), 5);
    return allocations_of([&] { setup.decoder.decode(frame); });
  };
  of_frame(64);  // the first use of threads allocates
  return of_frame(4000) - of_frame(400);
}

TEST(Decoder, AllocatesNothing) {
  const DecodeSetup setup("hamiltonian-k5", camera_with("paper-10f0"));
  ASSERT_GT(allocations_of([] { std::vector<int> seen(10); }), 0);
  EXPECT_EQ(allocations_of_batch(setup, 3000), 0);
  EXPECT_LE(more_allocations_of_large_frame(setup), 2);
}

TEST(UnwrapDecoder, AllocatesNothing) {
  const UnwrapSetup setup("multifrequency-k5", camera_with("paper-10f0"));
  EXPECT_EQ(allocations_of_batch(setup, 4000), 0);
  EXPECT_LE(more_allocations_of_large_frame(setup), 2);
}

TEST(LikelihoodDecoder, AllocatesNothingPerPixel) {
  const LikelihoodSetup setup("hamiltonian-k5", camera_with("paper-10f0"));
  EXPECT_EQ(allocations_of_batch(setup, 1), 2);         // work space: once per call ...
  EXPECT_EQ(allocations_of_batch(setup, 4000), 1 + 8);  // ... or per 512 pixels
  const ThreadLimit limit(1);                           // every thread has its own work space
  // Work space and raw values for each block of 1024 pixels; the larger frame has 3 more blocks.
  EXPECT_LE(more_allocations_of_large_frame(setup), 2 + 2 * 3);
}

}  // namespace
}  // namespace tofsmith

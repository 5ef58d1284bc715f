// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/raw_frames.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <numeric>

#include "damaged_files.hpp"
#include "temporary_directory.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr auto overwrite = OutputPolicy::overwrite;

RawFrames test_frames(int frames) {
  RawFrames raw{frames, 2, 3, 4, {}};
  raw.values.resize(static_cast<std::size_t>(frames * 24));
  std::iota(raw.values.begin(), raw.values.end(), -2.5f);
  raw.values[1] = std::numeric_limits<float>::quiet_NaN();
  raw.values[2] = std::numeric_limits<float>::infinity();
  return raw;
}

class RawFormat : public testing::TestWithParam<std::string> {};

TEST_P(RawFormat, ReadingUndoesWriting) {
  const TemporaryDirectory directory;
  const auto file = directory / ("raw" + GetParam());
  for (const int frames : {1, 3}) {
    const RawFrames raw = test_frames(frames);
    write_raw_frames(file, raw, overwrite);
    const RawFrames back = read_raw_frames(file, 4);
    EXPECT_EQ(back.frames, frames);
    EXPECT_EQ(back.height, 2);
    EXPECT_EQ(back.width, 3);
    EXPECT_EQ(back.measurements, 4);
    ASSERT_EQ(back.values.size(), raw.values.size());
    EXPECT_EQ(std::memcmp(back.values.data(), raw.values.data(), raw.values.size() * 4), 0);
  }
}

TEST_P(RawFormat, RejectsAnotherNumberOfMeasurementsWithBothNumbers) {
  const TemporaryDirectory directory;
  const auto file = directory / ("raw" + GetParam());
  write_raw_frames(file, test_frames(1), overwrite);
  EXPECT_THAT(io_error_of([&] { read_raw_frames(file, 5); }),
              HasSubstr("found 4 measurements per pixel, shape (2, 3, 4); expected 5"));
}

INSTANTIATE_TEST_SUITE_P(All, RawFormat, testing::Values(".npy", ".npz"));

TEST(RawFramesFile, OneFrameIsWrittenWithoutAFrameAxis) {
  const TemporaryDirectory directory;
  write_raw_frames(directory / "a.npy", test_frames(1), overwrite);
  EXPECT_THAT(read_npy(directory / "a.npy").shape(), ElementsAre(2, 3, 4));
  write_raw_frames(directory / "a.npy", test_frames(2), overwrite);
  EXPECT_THAT(read_npy(directory / "a.npy").shape(), ElementsAre(2, 2, 3, 4));
  write_raw_frames(directory / "a.npz", test_frames(1), overwrite);
  EXPECT_TRUE(NpzReader(directory / "a.npz").contains("raw"));
}

TEST(RawFramesFile, ReadsCountsAndDoubles) {
  const TemporaryDirectory directory;
  const std::vector<std::uint16_t> counts = {0, 65535};
  const std::vector<std::uint8_t> bytes = {0, 255};
  const std::vector<double> doubles = {0.5, -1e3};
  write_npy(directory / "u2.npy", NpyArray::of<std::uint16_t>({1, 1, 2}, counts), overwrite);
  write_npy(directory / "u1.npy", NpyArray::of<std::uint8_t>({1, 1, 2}, bytes), overwrite);
  write_npz(directory / "f8.npz", {{"x", NpyArray::of<double>({1, 1, 1, 2}, doubles)}}, overwrite);
  EXPECT_THAT(read_raw_frames(directory / "u2.npy").values, ElementsAre(0.0f, 65535.0f));
  EXPECT_THAT(read_raw_frames(directory / "u1.npy").values, ElementsAre(0.0f, 255.0f));
  EXPECT_THAT(read_raw_frames(directory / "f8.npz").values, ElementsAre(0.5f, -1000.0f));
}

TEST(RawFramesFile, ReadsArraysLargerThanOneSlice) {
  const TemporaryDirectory directory;
  RawFrames raw{5, 300, 500, 4, {}};
  raw.values.resize(5u * 300 * 500 * 4);
  std::iota(raw.values.begin(), raw.values.end(), 0.0f);
  write_raw_frames(directory / "a.npy", raw, overwrite);
  EXPECT_EQ(read_raw_frames(directory / "a.npy").values, raw.values);
}

TEST(RawFramesFile, RejectsArraysThatAreNotFrames) {
  const TemporaryDirectory directory;
  const auto refusal = [&](NpyType type, const NpyShape& shape) {
    write_npy(directory / "a.npy", NpyArray(type, shape), overwrite);
    return io_error_of([&] { read_raw_frames(directory / "a.npy"); });
  };
  EXPECT_THAT(refusal(NpyType::boolean, {1, 1, 4}), HasSubstr("type bool; expected numbers"));
  EXPECT_THAT(refusal(NpyType::float32, {2, 4}), HasSubstr("shape (2, 4); expected (H, W, K)"));
  EXPECT_THAT(refusal(NpyType::float32, {1, 1, 1, 1, 1}), HasSubstr("(1, 1, 1, 1, 1)"));
  EXPECT_THAT(refusal(NpyType::float32, {2, 2, 0}), HasSubstr("at least one"));
  EXPECT_THAT(refusal(NpyType::float32, {0, 2, 2, 4}), HasSubstr("at least one"));
  EXPECT_THAT(refusal(NpyType::float32, {2, 0, 4}), HasSubstr("2 x 0 pixels"));
  EXPECT_THAT(io_error_of([&] { read_raw_frames(directory / "a.bin"); }),
              HasSubstr("expected .npy, .npz or .h5"));
  EXPECT_THAT(io_error_of([&] { read_raw_frames(directory / "b.npy"); }), HasSubstr("no such"));
}

TEST(RawFramesFile, RejectsWritingInvalidFrames) {
  const TemporaryDirectory directory;
  EXPECT_THROW(write_raw_frames(directory / "a.npy", RawFrames{}, overwrite),
               std::invalid_argument);
  RawFrames raw = test_frames(1);
  raw.values.pop_back();
  EXPECT_THROW(write_raw_frames(directory / "a.npy", raw, overwrite), std::invalid_argument);
  EXPECT_EQ(directory.files(), 0);
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/raw_frames.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <numeric>
#include <type_traits>

#include "damaged_files.hpp"
#include "decode_setup.hpp"
#include "raw_packer.hpp"
#include "temporary_directory.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {

namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr auto overwrite = OutputPolicy::overwrite;
constexpr std::size_t frames = 3, height = 7, width = 5, measurements = 4;

template <typename Number>
Number number_of(double value) {
  if constexpr (std::is_integral_v<Number>)
    return static_cast<Number>(std::fmod(std::abs(value), std::numeric_limits<Number>::max()));
  else
    return static_cast<Number>(value);
}

template <typename Number>
std::vector<Number> recording(const DecodeSetup& setup) {
  const int pixels = static_cast<int>(frames * height * width);
  std::vector<Number> numbers;
  for (const float value : noisy_pixels(setup.decoder.table(), 700.0, 50.0, pixels, 3))
    numbers.push_back(number_of<Number>(value));
  return numbers;
}

template <typename Number>
std::vector<Number> planar(const std::vector<Number>& numbers) {
  std::vector<Number> planes(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::size_t k = i % measurements, pixel = i / measurements,
                      place = pixel % (height * width), frame = pixel / (height * width);
    planes[(frame * measurements + k) * height * width + place] = numbers[i];
  }
  return planes;
}

template <typename Number>
class RawRows : public testing::Test {
 protected:
  void write(const std::string& name, RawLayout layout) {
    const bool interleaved = layout == RawLayout::interleaved;
    const NpyShape shape = interleaved ? NpyShape{frames, height, width, measurements}
                                       : NpyShape{frames, measurements, height, width};
    const auto array = NpyArray::of<Number>(shape, interleaved ? numbers_ : planar(numbers_));
    if (name.ends_with(".npz"))
      write_npz(directory_ / name, {{"raw", array}}, overwrite);
    else
      write_npy(directory_ / name, array, overwrite);
  }

  TemporaryDirectory directory_;
  DecodeSetup setup_{"hamiltonian-k4", built_in_camera("paper-10f0")};
  std::vector<Number> numbers_ = recording<Number>(setup_);
};

using Numbers = testing::Types<float, double, std::uint16_t, std::uint8_t>;
TYPED_TEST_SUITE(RawRows, Numbers);

TYPED_TEST(RawRows, DecodeInBandsLikeTheWholeFrame) {
  const std::vector planes = {DecodedPlane::depth, DecodedPlane::bin, DecodedPlane::status};
  for (const RawLayout layout : {RawLayout::interleaved, RawLayout::planar})
    for (const std::string name : {"raw.npy", "raw.npz"}) {
      this->write(name, layout);
      const RawFramesReader reader(this->directory_ / name,
                                   {.measurements = int{measurements}, .layout = layout});
      EXPECT_EQ(reader.type(), npy_type_of<TypeParam>);
      EXPECT_EQ(reader.row_bytes(), width * measurements * sizeof(TypeParam));
      std::vector<std::byte> buffer;
      for (int frame = 0; frame < reader.frames(); ++frame) {
        const std::size_t values = height * width * measurements;
        DepthImage whole(planes, int{height}, int{width});
        this->setup_.decoder.decode(
            RawView::interleaved(this->numbers_.data() + static_cast<std::size_t>(frame) * values,
                                 height, width, measurements),
            DecodedView::of(whole));
        for (const int rows : {1, 2, 3, 7}) {
          DepthImage banded(planes, int{height}, int{width});
          for (int row = 0; row < reader.height(); row += rows)
            this->setup_.decoder.decode(
                reader.read_rows(frame, row, std::min(rows, reader.height() - row), buffer),
                DecodedView::of(banded).from(static_cast<std::size_t>(row) * width));
          EXPECT_EQ(banded.bin.pixels, whole.bin.pixels);
          EXPECT_EQ(banded.status.pixels, whole.status.pixels);
          EXPECT_EQ(std::memcmp(banded.depth_m.pixels.data(), whole.depth_m.pixels.data(),
                                height * width * sizeof(float)),
                    0);
        }
      }
    }
}

RawFrames small_frames(int count) {
  RawFrames raw{count, 2, 3, 4, {}};
  raw.values.resize(static_cast<std::size_t>(count) * 24);
  std::iota(raw.values.begin(), raw.values.end(), -2.5f);
  raw.values[1] = std::numeric_limits<float>::quiet_NaN();
  raw.values[2] = std::numeric_limits<float>::infinity();
  return raw;
}

TEST(RawFramesReader, RejectsFramesAndRowsOutOfRange) {
  const TemporaryDirectory directory;
  write_raw_frames(directory / "a.npy", small_frames(2), overwrite);
  const RawFramesReader reader(directory / "a.npy");
  std::vector<std::byte> buffer;
  EXPECT_THROW(reader.read_rows(-1, 0, 1, buffer), std::invalid_argument);
  EXPECT_THROW(reader.read_rows(2, 0, 1, buffer), std::invalid_argument);
  EXPECT_THROW(reader.read_rows(0, -1, 1, buffer), std::invalid_argument);
  EXPECT_THROW(reader.read_rows(0, 1, 2, buffer), std::invalid_argument);
  EXPECT_THROW(reader.read_rows(0, 0, -1, buffer), std::invalid_argument);
  EXPECT_EQ(reader.read_rows(0, 2, 0, buffer).height, 0);
}

TEST(RawFramesReader, SuggestsTheMatchingLayout) {
  const TemporaryDirectory directory;
  const auto refusal = [&](const NpyShape& shape, RawLayout layout) {
    write_npy(directory / "a.npy", NpyArray(NpyType::uint16, shape), overwrite);
    return io_error_of(
        [&] { RawFramesReader(directory / "a.npy", {.measurements = 4, .layout = layout}); });
  };
  EXPECT_THAT(refusal({3, 4, 6, 8}, RawLayout::interleaved),
              AllOf(HasSubstr("found 8 measurements per pixel, shape (3, 4, 6, 8); expected 4"),
                    HasSubstr("(F, K, H, W): --layout planar")));
  EXPECT_THAT(refusal({6, 8, 4}, RawLayout::planar), HasSubstr("--layout interleaved"));
  EXPECT_THAT(refusal({6, 8, 5}, RawLayout::planar), testing::Not(HasSubstr("--layout")));
  EXPECT_THAT(refusal({6, 8}, RawLayout::planar), HasSubstr("expected (K, H, W) or (F, K, H, W)"));
}

TEST(RawFramesReader, ReadsOneFilePerMeasurementAndReportsTheOneThatDiffers) {
  const TemporaryDirectory directory;
  const auto write = [&](const char* name, const NpyArray& array) {
    write_npy(directory / name, array, overwrite);
    return directory / name;
  };
  const auto message_of = [&](const std::vector<std::filesystem::path>& files) {
    return io_error_of([&] { RawFramesReader(files, {.measurements = 2}); });
  };
  const std::vector<std::int32_t> first = {1, -2, 3, 4, 5, 6}, second = {7, 8, 9, 10, 11, 1 << 30};
  const auto a = write("a.npy", NpyArray::of<std::int32_t>({2, 3}, first)),
             b = write("b.npy", NpyArray::of<std::int32_t>({2, 3}, second));
  const RawFramesReader reader({a, b}, {.measurements = 2});
  EXPECT_EQ(reader.frames(), 1);
  EXPECT_EQ(reader.measurements(), 2);
  EXPECT_TRUE(reader.holds_integers());
  std::vector<std::byte> buffer;
  const RawView row = reader.read_rows(0, 1, 1, buffer);
  const auto* numbers = std::get<const double*>(row.data);
  EXPECT_EQ(numbers[2], 6.0);
  EXPECT_EQ(numbers[row.measurement_stride + 2], static_cast<double>(1 << 30));

  EXPECT_THAT(message_of({a, b, a}), HasSubstr("found 3 files, one per measurement; expected 2"));
  const auto turned = write("turned.npy", NpyArray::of<std::int32_t>({3, 2}, first));
  EXPECT_THAT(message_of({a, turned}), HasSubstr("turned.npy: found 1 frame of 3 x 2; expected 1 "
                                                 "frame of 2 x 3 as in"));
  const auto floats = write("floats.npy", NpyArray(NpyType::float64, {2, 3}));
  EXPECT_THAT(message_of({a, floats}), HasSubstr("floats.npy: found numbers"));
  const auto flat = write("flat.npy", NpyArray(NpyType::int32, {6}));
  EXPECT_THAT(message_of({a, flat}), HasSubstr("flat.npy: found an array of shape (6,)"));
  EXPECT_THAT(message_of({a, a}), HasSubstr("a.npy: is listed twice"));
}

template <typename Number>
class WholeNumbers : public testing::Test {};
using WholeTypes = testing::Types<std::int8_t, std::int16_t, std::int32_t, std::int64_t,
                                  std::uint8_t, std::uint16_t, std::uint32_t, std::uint64_t>;
TYPED_TEST_SUITE(WholeNumbers, WholeTypes);

TYPED_TEST(WholeNumbers, AreReadUnchanged) {
  const TemporaryDirectory directory;
  constexpr TypeParam lowest = std::numeric_limits<TypeParam>::lowest(),
                      highest = std::numeric_limits<TypeParam>::max();
  const std::vector<TypeParam> numbers = {lowest, 1, 127, highest};
  const auto array = NpyArray::of<TypeParam>({1, 1, 4}, numbers);
  write_npy(directory / "a.npy", array, overwrite);
  write_npz(directory / "a.npz", {{"x", array}}, overwrite);
  for (const char* name : {"a.npy", "a.npz"}) {
    const RawFramesReader reader(directory / name);
    EXPECT_TRUE(reader.holds_integers());
    EXPECT_EQ(reader.type() == NpyType::float64, sizeof(TypeParam) >= 4);
    EXPECT_EQ(read_frame(reader, 0).values,
              (std::vector<float>{static_cast<float>(lowest), 1.0f, 127.0f,
                                  static_cast<float>(highest)}));
  }
}

TEST(RawFramesReader, DoesNotGuessTheLayoutOfACube) {
  const TemporaryDirectory directory;
  std::vector<std::uint8_t> values(4 * 4 * 4);
  std::iota(values.begin(), values.end(), std::uint8_t{0});
  write_npy(directory / "a.npy", NpyArray::of<std::uint8_t>({4, 4, 4}, values), overwrite);
  const RawFramesReader side_by_side(directory / "a.npy", {.measurements = 4}),
      planes(directory / "a.npy", {.measurements = 4, .layout = RawLayout::planar});
  EXPECT_EQ(read_frame(side_by_side, 0).values[1], 1.0f);
  EXPECT_EQ(read_frame(planes, 0).values[1], 16.0f);
}

TEST(RawFramesReader, DetectsAFileThatShrinksAndIgnoresOneThatGrows) {
  const TemporaryDirectory directory;
  const RawFrames raw = small_frames(3);
  write_raw_frames(directory / "a.npy", raw, overwrite);
  const RawFramesReader reader(directory / "a.npy");
  const auto bytes = std::filesystem::file_size(directory / "a.npy");
  std::filesystem::resize_file(directory / "a.npy", bytes + 96);
  EXPECT_EQ(read_frame(reader, 2).values.back(), raw.values.back());
  std::filesystem::resize_file(directory / "a.npy", bytes - 1);
  EXPECT_EQ(read_frame(reader, 1).values.back(), raw.frame(1)[23]);
  EXPECT_THAT(io_error_of([&] { read_frame(reader, 2); }), HasSubstr("the file ends here"));
  EXPECT_THAT(io_error_of([&] { RawFramesReader(directory / "a.npy"); }),
              HasSubstr("bytes of data"));
}

TEST(RawFramesReader, RespectsItsMemoryLimit) {
  const TemporaryDirectory directory;
  const NpyArray array(NpyType::float32, {100, 100, 4});  // 160 kB
  write_npz(directory / "a.npz", {{"raw", array}}, overwrite);
  const auto open = [&](std::uint64_t bytes) {
    return RawFramesReader(directory / "a.npz", {.max_in_memory = bytes}).bytes_in_memory();
  };
  EXPECT_EQ(open(400'000), 160'000u);
  EXPECT_THAT(io_error_of([&] { open(300'000); }),
              AllOf(HasSubstr("a.npz"), HasSubstr("save it as .npy")));
}

TEST(RawFramesReader, ReadsTheEndOfAFileLargerThanMemory) {
  const TemporaryDirectory directory;
  // A sparse file of 12 GB: 2000 frames of zeros except for the last number.
  {
    NpyItemWriter header(directory / "a.npy", NpyType::uint16, {0, 1000, 1000, 3}, overwrite);
    header.commit();
  }
  const auto header_bytes = std::filesystem::file_size(directory / "a.npy");
  std::fstream file(directory / "a.npy", std::ios::in | std::ios::out | std::ios::binary);
  std::string text(header_bytes, ' ');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.replace(text.find("(0, "), 4, "(2000, ");
  text.erase(text.find("), }") + 4, 3);  // remove some padding
  const std::uint64_t end = header_bytes + 2000ull * 1000 * 1000 * 3 * 2;
  file.seekp(0);
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
  file.seekp(static_cast<std::streamoff>(end - 2));
  file.write("\x39\x30", 2);
  file.close();

  const RawFramesReader reader(directory / "a.npy", {.measurements = 3});
  std::vector<std::byte> buffer;
  const RawView view = reader.read_rows(1999, 999, 1, buffer);
  EXPECT_EQ(buffer.size(), 6000u);
  EXPECT_EQ(std::get<const std::uint16_t*>(view.data)[2999], 12345);
}

using testing::ElementsAre;

TEST(RawFramesFile, ReadingUndoesWriting) {
  const TemporaryDirectory directory;
  for (const char* name : {"raw.npy", "raw.npz"})
    for (const int count : {1, 3}) {
      const RawFrames raw = small_frames(count);
      write_raw_frames(directory / name, raw, overwrite);
      const RawFrames back = read_raw_frames(directory / name, 4);
      EXPECT_EQ(back.frames, count);
      EXPECT_EQ(back.height, 2);
      EXPECT_EQ(back.width, 3);
      EXPECT_EQ(back.measurements, 4);
      ASSERT_EQ(back.values.size(), raw.values.size());
      EXPECT_EQ(std::memcmp(back.values.data(), raw.values.data(), raw.values.size() * 4), 0);
    }
}

TEST(RawFramesFile, OneFrameIsWrittenWithoutAFrameAxis) {
  const TemporaryDirectory directory;
  write_raw_frames(directory / "a.npy", small_frames(1), overwrite);
  EXPECT_THAT(read_npy(directory / "a.npy").shape(), ElementsAre(2, 3, 4));
  write_raw_frames(directory / "a.npy", small_frames(2), overwrite);
  EXPECT_THAT(read_npy(directory / "a.npy").shape(), ElementsAre(2, 2, 3, 4));
  write_raw_frames(directory / "a.npz", small_frames(1), overwrite);
  EXPECT_TRUE(NpzReader(directory / "a.npz").contains("raw"));
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
  RawFrames raw = small_frames(1);
  raw.values.pop_back();
  EXPECT_THROW(write_raw_frames(directory / "a.npy", raw, overwrite), std::invalid_argument);
  EXPECT_EQ(directory.files(), 0);
}

}  // namespace

}  // namespace tofsmith

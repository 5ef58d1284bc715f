// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/npy.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "damaged_files.hpp"
#include "io/shared/read_file.hpp"
#include "temporary_directory.hpp"

namespace tofsmith {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

NpzArrays two_arrays() {
  const std::vector<float> depth = {1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f};
  const std::vector<std::uint16_t> raw(500, 7);
  return {{"depth", NpyArray::of<float>({2, 3}, depth)},
          {"raw", NpyArray::of<std::uint16_t>({500}, raw)}};
}

class NpzPacking : public testing::TestWithParam<NpzCompression> {};

TEST_P(NpzPacking, ReadingUndoesWriting) {
  const TemporaryDirectory directory;
  write_npz(directory / "a.npz", two_arrays(), OutputPolicy::refuse_existing, GetParam());
  const NpzArrays back = read_npz(directory / "a.npz");
  ASSERT_EQ(back.size(), 2u);
  for (const auto& [name, array] : two_arrays())
    EXPECT_EQ(serialize_npy(back.at(name)), serialize_npy(array)) << name;
}

TEST_P(NpzPacking, RefusesEveryTruncation) {
  const FileBytes whole = serialize_npz(two_arrays(), GetParam());
  expect_truncations_refused(whole, [](auto bytes) { parse_npz(bytes, "a.npz"); });
}

INSTANTIATE_TEST_SUITE_P(StoredAndDeflated, NpzPacking,
                         testing::Values(NpzCompression::stored, NpzCompression::deflated));

TEST(Npz, EqualArraysGiveEqualBytesWithoutADate) {
  const FileBytes bytes = serialize_npz(two_arrays());
  EXPECT_EQ(bytes, serialize_npz(two_arrays()));
  // Time and date of the first local header: midnight, 1980-01-01.
  EXPECT_THAT(std::vector(bytes.begin() + 10, bytes.begin() + 14),
              ElementsAre(std::byte{0}, std::byte{0}, std::byte{0x21}, std::byte{0}));
}

TEST_P(NpzPacking, TheFileEqualsTheArchiveInMemory) {
  const TemporaryDirectory directory;
  for (int time = 0; time < 2; ++time) {  // a new file, and an overwritten file
    write_npz(directory / "a.npz", two_arrays(), OutputPolicy::overwrite, GetParam());
    EXPECT_EQ(read_binary_file(directory / "a.npz"), serialize_npz(two_arrays(), GetParam()));
    EXPECT_EQ(directory.files(), 1);
  }
}

TEST(Npz, DeflateCompressesRepetition) {
  EXPECT_LT(serialize_npz(two_arrays(), NpzCompression::deflated).size() + 500,
            serialize_npz(two_arrays(), NpzCompression::stored).size());
}

TEST(Npz, ReaderUnpacksSingleArraysAndListsAll) {
  const FileBytes bytes = serialize_npz(two_arrays());
  const NpzReader reader(bytes, "a.npz");
  EXPECT_THAT(reader.names(), ElementsAre("depth", "raw"));
  EXPECT_TRUE(reader.contains("raw"));
  EXPECT_FALSE(reader.contains("raw.npy"));
  EXPECT_THAT(reader.read("depth").shape(), ElementsAre(2, 3));
  EXPECT_THAT(io_error_of([&] { reader.read("corrfs"); }),
              HasSubstr("a.npz: there is no array 'corrfs'; found depth, raw"));
}

TEST(Npz, AnUnsupportedArrayDoesNotPreventReadingOthers) {
  // Published archives often contain pickled objects.
  FileBytes bytes = serialize_npz(two_arrays());
  const FileBytes code = bytes_of("'<u2'");
  const auto at = std::search(bytes.begin(), bytes.end(), code.begin(), code.end());
  ASSERT_NE(at, bytes.end());
  *(at + 1) = std::byte{'|'};
  *(at + 2) = std::byte{'O'};
  const NpzReader reader(bytes, "a.npz");
  EXPECT_THAT(reader.read("depth").shape(), ElementsAre(2, 3));
  EXPECT_THROW(reader.read("raw"), IoError);
}

TEST(Npz, ArraysAboveTheSizeLimitAreNotUnpacked) {
  const auto content = serialize_npz({{"zeros", NpyArray(NpyType::float64, {1000, 1000})}},
                                     NpzCompression::deflated);
  EXPECT_LT(content.size(), 20'000u);
  const NpzReader reader(content, "a.npz");
  EXPECT_EQ(reader.read("zeros").size(), 1'000'000u);
  EXPECT_THAT(
      io_error_of([&] { reader.read("zeros", 1'000'000); }),
      testing::HasSubstr("entry 'zeros': found 8000128 bytes once unpacked; expected at most "
                         "1000000"));
}

TEST(Npz, RefusesToWriteArraysWithoutName) {
  EXPECT_THROW(serialize_npz({}), std::invalid_argument);
  EXPECT_THROW(serialize_npz({{"", NpyArray()}}), std::invalid_argument);
}

TEST(Npz, AWrongChecksumIsRejected) {
  FileBytes bytes = serialize_npz(two_arrays());
  const auto value = std::search_n(bytes.begin(), bytes.end(), 1, std::byte{7});
  ASSERT_NE(value, bytes.end());
  *value = std::byte{8};
  EXPECT_THAT(io_error_of([&] { parse_npz(bytes, "a.npz"); }), HasSubstr("entry 'raw'"));
}

TEST(Npz, ImpossibleSizesAreRejectedBeforeAllocation) {
  // The unpacked size is at byte 24 of the entry in the central directory.
  FileBytes bytes =
      serialize_npz({{"a", NpyArray(NpyType::float32, {1000})}}, NpzCompression::deflated);
  const FileBytes signature = bytes_of("PK\1\2");
  const auto entry = std::search(bytes.begin(), bytes.end(), signature.begin(), signature.end());
  ASSERT_NE(entry, bytes.end());
  std::fill(entry + 24, entry + 27, std::byte{0xff});
  EXPECT_THROW(parse_npz(bytes, "a.npz"), IoError);
  *(entry + 27) = std::byte{0xf0};
  EXPECT_THROW(parse_npz(bytes, "a.npz"), IoError);
}

TEST(Npz, ReportsProblemsWithTheFile) {
  const TemporaryDirectory directory;
  std::ofstream(directory / "a.npz") << "not an archive";
  EXPECT_THAT(io_error_of([&] { read_npz(directory / "a.npz"); }),
              HasSubstr("cannot read as an NPZ archive"));
  EXPECT_THAT(io_error_of([&] { read_npz(directory / "b.npz"); }), HasSubstr("no such file"));
  EXPECT_THAT(io_error_of([&] { read_npz(directory.path()); }), HasSubstr("a directory"));
}

}  // namespace
}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/npy.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <numeric>

#include "damaged_files.hpp"
#include "io/shared/read_file.hpp"
#include "temporary_directory.hpp"

namespace tofsmith {

namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Pads the header like NumPy.
FileBytes npy_file(std::string header, std::string_view data, int major = 1) {
  const std::size_t prefix = major == 1 ? 10 : 12;
  header.append(63 - (prefix + header.size()) % 64, ' ');
  header += '\n';
  std::string file = "\x93NUMPY";
  file += {static_cast<char>(major), '\0', static_cast<char>(header.size() & 0xff),
           static_cast<char>(header.size() >> 8)};
  if (major > 1) file.append(2, '\0');
  return bytes_of(file + header + std::string(data));
}

std::string refusal(const FileBytes& file) {
  return io_error_of([&] { parse_npy(file, "a.npy"); });
}

std::string descr_refusal(const std::string& descr) {
  return refusal(npy_file(
      fmt::format("{{'descr': {}, 'fortran_order': False, 'shape': (1,), }}", descr), "12345678"));
}

template <typename Item>
class NpyItem : public testing::Test {};
using Items = testing::Types<std::int8_t, std::int16_t, std::int32_t, std::int64_t, std::uint8_t,
                             std::uint16_t, std::uint32_t, std::uint64_t, float, double>;
TYPED_TEST_SUITE(NpyItem, Items);

TYPED_TEST(NpyItem, ReadingUndoesWriting) {
  const std::vector<TypeParam> values = {std::numeric_limits<TypeParam>::lowest(), 0, 1, 2, 3,
                                         std::numeric_limits<TypeParam>::max()};
  const auto array = NpyArray::of<TypeParam>({2, 3, 1}, values);
  const NpyArray back = parse_npy(serialize_npy(array), "a.npy");
  EXPECT_EQ(back.type(), npy_type_of<TypeParam>);
  EXPECT_THAT(back.shape(), ElementsAre(2, 3, 1));
  EXPECT_TRUE(std::ranges::equal(back.as<TypeParam>(), values));
  EXPECT_EQ(back.to_doubles()[5], static_cast<double>(values[5]));
  EXPECT_EQ(back.to_floats()[0], static_cast<float>(values[0]));
}

TYPED_TEST(NpyItem, ByteOrderDoesNotChangeValues) {
  const std::vector<TypeParam> values = {0, 1, 2, 100};
  FileBytes file = serialize_npy(NpyArray::of<TypeParam>({4}, values));
  const std::size_t items = file.size() - 4 * sizeof(TypeParam);
  for (auto item = file.begin() + static_cast<std::ptrdiff_t>(items); item != file.end();
       item += sizeof(TypeParam))
    std::reverse(item, item + sizeof(TypeParam));
  const auto order = std::ranges::find(file, std::byte{sizeof(TypeParam) == 1 ? '|' : '<'});
  *order = std::byte{'>'};
  EXPECT_TRUE(std::ranges::equal(parse_npy(file, "a.npy").as<TypeParam>(), values));
}

TEST(Npy, HeaderEqualsThatOfNumpy) {
  const std::vector<float> values = {1.0f, -2.0f};
  const std::string expected = std::string("\x93NUMPY\x01\x00v\x00", 10) +
                               "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 2), }" +
                               std::string(58, ' ') + "\n" +
                               std::string("\x00\x00\x80\x3f\x00\x00\x00\xc0", 8);
  EXPECT_EQ(serialize_npy(NpyArray::of<float>({1, 2}, values)), bytes_of(expected));
}

TEST(Npy, FortranOrderBecomesCOrder) {
  // Element (i, j, k) of shape (2, 3, 2) is 100 i + 10 j + k, stored with the first axis fastest.
  std::string data;
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 2; ++i) data += static_cast<char>(100 * i + 10 * j + k);
  const NpyArray array = parse_npy(
      npy_file("{'descr': '|u1', 'fortran_order': True, 'shape': (2, 3, 2)}", data), "a.npy");
  const auto items = array.as<std::uint8_t>();
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 2; ++k)
        EXPECT_EQ(items[(i * 3 + j) * 2 + k], 100 * i + 10 * j + k);
}

TEST(Npy, ReadsEveryVersionAndEverySpellingOfTheHeader) {
  const std::string data(24, '\1');
  for (const int version : {1, 2, 3}) {
    const auto array = parse_npy(
        npy_file("{'descr': '<u4', 'fortran_order': False, 'shape': (2, 3), }", data, version),
        "a.npy");
    EXPECT_THAT(array.shape(), ElementsAre(2, 3));
    EXPECT_EQ(array.as<std::uint32_t>()[5], 0x01010101u);
  }
  EXPECT_THAT(
      parse_npy(npy_file("{\"shape\":(2L,3L),\"fortran_order\":False,\"descr\":\"<i4\"}", data),
                "a.npy")
          .shape(),
      ElementsAre(2, 3));
  EXPECT_EQ(parse_npy(npy_file("{'descr': '<f8', 'fortran_order': False, 'shape': (), }",
                               data.substr(0, 8)),
                      "a.npy")
                .size(),
            1u);
  EXPECT_EQ(
      parse_npy(npy_file("{'descr': '<f8', 'fortran_order': True, 'shape': (0, 7), }", ""), "a.npy")
          .size(),
      0u);
}

TEST(Npy, BooleansAreZeroOrOne) {
  const auto array = parse_npy(
      npy_file("{'descr': '|b1', 'fortran_order': False, 'shape': (3,), }", {"\0\1\7", 3}),
      "a.npy");
  EXPECT_EQ(array.type(), NpyType::boolean);
  EXPECT_THAT(array.as<std::uint8_t>(), ElementsAre(0, 1, 1));
  EXPECT_THAT(array.to_floats(), ElementsAre(0.0f, 1.0f, 1.0f));
}

TEST(Npy, RejectsUnsupportedTypesByName) {
  EXPECT_THAT(descr_refusal("'|O'"), HasSubstr("Python objects"));
  EXPECT_THAT(descr_refusal("'<c8'"), HasSubstr("complex"));
  EXPECT_THAT(descr_refusal("[('x', '<f4'), ('y', '<f4')]"), HasSubstr("records"));
  EXPECT_THAT(descr_refusal("'<U2'"), HasSubstr("type '<U2'; expected one of bool"));
  EXPECT_THAT(descr_refusal("'<f16'"), HasSubstr("'<f16'"));
  EXPECT_THAT(descr_refusal("'|f4'"), HasSubstr("'|f4'"));
  EXPECT_THAT(descr_refusal("'=f4'"), HasSubstr("'=f4'"));
  EXPECT_THAT(descr_refusal("''"), HasSubstr("type ''"));
  EXPECT_THAT(descr_refusal("7"), HasSubstr("quoted"));
}

TEST(Npy, ErrorsNameFileAndByte) {
  EXPECT_THAT(refusal(bytes_of("PK\3\4 something else")), HasSubstr("a.npy: byte 0: "));
  EXPECT_THAT(refusal(bytes_of("\x93NUMPY\x04")), HasSubstr("byte 7"));
  EXPECT_THAT(
      refusal(npy_file("{'descr': '<f4', 'fortran_order': Maybe, 'shape': (1,), }", "1234")),
      HasSubstr("a.npy: byte 44: expected True or False"));
}

TEST(Npy, RefusesMalformedHeaders) {
  for (const char* header :
       {"", "{", "{}", "{'descr': '<f4', 'fortran_order': False}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (1,)",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (1,)} x",
        "{'descr': '<f4', 'descr': '<f4', 'fortran_order': False, 'shape': (1,)}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (1,), 'more': 1}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (1)}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': 1}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (-1,)}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (1.0,)}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (,)}",
        "{'descr': '<f4' 'fortran_order': False, 'shape': (1,)}",
        "{'descr': '<f4, 'fortran_order': False, 'shape': (1,)}"})
    EXPECT_THAT(refusal(npy_file(header, "1234")), HasSubstr("a.npy: byte ")) << header;
}

TEST(Npy, RefusesShapesThatDoNotMatchTheData) {
  const auto shape_refusal = [](const std::string& shape) {
    return refusal(
        npy_file(fmt::format("{{'descr': '<f4', 'fortran_order': False, 'shape': {}, }}", shape),
                 "12345678"));
  };
  EXPECT_THAT(shape_refusal("(3,)"), HasSubstr("found 8 bytes of data; expected 12"));
  EXPECT_THAT(shape_refusal("(1,)"), HasSubstr("found 8 bytes of data; expected 4"));
  EXPECT_THAT(shape_refusal("(99999999999999999999,)"), HasSubstr("longer than memory"));
  EXPECT_THAT(shape_refusal("(4294967296, 4294967296)"), HasSubstr("fits in memory"));
  EXPECT_THAT(shape_refusal("(4611686018427387905,)"), HasSubstr("fits in memory"));
  EXPECT_THAT(shape_refusal("(1000000, 1000000)"), HasSubstr("expected 4000000000000"));
}

TEST(Npy, RefusesEveryTruncation) {
  const std::vector<float> values = {1, 2, 3};
  expect_truncations_refused(serialize_npy(NpyArray::of<float>({3}, values)),
                             [](auto bytes) { parse_npy(bytes, "a.npy"); });
}

TEST(Npy, TypedAccessChecksTheType) {
  const NpyArray array(NpyType::float32, {2});
  EXPECT_THROW(array.as<double>(), std::invalid_argument);
  EXPECT_THROW(NpyArray::of<float>({3}, array.as<float>()), std::invalid_argument);
  EXPECT_THROW(NpyArray(NpyType::float32, {1ull << 40, 1ull << 40}), std::invalid_argument);
}

TEST(NpyReader, ReadsBothAxisOrders) {
  const TemporaryDirectory directory;
  std::vector<float> values(5 * 2 * 3);
  std::iota(values.begin(), values.end(), 0.0f);
  write_npy(directory / "c.npy", NpyArray::of<float>({5, 2, 3}, values), OutputPolicy::overwrite);
  std::vector<float> columns;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t j = 0; j < 2; ++j)
      for (std::size_t i = 0; i < 5; ++i) columns.push_back(values[(i * 2 + j) * 3 + k]);
  const auto column_bytes = std::as_bytes(std::span(columns));
  write_file_atomically(
      directory / "f.npy",
      npy_file("{'descr': '<f4', 'fortran_order': True, 'shape': (5, 2, 3), }",
               {reinterpret_cast<const char*>(column_bytes.data()), column_bytes.size()}),
      OutputPolicy::overwrite);

  for (const char* name : {"c.npy", "f.npy"}) {
    const NpyReader reader(directory / name);
    EXPECT_THAT(reader.shape(), ElementsAre(5, 2, 3));
    EXPECT_TRUE(std::ranges::equal(reader.read_all().as<float>(), values));
  }
}

TEST(NpyReader, RejectsFilesOfOtherLengthThanTheHeaderStates) {
  const TemporaryDirectory directory;
  FileBytes file = serialize_npy(NpyArray(NpyType::float64, {100, 100}));
  file.pop_back();
  write_file_atomically(directory / "a.npy", file, OutputPolicy::overwrite);
  EXPECT_THAT(io_error_of([&] { NpyReader(directory / "a.npy"); }),
              HasSubstr("found 79999 bytes of data; expected 80000"));
  EXPECT_THAT(io_error_of([&] { NpyReader(directory / "b.npy"); }), HasSubstr("no such file"));
}

TEST(NpyReader, DetectsAFileThatShrinks) {
  const TemporaryDirectory directory;
  write_npy(directory / "a.npy", NpyArray(NpyType::float64, {10, 10}), OutputPolicy::overwrite);
  const NpyReader reader(directory / "a.npy");
  std::filesystem::resize_file(directory / "a.npy", 500);
  EXPECT_THAT(io_error_of([&] { reader.read_all(); }), HasSubstr("the file ends here"));
}

TEST(NpyReader, ReadsAnyItemsInBothByteOrders) {
  const TemporaryDirectory directory;
  for (const char order : {'<', '>'}) {
    const std::string items =
        order == '<' ? std::string("\1\0\2\0\3\0", 6) : std::string("\0\1\0\2\0\3", 6);
    write_file_atomically(
        directory / "a.npy",
        npy_file(fmt::format("{{'descr': '{}u2', 'fortran_order': False, 'shape': (3,), }}", order),
                 items),
        OutputPolicy::overwrite);
    const NpyReader reader(directory / "a.npy");
    std::array<std::uint16_t, 2> values{};
    reader.read_items(1, std::as_writable_bytes(std::span(values)));
    EXPECT_THAT(values, ElementsAre(2, 3));
    EXPECT_THROW(reader.read_items(2, std::as_writable_bytes(std::span(values))),
                 std::invalid_argument);
    EXPECT_THROW(reader.read_items(0, std::as_writable_bytes(std::span(values)).first(3)),
                 std::invalid_argument);
  }
}

TEST(NpyItemWriter, PiecesGiveTheFileOfTheWholeArray) {
  const TemporaryDirectory directory;
  std::vector<std::int32_t> values(2 * 3 * 4);
  std::iota(values.begin(), values.end(), -5);
  const auto bytes = std::as_bytes(std::span(values));
  NpyItemWriter writer(directory / "a.npy", NpyType::int32, {2, 3, 4},
                       OutputPolicy::refuse_existing);
  writer.append(bytes.first(20));
  EXPECT_THROW(writer.append(bytes.first(3)), std::invalid_argument);
  EXPECT_THROW(writer.append(bytes.first(80)), std::invalid_argument);
  EXPECT_THROW(writer.commit(), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(directory / "a.npy"));
  writer.append(bytes.subspan(20));
  writer.commit();
  write_npy(directory / "b.npy", NpyArray::of<std::int32_t>({2, 3, 4}, values),
            OutputPolicy::refuse_existing);
  EXPECT_EQ(read_binary_file(directory / "a.npy"), read_binary_file(directory / "b.npy"));
}

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

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/npy.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
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
FileBytes npy_file(std::string header, std::string_view data) {
  header.append(63 - (10 + header.size()) % 64, ' ');
  header += '\n';
  std::string file = "\x93NUMPY";
  file +=
      {'\1', '\0', static_cast<char>(header.size() & 0xff), static_cast<char>(header.size() >> 8)};
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

TEST(Npy, ReadsEverySpellingOfTheHeader) {
  const std::string header = "{\"shape\":(2L,3L),\"fortran_order\":False,\"descr\":\"<i4\"}";
  EXPECT_THAT(parse_npy(npy_file(header, std::string(24, '\1')), "a.npy").shape(),
              ElementsAre(2, 3));
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

// Files are exchanged between this library and NumPy of Debian's python3 (numpy_exchange.py).

constexpr auto overwrite = OutputPolicy::overwrite;

bool python_agrees(const std::string& step, const std::filesystem::path& directory) {
  const std::string command =
      fmt::format("/usr/bin/python3 '{}/tests/io/numpy_exchange.py' {} '{}'", TOFSMITH_SOURCE_DIR,
                  step, directory.string());
  return std::system(command.c_str()) == 0;
}

template <typename Item>
NpyArray counting(NpyShape shape) {
  NpyArray array(npy_type_of<Item>, shape);
  std::vector<Item> values(array.size());
  std::iota(values.begin(), values.end(), Item{0});
  return NpyArray::of<Item>(shape, values);
}

NpzArrays counting_arrays() {
  return {{"i1", counting<std::int8_t>({2, 3, 4})},   {"i2", counting<std::int16_t>({2, 3, 4})},
          {"i4", counting<std::int32_t>({2, 3, 4})},  {"i8", counting<std::int64_t>({2, 3, 4})},
          {"u1", counting<std::uint8_t>({2, 3, 4})},  {"u2", counting<std::uint16_t>({2, 3, 4})},
          {"u4", counting<std::uint32_t>({2, 3, 4})}, {"u8", counting<std::uint64_t>({2, 3, 4})},
          {"f4", counting<float>({2, 3, 4})},         {"f8", counting<double>({2, 3, 4})},
          {"scalar", counting<double>({})},           {"empty", counting<double>({0, 5})},
          {"line", counting<float>({12345})}};
}

TEST(NumpyExchange, NumpyReadsOurFilesAndWritesTheSameBytes) {
  const TemporaryDirectory directory;
  for (const auto& [name, array] : counting_arrays())
    write_npy(directory / (name + ".npy"), array, overwrite);
  NpyItemWriter writer(directory / "f4.streamed.npy", NpyType::float32, {2, 3, 4}, overwrite);
  const NpyArray all = counting<float>({2, 3, 4});
  writer.append(all.bytes().first(20));
  writer.append(all.bytes().subspan(20));
  writer.commit();
  write_npz(directory / "stored.npz", counting_arrays(), overwrite);
  write_npz(directory / "deflated.npz", counting_arrays(), overwrite, NpzCompression::deflated);
  EXPECT_TRUE(python_agrees("check", directory.path()));
}

TEST(NumpyExchange, ReadsNumpyFilesOfEveryTypeOrderAndVersion) {
  const TemporaryDirectory directory;
  ASSERT_TRUE(python_agrees("write", directory.path()));
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(directory.path())) {
    if (entry.path().extension() != ".npy") continue;
    const std::string name = entry.path().filename().string();
    const std::string type = name.substr(0, name.find('.'));
    EXPECT_EQ(serialize_npy(read_npy(entry.path())), serialize_npy(counting_arrays().at(type)))
        << name;
    ++files;
  }
  EXPECT_EQ(files, 10 * 2 * 2 * 3 + 3);
  for (const char* name : {"stored.npz", "deflated.npz"}) {
    const NpzArrays arrays = read_npz(directory / name);
    EXPECT_EQ(arrays.size(), counting_arrays().size());
    for (const auto& [entry, array] : counting_arrays())
      EXPECT_EQ(serialize_npy(arrays.at(entry)), serialize_npy(array)) << entry;
  }
}

}  // namespace

}  // namespace tofsmith

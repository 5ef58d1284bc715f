// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <numeric>

#include "damaged_files.hpp"
#include "io/arrays/shared/array_matrix.hpp"
#include "temporary_directory.hpp"
#include "tofsmith/io/raw_frames.hpp"

namespace tofsmith {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr std::uint64_t plenty = 1 << 20;

/// A data set of the numbers 0, 1, 2, ... with items of type `stored`.
struct Numbers {
  std::string name;
  std::vector<hsize_t> shape;
  hid_t stored = H5T_STD_U16LE;
  std::vector<hsize_t> chunk;  // empty: contiguous
  bool deflate = false;
  bool written = true;
};

void write(const std::filesystem::path& path, const std::vector<Numbers>& all) {
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  const hid_t with_groups = H5Pcreate(H5P_LINK_CREATE);
  H5Pset_create_intermediate_group(with_groups, 1);
  for (const Numbers& one : all) {
    const hid_t space =
        H5Screate_simple(static_cast<int>(one.shape.size()), one.shape.data(), nullptr);
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    if (!one.chunk.empty())
      H5Pset_chunk(properties, static_cast<int>(one.chunk.size()), one.chunk.data());
    if (one.deflate) H5Pset_deflate(properties, 4);
    const hid_t dataset =
        H5Dcreate2(file, one.name.c_str(), one.stored, space, with_groups, properties, H5P_DEFAULT);
    ASSERT_GE(dataset, 0) << one.name;
    std::vector<double> values(
        std::accumulate(one.shape.begin(), one.shape.end(), std::size_t{1}, std::multiplies<>()));
    std::iota(values.begin(), values.end(), 0.0);
    if (one.written)
      H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Dclose(dataset);
    H5Pclose(properties);
    H5Sclose(space);
  }
  H5Pclose(with_groups);
  H5Fclose(file);
}

TEST(Hdf5, ReadsAnyRangeOfAnyTypeInAnyChunks) {
  const TemporaryDirectory directory;
  const std::vector<hsize_t> shape = {2, 3, 5, 4};  // 120 numbers, which fit int8
  for (const hid_t stored :
       {H5T_STD_I8LE, H5T_STD_U8BE, H5T_STD_I16BE, H5T_STD_U16LE, H5T_STD_I32LE, H5T_STD_U32BE,
        H5T_STD_I64LE, H5T_STD_U64LE, H5T_IEEE_F32BE, H5T_IEEE_F32LE, H5T_IEEE_F64LE})
    for (const std::vector<hsize_t>& chunk :
         {std::vector<hsize_t>{}, {1, 2, 2, 3}, {2, 3, 5, 4}, {1, 1, 1, 1}}) {
      write(directory / "a.h5", {{.name = "raw",
                                  .shape = shape,
                                  .stored = stored,
                                  .chunk = chunk,
                                  .deflate = !chunk.empty()}});
      const StoredArray array = open_hdf5(directory / "a.h5", "", plenty);
      ASSERT_EQ(array.shape, (NpyShape{2, 3, 5, 4}));
      for (const std::size_t first : {0u, 1u, 20u, 37u, 60u})
        for (const std::size_t count : {0u, 1u, 7u, 20u, 59u}) {
          NpyArray read(array.type, {count});
          array.read_items(first, read.bytes());
          std::vector<double> expected(count);
          std::iota(expected.begin(), expected.end(), static_cast<double>(first));
          EXPECT_EQ(read.to_doubles(), expected) << first;
        }
    }
}

TEST(Hdf5, FramesEqualThoseOfTheSameArrayInNpy) {
  const TemporaryDirectory directory;
  std::vector<std::uint16_t> values(2 * 6 * 5 * 4);
  std::iota(values.begin(), values.end(), std::uint16_t{0});
  write_npy(directory / "a.npy", NpyArray::of<std::uint16_t>({2, 6, 5, 4}, values),
            OutputPolicy::overwrite);
  write(directory / "a.hdf5", {{.name = "raw", .shape = {2, 6, 5, 4}, .chunk = {1, 4, 3, 2}}});
  const RawFramesReader peer(directory / "a.npy"), reader(directory / "a.hdf5");
  EXPECT_EQ(reader.type(), peer.type());
  EXPECT_TRUE(reader.holds_integers());
  std::vector<std::byte> ours, theirs;
  for (int frame = 0; frame < 2; ++frame)
    for (const int row : {0, 3}) {
      reader.read_rows(frame, row, 3, ours);
      peer.read_rows(frame, row, 3, theirs);
      EXPECT_EQ(ours, theirs);
    }
}

TEST(Hdf5, UsesTheDataSetNamedRawOrTheOnlyOneOrTheGivenOne) {
  const TemporaryDirectory directory;
  const auto first_of = [&](const std::vector<Numbers>& all, const std::string& asked) {
    write(directory / "a.h5", all);
    return open_hdf5(directory / "a.h5", asked, plenty).shape[0];
  };
  const Numbers raw{.name = "raw", .shape = {2, 2}}, other{.name = "cam/quads", .shape = {3, 2}},
      text{.name = "temperatures", .shape = {5}};
  EXPECT_EQ(first_of({other, text}, ""), 3u);
  EXPECT_EQ(first_of({other, raw}, ""), 2u);
  EXPECT_EQ(first_of({other, raw}, "cam/quads"), 3u);
  EXPECT_EQ(first_of({other, raw}, "/cam/quads"), 3u);
  EXPECT_THAT(io_error_of([&] {
                first_of({other, raw}, "depth");
              }),
              AllOf(HasSubstr("a.h5: there is no data set depth"), HasSubstr("cam/quads (3, 2)")));
  EXPECT_THAT(io_error_of([&] {
                first_of({other, {.name = "cam/dark", .shape = {1, 2}}}, "");
              }),
              AllOf(HasSubstr("cam/dark (1, 2), cam/quads (3, 2)"), HasSubstr("--dataset")));
  EXPECT_THAT(io_error_of([&] { first_of({text}, ""); }), HasSubstr("no data set of numbers"));
}

TEST(Hdf5, RejectsUnwrittenDataAndOversizedChunks) {
  const TemporaryDirectory directory;
  write(directory / "a.h5",
        {{.name = "raw", .shape = {1000, 1000}, .chunk = {10, 10}, .written = false}});
  EXPECT_THAT(io_error_of([&] { open_hdf5(directory / "a.h5", "", plenty); }),
              HasSubstr("data set raw: found no data in (1000, 1000)"));
  write(directory / "b.h5",
        {{.name = "raw", .shape = {1000, 1000}, .chunk = {1000, 1000}, .deflate = true}});
  EXPECT_THAT(io_error_of([&] { open_hdf5(directory / "b.h5", "", plenty); }),
              AllOf(HasSubstr("chunks of 2 MB"), HasSubstr("--memory-mb")));
  EXPECT_EQ(open_hdf5(directory / "b.h5", "", 4 * plenty).bytes_in_memory, 4u * plenty);
}

TEST(Hdf5, DoesNotFollowLinksToOtherFiles) {
  const TemporaryDirectory directory;
  write(directory / "secret.h5", {{.name = "raw", .shape = {2, 2}}});
  {
    const hid_t file =
        H5Fcreate((directory / "a.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_external((directory / "secret.h5").c_str(), "raw", file, "raw", H5P_DEFAULT,
                       H5P_DEFAULT);
    H5Fclose(file);
  }
  EXPECT_THAT(io_error_of([&] { open_hdf5(directory / "a.h5", "raw", plenty); }),
              HasSubstr("there is no data set raw"));
}

TEST(Hdf5, ReportsFilesThatAreNotHdf5) {
  const TemporaryDirectory directory;
  const auto message = [&](const std::string& name) {
    return io_error_of([&] { RawFramesReader(directory / name); });
  };
  EXPECT_THAT(message("missing.h5"), HasSubstr("missing.h5: there is no such file"));
  std::ofstream(directory / "text.h5") << "no arrays here";
  EXPECT_THAT(message("text.h5"), HasSubstr("text.h5: cannot be read as an HDF5 file"));
  std::filesystem::create_directory(directory / "folder.h5");
  EXPECT_THAT(message("folder.h5"), HasSubstr("found no file"));
  write_npy(directory / "a.npy", NpyArray(NpyType::uint8, {2, 2, 3}), OutputPolicy::overwrite);
  EXPECT_THAT(io_error_of([&] { RawFramesReader(directory / "a.npy", {.dataset = "raw"}); }),
              AllOf(HasSubstr("a.npy"), HasSubstr("the data set 'raw' was requested")));
}

// Randomly damaged files are not tested, because libhdf5 1.10 itself then accesses invalid memory
// (docs/reliability.md).
TEST(Hdf5, RejectsTruncatedFiles) {
  const TemporaryDirectory directory;
  for (const bool in_chunks : {false, true}) {
    write(directory / "a.h5",
          {{.name = "cam/raw",
            .shape = {3, 4, 5},
            .chunk = in_chunks ? std::vector<hsize_t>{2, 2, 5} : std::vector<hsize_t>{},
            .deflate = in_chunks}});
    const std::uintmax_t whole = std::filesystem::file_size(directory / "a.h5");
    for (std::uintmax_t length = 0; length < whole; length += 61) {
      std::filesystem::copy_file(directory / "a.h5", directory / "b.h5",
                                 std::filesystem::copy_options::overwrite_existing);
      std::filesystem::resize_file(directory / "b.h5", length);
      EXPECT_THROW(read_raw_frames(directory / "b.h5"), IoError) << length;
    }
  }
}

}  // namespace
}  // namespace tofsmith

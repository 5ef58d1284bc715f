// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <numeric>

#include "io/shared/read_file.hpp"
#include "temporary_directory.hpp"
#include "tofsmith/io/npy.hpp"

// Files are exchanged between this library and NumPy of Debian's python3 (numpy_exchange.py).

namespace tofsmith {
namespace {

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

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <span>

#include "damaged_files.hpp"
#include "io/shared/read_file.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

/// Does not synchronize the disk, unlike an atomic file.
inline void overwrite_bytes(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
}

/// Truncates and damages a file: `read` must return, or throw an IoError that names a file of the
/// directory. Restores the file.
/// @param damages  number of damaged copies
inline void expect_damage_of_file_read_or_refused(const std::filesystem::path& directory,
                                                  const std::filesystem::path& file,
                                                  std::uint64_t damages,
                                                  const std::function<void()>& read) {
  SCOPED_TRACE(file);
  const FileBytes whole = read_binary_file(file);
  int refused = 0;
  const auto read_or_refuse = [&] {
    try {
      read();
    } catch (const IoError& error) {
      ++refused;
      EXPECT_THAT(error.what(), testing::HasSubstr(directory.string()));
    }
  };
  for (std::size_t length = 0; length + 2 < whole.size(); length += 1 + whole.size() / 40) {
    overwrite_bytes(file, std::span(whole).first(length));
    EXPECT_NO_THROW(read_or_refuse()) << "cut after " << length;
  }
  EXPECT_GT(refused, 20);
  for (std::uint64_t i = 0; i < damages; ++i) {
    RandomStream random(4, i);
    overwrite_bytes(file, damaged(whole, random));
    EXPECT_NO_THROW(read_or_refuse()) << "damaged, case " << i;
  }
  overwrite_bytes(file, whole);
}

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "tofsmith/io/raw_frames.hpp"

namespace tofsmith {

/// Reads rows of the frames of a dump in the memory of those rows.
class RawDumpReader {
 public:
  /// @throws IoError if the file cannot be read or is not as long as the format says
  /// @param marking  replaces numbers of the file that are no measurement
  RawDumpReader(const std::filesystem::path& path, RawFormat format, RawMarking marking = {});
  /// Of bytes that stay where they are and may change between calls, as many as the format's
  /// frames.
  RawDumpReader(std::span<const std::byte> bytes, RawFormat format, RawMarking marking = {});

  const RawFormat& format() const { return format_; }
  int frames() const { return frames_; }

  /// Reads rows first_row .. first_row + rows - 1 of the scene, (rows, W, K) numbers, the
  /// measurements of a pixel side by side and in order, with rotation, signs, black level and
  /// differences applied.
  /// @throws IoError if the file cannot be read or became shorter, or if a number exceeds its bits
  template <typename Number>
  void read_rows(int frame, int first_row, int rows, Number* numbers) const;

  /// Additional memory per row of a read [bytes]; 0 if the rows are read one by one.
  std::size_t block_row_bytes() const;

 private:
  /// Rows of the scene, and memory for a row of the file.
  struct Block {
    std::vector<double> pixels, numbers;
    std::vector<std::byte> bytes;
  };
  void read_block(int frame, int first_row, int rows, Block& block) const;
  void read_file_row(int frame, std::size_t image, std::size_t row, std::vector<std::byte>& bytes,
                     std::vector<double>& numbers) const;

  std::string source_;  ///< in errors
  std::function<void(std::uint64_t offset, std::span<std::byte> into)> read_at_;
  RawFormat format_;
  RawMarking marking_;
  int frames_ = 0;
};

}  // namespace tofsmith

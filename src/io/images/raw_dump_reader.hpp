// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
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

  /// Rows first_row .. first_row + rows - 1 as they stand in the scene, (rows, W, K) numbers, the
  /// measurements of a pixel side by side and in order, black level and differences taken.
  /// @throws IoError if the file cannot be read or became shorter
  template <typename Number>
  void read_rows(int frame, int first_row, int rows, Number* numbers) const;

 private:
  void read_file_row(int frame, std::size_t image, std::size_t row, std::vector<std::byte>& bytes,
                     std::vector<double>& numbers) const;

  std::function<void(std::uint64_t offset, std::span<std::byte> into)> read_at_;
  RawFormat format_;
  RawMarking marking_;
  int frames_ = 0;
};

}  // namespace tofsmith

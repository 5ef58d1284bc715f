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

#include "tofsmith/io/npy.hpp"
#include "tofsmith/io/raw_frames.hpp"

namespace tofsmith {

/// Checks type and shape, and returns the sizes without values.
/// @throws IoError if the type or shape is not one of raw frames, or K differs from the code's
RawFrames checked_raw_sizes(NpyType type, const NpyShape& shape, const RawReadOptions& options,
                            const std::string& file);

/// @throws IoError if the measurements of a dump differ from the code's
void check_measurements(const RawFormat& format, int expected, const std::string& file);

bool is_unsigned(NpyType type);

/// @throws IoError if the file's type cannot represent a marker
void check_markers(const RawMarkers& markers, NpyType type, const std::string& file);
void check_markers(const RawMarkers& markers, const RawFormat& format, const std::string& file);

/// Needs memory for the requested rows only.
class RawDumpReader {
 public:
  /// @throws IoError if the file cannot be read or its length does not match the format
  /// @param marking  replaces numbers of the file that are not measurements
  RawDumpReader(const std::filesystem::path& path, RawFormat format, RawMarking marking = {});
  /// Reads from memory with the length of the format's frames. The address must stay valid; the
  /// content may change between calls.
  RawDumpReader(std::span<const std::byte> bytes, RawFormat format, RawMarking marking = {});

  const RawFormat& format() const { return format_; }
  int frames() const { return frames_; }

  /// Reads rows first_row to first_row + rows - 1 of the scene, (rows, W, K), with the measurements
  /// of a pixel adjacent and in order. Applies rotation, signs, black level and differences.
  /// @throws IoError if the file cannot be read or became shorter, or if a number exceeds its bits
  template <typename Number>
  void read_rows(int frame, int first_row, int rows, Number* numbers) const;

  /// Additional memory per row [bytes]; 0 if rows are read one by one.
  std::size_t block_row_bytes() const;

 private:
  struct Block {
    std::vector<double> pixels, numbers;
    std::vector<std::byte> bytes;
  };
  void read_block(int frame, int first_row, int rows, Block& block) const;
  void read_file_row(int frame, std::size_t image, std::size_t row, std::vector<std::byte>& bytes,
                     std::vector<double>& numbers) const;

  std::string source_;  ///< name in errors
  std::function<void(std::uint64_t offset, std::span<std::byte> into)> read_at_;
  RawFormat format_;
  RawMarking marking_;
  int frames_ = 0;
};

}  // namespace tofsmith

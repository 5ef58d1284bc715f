// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "tofsmith/io/npy.hpp"

namespace tofsmith {

/// Reads an NPY file in slices along its first axis, for recordings larger than memory.
class NpyReader {
 public:
  /// Reads the header and checks that the file is as long as it says.
  /// @throws IoError as read_npy()
  explicit NpyReader(const std::filesystem::path& path);
  ~NpyReader();
  NpyReader(NpyReader&&) noexcept;

  NpyType type() const;
  const NpyShape& shape() const;
  /// The file has its first axis fastest, so that slices are slow.
  bool fortran_order() const;

  /// Slices [begin, begin + count) of the first axis, shape (count, ...), C order. Memory and time
  /// grow with the slice; a file in Fortran order is slow, one read per item of a slice.
  /// @throws std::invalid_argument if the array has no axes or the slices do not exist
  /// @throws IoError if the file cannot be read or became shorter
  NpyArray read_rows(std::size_t begin, std::size_t count) const;
  /// The whole array.
  NpyArray read_all() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Writes an NPY file slice by slice along its first axis, whose length need not be known before.
/// The file appears at commit(), as with AtomicFile.
class NpyWriter {
 public:
  /// @param row_shape  shape of one slice
  /// @throws IoError as AtomicFile does
  NpyWriter(const std::filesystem::path& path, NpyType type, NpyShape row_shape,
            OutputPolicy policy);

  /// Appends slices, shape (count, row_shape...).
  /// @throws std::invalid_argument if type or shape differ
  void append(const NpyArray& rows);
  /// Writes the final shape and gives the file its name. Call it once, last.
  void commit();
  std::size_t rows() const { return rows_; }

 private:
  AtomicFile file_;
  NpyType type_;
  NpyShape row_shape_;
  std::size_t rows_ = 0;
};

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

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
  /// Fills `into` with items from item `first` on, in the order in which the file has them and in
  /// this machine's byte order: memory is the caller's.
  /// @throws std::invalid_argument if there are not as many, or `into` ends within an item
  /// @throws IoError if the file cannot be read or became shorter
  void read_items(std::size_t first, std::span<std::byte> into) const;

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

/// Writes an NPY file of a known shape piece by piece, in pieces that need not end where an axis
/// does. The file appears at commit(), as with AtomicFile.
class NpyItemWriter {
 public:
  /// @throws IoError as AtomicFile does
  NpyItemWriter(const std::filesystem::path& path, NpyType type, const NpyShape& shape,
                OutputPolicy policy);

  /// Appends whole items of this machine's byte order, in C order.
  /// @throws std::invalid_argument if there are more than the shape has room for
  void append(std::span<const std::byte> items);
  /// Gives the file its name. Call it once, last.
  /// @throws std::invalid_argument if items are missing
  void commit();

 private:
  AtomicFile file_;
  NpyType type_;
  std::size_t missing_bytes_;
};

}  // namespace tofsmith

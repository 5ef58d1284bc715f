// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/core/hidden.hpp"
#include "tofsmith/io/atomic_file.hpp"

namespace tofsmith {

/// Type of the items of an array.
enum class NpyType {
  boolean,
  int8,
  int16,
  int32,
  int64,
  uint8,
  uint16,
  uint32,
  uint64,
  float16,
  float32,
  float64
};

/// Size of an item [bytes].
std::size_t item_size(NpyType type);
/// NumPy's name of the type, such as "float32" or "bool".
std::string_view name_of(NpyType type);
/// Returns true for floating-point types.
bool is_float(NpyType type);

/// Length of every axis, slowest first; empty for a scalar.
using NpyShape = std::vector<std::size_t>;
/// Returns the shape in Python notation: "(480, 640, 4)".
std::string describe_shape(const NpyShape& shape);

/// Type of array items of C++ type `Item`.
template <typename Item>
inline constexpr NpyType npy_type_of = Item::is_no_type_of_numpy;
template <>
inline constexpr NpyType npy_type_of<std::int8_t> = NpyType::int8;
template <>
inline constexpr NpyType npy_type_of<std::int16_t> = NpyType::int16;
template <>
inline constexpr NpyType npy_type_of<std::int32_t> = NpyType::int32;
template <>
inline constexpr NpyType npy_type_of<std::int64_t> = NpyType::int64;
template <>
inline constexpr NpyType npy_type_of<std::uint8_t> = NpyType::uint8;
template <>
inline constexpr NpyType npy_type_of<std::uint16_t> = NpyType::uint16;
template <>
inline constexpr NpyType npy_type_of<std::uint32_t> = NpyType::uint32;
template <>
inline constexpr NpyType npy_type_of<std::uint64_t> = NpyType::uint64;
template <>
inline constexpr NpyType npy_type_of<float> = NpyType::float32;
template <>
inline constexpr NpyType npy_type_of<double> = NpyType::float64;

/// A dense array in NumPy's layout: native byte order, last axis fastest.
class NpyArray {
 public:
  /// Creates an array of shape (0,).
  NpyArray() : NpyArray(NpyType::float64, {0}) {}
  /// Array of zeros. @throws std::invalid_argument if its size exceeds the address space
  NpyArray(NpyType type, NpyShape shape);
  /// Copies `values`. @throws std::invalid_argument if their number differs from that of `shape`
  template <typename Item>
  static NpyArray of(NpyShape shape, std::span<const Item> values) {
    NpyArray array(npy_type_of<Item>, std::move(shape));
    array.fill(std::as_bytes(values));
    return array;
  }

  NpyType type() const { return type_; }
  const NpyShape& shape() const { return shape_; }
  std::size_t axes() const { return shape_.size(); }
  /// Number of items.
  std::size_t size() const { return bytes_.size() / item_size(type_); }

  std::span<const std::byte> bytes() const { return bytes_; }
  std::span<std::byte> bytes() { return bytes_; }

  /// Returns the items; booleans as uint8. @throws std::invalid_argument if the type differs
  template <typename Item>
  std::span<const Item> as() const {
    check_type(npy_type_of<Item>);
    return {reinterpret_cast<const Item*>(bytes_.data()), size()};
  }

  /// Return the items, converted from any type.
  std::vector<double> to_doubles() const;
  std::vector<float> to_floats() const;

 private:
  void fill(std::span<const std::byte> values);
  void check_type(NpyType asked) const;

  NpyType type_;
  NpyShape shape_;
  std::vector<std::byte> bytes_;
};

/// Reads format versions 1.0 to 3.0. Fortran order is converted to C order.
/// @throws IoError at a byte offset if the header is malformed, the items are objects, records,
///         text or complex numbers, or the length differs from the header
NpyArray parse_npy(std::span<const std::byte> content, std::string_view file);
NpyArray read_npy(const std::filesystem::path& path);

/// Writes format version 1.0, little endian, C order, with the same bytes as NumPy 1.24.
std::vector<std::byte> serialize_npy(const NpyArray& array);
void write_npy(const std::filesystem::path& path, const NpyArray& array, OutputPolicy policy);

/// Reads parts of an NPY file larger than memory.
class NpyReader {
 public:
  /// Checks header and length. @throws IoError as read_npy()
  explicit NpyReader(const std::filesystem::path& path);

  NpyType type() const;
  const NpyShape& shape() const;
  /// Returns true if the first axis is the fastest in the file.
  bool fortran_order() const;

  NpyArray read_all() const;
  /// Reads items from item `first` on, in the order of the file and native byte order.
  /// @throws std::invalid_argument if there are too few items, or `into` does not end with an item
  void read_items(std::size_t first, std::span<std::byte> into) const;

 private:
  struct State;
  Hidden<State> state_;
};

/// Writes an NPY file of a given shape in pieces, see AtomicFile.
class NpyItemWriter {
 public:
  NpyItemWriter(const std::filesystem::path& path, NpyType type, const NpyShape& shape,
                OutputPolicy policy);

  /// Appends items in native byte order and C order. @throws std::invalid_argument if there are too
  /// many
  void append(std::span<const std::byte> items);
  /// Must be called once, last. @throws std::invalid_argument if items are missing
  void commit();

 private:
  AtomicFile file_;
  NpyType type_;
  std::size_t missing_bytes_;
};

/// Default maximum size of an array [bytes].
inline constexpr std::uint64_t max_npz_array_bytes = std::uint64_t{1} << 29;
/// Maximum total unpacked size of the arrays [bytes]: a few kilobytes can unpack to any size.
inline constexpr std::uint64_t max_npz_bytes = std::uint64_t{1} << 34;

/// Reads an NPZ archive, stored or deflated, and unpacks each array on request.
/// @note not thread-safe
class NpzReader {
 public:
  /// @throws IoError if the file is not a ZIP archive, a name occurs twice, or the total size of
  ///         the arrays exceeds max_npz_bytes
  explicit NpzReader(const std::filesystem::path& path);
  /// @param content  must outlive the reader
  NpzReader(std::span<const std::byte> content, std::string_view file);

  /// Names without ".npy", in the archive's order.
  const std::vector<std::string>& names() const;
  bool contains(std::string_view name) const;
  /// Unpacked size including the header [bytes]. @throws IoError if there is no such array
  std::uint64_t unpacked_bytes(std::string_view name) const;
  /// @throws IoError as parse_npy(), or if the array is missing, larger than `max_bytes` or damaged
  NpyArray read(std::string_view name, std::uint64_t max_bytes = max_npz_array_bytes) const;

 private:
  struct State;
  Hidden<State> state_;
};

using NpzArrays = std::map<std::string, NpyArray>;

/// Reads all arrays of an archive. @throws IoError as NpzReader
NpzArrays parse_npz(std::span<const std::byte> content, std::string_view file);
NpzArrays read_npz(const std::filesystem::path& path);

enum class NpzCompression { stored, deflated };

/// Equal arrays give equal bytes, independent of the date.
/// @throws std::invalid_argument if there are no arrays or a name is empty
std::vector<std::byte> serialize_npz(const NpzArrays& arrays,
                                     NpzCompression compression = NpzCompression::stored);
void write_npz(const std::filesystem::path& path, const NpzArrays& arrays, OutputPolicy policy,
               NpzCompression compression = NpzCompression::stored);

}  // namespace tofsmith

// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/io/atomic_file.hpp"

namespace tofsmith {

/// What one item of an array is.
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
  float16,  ///< IEEE half precision; C++ has no type for its items, which to_floats() converts
  float32,
  float64
};

/// Bytes that one item takes.
std::size_t item_size(NpyType type);
/// NumPy's name of the type, such as "float32" or "bool".
std::string_view name_of(NpyType type);
/// Returns true for floats of any size.
bool is_float(NpyType type);

/// Length of every axis, slowest first; empty for a single number.
using NpyShape = std::vector<std::size_t>;
/// As Python writes it: "(480, 640, 4)".
std::string describe_shape(const NpyShape& shape);

/// The type under which items of C++ type `Item` are stored.
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

/// A dense array as NumPy stores it: items of this machine's byte order, last axis fastest.
class NpyArray {
 public:
  /// An array of shape (0,).
  NpyArray() : NpyArray(NpyType::float64, {0}) {}
  /// Zeros. @throws std::invalid_argument if the shape has more bytes than memory has addresses
  NpyArray(NpyType type, NpyShape shape);
  /// A copy of `values`. @throws std::invalid_argument unless they are as many as `shape` says
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

  /// The items. @throws std::invalid_argument if they are of another type; bool reads as uint8
  template <typename Item>
  std::span<const Item> as() const {
    check_type(npy_type_of<Item>);
    return {reinterpret_cast<const Item*>(bytes_.data()), size()};
  }

  /// The items, converted from whatever they are.
  std::vector<double> to_doubles() const;
  std::vector<float> to_floats() const;

 private:
  void fill(std::span<const std::byte> values);
  void check_type(NpyType asked) const;

  NpyType type_;
  NpyShape shape_;
  std::vector<std::byte> bytes_;
};

/// Reads format versions 1.0 to 3.0 in either byte order; Fortran order is turned into C order.
/// @param file  what errors call it
/// @throws IoError at a byte offset if the header is malformed, the items are objects, records,
///         text or complex, or the data is not exactly as long as the header says
NpyArray parse_npy(std::span<const std::byte> content, std::string_view file);
NpyArray read_npy(const std::filesystem::path& path);

/// Format version 1.0, little endian, C order, byte for byte as NumPy 1.24 writes it.
std::vector<std::byte> serialize_npy(const NpyArray& array);
/// @throws IoError as AtomicFile does
void write_npy(const std::filesystem::path& path, const NpyArray& array, OutputPolicy policy);

/// Reads an NPY file item by item, for recordings larger than memory.
class NpyReader {
 public:
  /// Reads the header and checks that the file is as long as it says.
  /// @throws IoError as read_npy()
  explicit NpyReader(const std::filesystem::path& path);
  ~NpyReader();
  NpyReader(NpyReader&&) noexcept;

  NpyType type() const;
  const NpyShape& shape() const;
  /// True if the first axis is the fastest in the file.
  bool fortran_order() const;

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

/// Most that one of them may hold, unless more is asked for [bytes]: an image of all pixels that
/// are read, in float64.
inline constexpr std::uint64_t max_npz_array_bytes = std::uint64_t{1} << 29;
/// Most that the arrays of one archive may hold together once unpacked [bytes]. A few kilobytes of
/// archive can unpack to any size, so there must be an end.
inline constexpr std::uint64_t max_npz_bytes = std::uint64_t{1} << 34;

/// The arrays of an NPZ archive, stored or deflated, unpacked one by one as they are asked for.
/// @note one reader must not be used by two threads at a time
class NpzReader {
 public:
  /// @throws IoError if this is no ZIP archive, a name comes twice, or the arrays together are
  ///         larger than max_npz_bytes
  explicit NpzReader(const std::filesystem::path& path);
  /// @param content  must outlive the reader
  /// @param file     what errors call it
  NpzReader(std::span<const std::byte> content, std::string_view file);
  ~NpzReader();
  NpzReader(NpzReader&&) noexcept;

  /// Names of the arrays, without the ".npy" they carry inside, in the archive's order.
  const std::vector<std::string>& names() const;
  bool contains(std::string_view name) const;
  /// What an array takes once unpacked, its header included [bytes].
  /// @throws IoError if there is no such array
  std::uint64_t unpacked_bytes(std::string_view name) const;
  /// @throws IoError if there is no such array (says which there are), it is larger than
  /// `max_bytes`
  ///         or damaged, or as parse_npy()
  NpyArray read(std::string_view name, std::uint64_t max_bytes = max_npz_array_bytes) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

using NpzArrays = std::map<std::string, NpyArray>;

/// All arrays of an archive. @throws IoError as NpzReader
NpzArrays parse_npz(std::span<const std::byte> content, std::string_view file);
NpzArrays read_npz(const std::filesystem::path& path);

enum class NpzCompression { stored, deflated };

/// The same arrays give the same bytes on any day.
/// @throws std::invalid_argument if there are no arrays or a name is empty
std::vector<std::byte> serialize_npz(const NpzArrays& arrays,
                                     NpzCompression compression = NpzCompression::stored);
/// @throws IoError as AtomicFile does
void write_npz(const std::filesystem::path& path, const NpzArrays& arrays, OutputPolicy policy,
               NpzCompression compression = NpzCompression::stored);

}  // namespace tofsmith

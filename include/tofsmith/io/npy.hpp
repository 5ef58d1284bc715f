// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
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
  float32,
  float64
};

/// Bytes that one item takes.
std::size_t item_size(NpyType type);
/// NumPy's name of the type, such as "float32" or "bool".
std::string_view name_of(NpyType type);

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

}  // namespace tofsmith

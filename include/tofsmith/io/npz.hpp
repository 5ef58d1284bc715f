// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/io/npy.hpp"

namespace tofsmith {

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
  /// @throws IoError if there is no such array (says which there are), it is damaged, or as
  ///         parse_npy()
  NpyArray read(std::string_view name) const;

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

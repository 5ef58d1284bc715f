// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

namespace tofsmith {

/// A file opened for reading, with errors that name it.
class InputFile {
 public:
  /// @throws IoError if it is missing, a directory or unreadable
  explicit InputFile(const std::filesystem::path& path);
  ~InputFile();
  InputFile(InputFile&& other) noexcept;
  InputFile& operator=(InputFile&&) = delete;

  /// Bytes in it; nothing for a pipe, whose end is not known before it comes.
  std::optional<std::uint64_t> size() const { return size_; }
  /// Reads on from where the last read() ended; returns less than asked for only at the end.
  std::size_t read(std::span<std::byte> into);
  /// Fills `into` from `offset`, wherever read() stands. @throws IoError if the file ends before
  void read_at(std::uint64_t offset, std::span<std::byte> into) const;

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::optional<std::uint64_t> size_;
};

}  // namespace tofsmith

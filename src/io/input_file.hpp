// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

namespace tofsmith {

/// A file opened for reading. Errors contain its name.
class InputFile {
 public:
  /// @throws IoError if it is missing, a directory or unreadable
  explicit InputFile(const std::filesystem::path& path);
  ~InputFile();
  InputFile(InputFile&& other) noexcept;
  InputFile& operator=(InputFile&&) = delete;

  /// Returns none for a pipe.
  std::optional<std::uint64_t> size() const { return size_; }
  /// Returns less than requested only at the end of the file.
  std::size_t read(std::span<std::byte> into);
  /// Independent of read(). @throws IoError if the file is too short
  void read_at(std::uint64_t offset, std::span<std::byte> into) const;

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::optional<std::uint64_t> size_;
};

}  // namespace tofsmith

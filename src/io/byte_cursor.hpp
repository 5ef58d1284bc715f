// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace tofsmith {

/// Reads bytes sequentially. Errors contain the file's name and the byte offset.
class ByteCursor {
 public:
  ByteCursor(std::span<const std::byte> bytes, std::string_view file)
      : bytes_(bytes), file_(file) {}

  std::size_t position() const { return position_; }
  std::span<const std::byte> rest() const { return bytes_.subspan(position_); }
  bool at_end() const { return position_ == bytes_.size(); }

  /// `what` names the bytes in error messages.
  std::span<const std::byte> take(std::size_t count, std::string_view what);
  std::string_view take_text(std::size_t count, std::string_view what);
  /// Returns the text before the next `end`, which is skipped.
  std::string_view take_until(char end, std::string_view what);
  std::uint16_t take_u16_little(std::string_view what);
  std::uint32_t take_u32_little(std::string_view what);

  /// @throws IoError "file: byte N: problem"
  [[noreturn]] void fail(std::string_view problem) const { fail_at(position_, problem); }
  [[noreturn]] void fail_at(std::size_t position, std::string_view problem) const;

 private:
  std::span<const std::byte> bytes_;
  std::string file_;
  std::size_t position_ = 0;
};

}  // namespace tofsmith

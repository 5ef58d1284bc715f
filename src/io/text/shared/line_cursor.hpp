// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tofsmith {

/// Accepts any line endings. Errors contain file and line.
class LineCursor {
 public:
  LineCursor(std::string_view text, std::string_view file) : text_(text), file_(file) {}

  bool at_end() const { return position_ >= text_.size(); }
  /// Returns the next line without surrounding blanks.
  /// @throws IoError at the end of the text
  std::string_view next();
  /// Rejects anything but blank lines.
  void expect_end();
  /// Offset of the first line that was not read.
  std::size_t position() const { return position_; }

  /// @throws IoError "file:line: problem" for the line last returned by next()
  [[noreturn]] void fail(std::string_view problem) const;

 private:
  std::string_view text_;
  std::string file_;
  std::size_t position_ = 0;
  int line_ = 0;
};

struct TextLine {
  std::size_t number;  ///< counted from 1
  std::string_view text;
};

/// Skips empty lines, comments, which begin with '#', and a byte order mark.
std::vector<TextLine> content_lines(std::string_view text);

/// Ignores surrounding blanks.
std::optional<double> finite_number_in(std::string_view text);

}  // namespace tofsmith

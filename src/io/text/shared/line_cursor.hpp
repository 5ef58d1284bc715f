// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tofsmith {

/// Reads the lines of a text with any line endings. Errors contain file and line.
class LineCursor {
 public:
  LineCursor(std::string_view text, std::string_view file) : text_(text), file_(file) {}

  bool at_end() const { return position_ >= text_.size(); }
  /// Returns the next line without its end and surrounding blanks.
  /// @throws IoError at the end of the text
  std::string_view next();
  /// Rejects anything but blank lines at the current position.
  void expect_end();
  /// Returns the offset of the first line that was not read.
  std::size_t position() const { return position_; }

  /// @throws IoError "file:line: problem" for the line last returned by next()
  [[noreturn]] void fail(std::string_view problem) const;

 private:
  std::string_view text_;
  std::string file_;
  std::size_t position_ = 0;
  int line_ = 0;
};

/// A line of a text, without its end.
struct TextLine {
  std::size_t number;  ///< counted from 1
  std::string_view text;
};

/// Returns the lines of a text except empty ones and comments, which begin with '#'. Skips a byte
/// order mark.
std::vector<TextLine> content_lines(std::string_view text);

/// Returns the text without surrounding blanks.
std::string_view trimmed(std::string_view text);

/// Parses a text as a finite number, ignoring surrounding blanks.
std::optional<double> finite_number_in(std::string_view text);

}  // namespace tofsmith

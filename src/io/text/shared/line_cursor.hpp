// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tofsmith {

/// Walks through the lines of a text, whatever ends them; every error names file and line.
class LineCursor {
 public:
  LineCursor(std::string_view text, std::string_view file) : text_(text), file_(file) {}

  bool at_end() const { return position_ >= text_.size(); }
  /// The next line without its end and without blanks around it.
  /// @throws IoError at the end of the text
  std::string_view next();
  /// Nothing but blank lines may follow.
  void expect_end();
  /// The text behind the lines read so far.
  std::size_t position() const { return position_; }

  /// @throws IoError "file:line: problem" about the line that next() gave last
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

/// The lines of a text except empty ones and comments, which begin with '#'. Skips a byte order
/// mark.
std::vector<TextLine> content_lines(std::string_view text);

/// Without blanks around it.
std::string_view trimmed(std::string_view text);

/// The whole text as a finite number, blanks around it left out.
std::optional<double> finite_number_in(std::string_view text);

}  // namespace tofsmith

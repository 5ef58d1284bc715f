// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

namespace tofsmith {

/// A file, configuration or network problem. The message starts with the place
/// (`name:line:column`, `name: byte 128`) and says what was found and what was expected.
class IoError : public std::runtime_error {
 public:
  IoError(std::string_view place, std::string_view problem);
};

/// Work stopped because the caller's progress callback asked for it.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

/// Throws std::invalid_argument "`field` = `value`; `rule`".
[[noreturn]] void reject(std::string_view field, std::string_view value, std::string_view rule);

/// Checks one setting and names field, value and rule when it is broken.
/// @throws std::invalid_argument "`field` = `value`; `rule`" unless `holds`
template <typename Value>
void require(bool holds, std::string_view field, const Value& value, std::string_view rule) {
  if (holds) return;
  std::ostringstream text;
  text << value;
  reject(field, text.str(), rule);
}

/// The entry of `known` closest to `word` in edit distance, or "" when none is near enough to be
/// what the user meant. Of equally close ones, the one with the longer common beginning.
template <typename Range>
std::string nearest_word(std::string_view word, const Range& known);

/// Levenshtein distance between two words, counting a swap of neighbours as one edit.
int edit_distance(std::string_view a, std::string_view b);

namespace detail {
[[noreturn]] void assertion_failed(const char* expression, const char* file, int line,
                                   const std::string& left, const std::string& right);
template <typename Value>
std::string describe(const Value& value) {
  std::ostringstream text;
  text << value;
  return text.str();
}
}  // namespace detail

template <typename Range>
std::string nearest_word(std::string_view word, const Range& known) {
  std::string best;
  const auto common_beginning = [word](std::string_view other) {
    return std::mismatch(word.begin(), word.end(), other.begin(), other.end()).first - word.begin();
  };
  int best_distance = static_cast<int>(word.size()) / 3 + 2;
  for (const auto& candidate : known) {
    const int distance = edit_distance(word, candidate);
    if (distance < best_distance || (distance == best_distance && !best.empty() &&
                                     common_beginning(candidate) > common_beginning(best))) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace tofsmith

/// Our own bug, not the user's: aborts and prints both operands.
#define TOFSMITH_ASSERT_OP(a, op, b)                                                   \
  do {                                                                                 \
    if (!((a)op(b)))                                                                   \
      ::tofsmith::detail::assertion_failed(#a " " #op " " #b, __FILE_NAME__, __LINE__, \
                                           ::tofsmith::detail::describe(a),            \
                                           ::tofsmith::detail::describe(b));           \
  } while (false)
#define TOFSMITH_ASSERT_EQ(a, b) TOFSMITH_ASSERT_OP(a, ==, b)
#define TOFSMITH_ASSERT_LT(a, b) TOFSMITH_ASSERT_OP(a, <, b)
#define TOFSMITH_ASSERT_LE(a, b) TOFSMITH_ASSERT_OP(a, <=, b)

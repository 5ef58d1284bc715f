// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <locale>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

namespace tofsmith {

/// A file, configuration or network error. The message starts with the place, followed by found and
/// expected values.
class IoError : public std::runtime_error {
 public:
  IoError(std::string_view place, std::string_view problem);

  /// File, `name:line:column`, `name: byte 128`, or a setting.
  const std::string& place() const { return place_; }
  /// Message without the place.
  const std::string& problem() const { return problem_; }

 private:
  std::string place_, problem_;
};

/// A violated rule. Queries such as why_not_playable() return it or its text; checks throw it as
/// InvalidArgument.
struct BrokenRule {
  std::string field;  ///< as a user writes it: `sensor.taps`, `DesignOptions::trials`
  std::string value;  ///< found
  std::string rule;

  /// "`field` = `value`; `rule`"
  std::string text() const;
};

/// A bad argument, shape or option. The message is BrokenRule::text().
class InvalidArgument : public std::invalid_argument {
 public:
  explicit InvalidArgument(BrokenRule broken);

  const std::string& field() const { return broken_.field; }
  const std::string& value() const { return broken_.value; }
  const std::string& rule() const { return broken_.rule; }

 private:
  BrokenRule broken_;
};

/// The caller's progress callback cancelled the work.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

namespace detail {
[[noreturn]] void assertion_failed(const char* expression, const char* file, int line,
                                   const std::string& left, const std::string& right);
template <typename Value>
std::string describe(const Value& value) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << value;
  return text.str();
}
}  // namespace detail

/// Throws InvalidArgument.
[[noreturn]] void reject(std::string_view field, std::string_view value, std::string_view rule);

/// Returns a rule that `value` violates.
template <typename Value>
BrokenRule broken(std::string_view field, const Value& value, std::string_view rule) {
  return {std::string(field), detail::describe(value), std::string(rule)};
}

/// @throws InvalidArgument unless `holds`
template <typename Value>
void require(bool holds, std::string_view field, const Value& value, std::string_view rule) {
  if (!holds) reject(field, detail::describe(value), rule);
}

/// @throws InvalidArgument if a rule is violated
void require(const std::optional<BrokenRule>& broken);

std::optional<std::string> text_of(const std::optional<BrokenRule>& broken);

/// Returns the entry of `known` with the smallest edit distance to `word`, or "" if none is
/// similar: more than two edits require the same first letter. Ties are resolved by the longer
/// common prefix.
template <typename Range>
std::string nearest_word(std::string_view word, const Range& known);

/// Levenshtein distance, with a swap of neighbours as one edit.
int edit_distance(std::string_view a, std::string_view b);

template <typename Range>
std::string nearest_word(std::string_view word, const Range& known) {
  std::string best;
  const auto common_beginning = [word](std::string_view other) {
    return std::mismatch(word.begin(), word.end(), other.begin(), other.end()).first - word.begin();
  };
  constexpr int max_edits_of_other_words = 2;
  int best_distance = static_cast<int>(word.size()) / 3 + 2;
  for (const auto& candidate : known) {
    const int distance = edit_distance(word, candidate);
    if (distance > max_edits_of_other_words && common_beginning(candidate) == 0) continue;
    if (distance < best_distance || (distance == best_distance && !best.empty() &&
                                     common_beginning(candidate) > common_beginning(best))) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace tofsmith

/// Aborts and prints both operands if an invariant is violated, which is a bug in tofsmith.
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

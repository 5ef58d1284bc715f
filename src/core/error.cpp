// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <utility>
#include <vector>

namespace tofsmith {

IoError::IoError(std::string_view place, std::string_view problem)
    : std::runtime_error(fmt::format("{}: {}", place, problem)), place_(place), problem_(problem) {}

std::string BrokenRule::text() const { return fmt::format("{} = {}; {}", field, value, rule); }

InvalidArgument::InvalidArgument(BrokenRule broken)
    : std::invalid_argument(broken.text()), broken_(std::move(broken)) {}

void reject(std::string_view field, std::string_view value, std::string_view rule) {
  throw InvalidArgument({std::string(field), std::string(value), std::string(rule)});
}

void require(const std::optional<BrokenRule>& broken) {
  if (broken) throw InvalidArgument(*broken);
}

std::optional<std::string> text_of(const std::optional<BrokenRule>& broken) {
  if (!broken) return std::nullopt;
  return broken->text();
}

int edit_distance(std::string_view a, std::string_view b) {
  // Three rows of the optimal string alignment table; swaps need the oldest.
  std::vector<int> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) above[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int substitution = above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, substitution});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, above);
    std::swap(above, row);
  }
  return above[b.size()];
}

namespace detail {
void assertion_failed(const char* expression, const char* file, int line, const std::string& left,
                      const std::string& right) {
  fmt::print(stderr,
             "{}:{}: assertion failed: {} (left: {}, right: {}). This is a bug in tofsmith.\n",
             file, line, expression, left, right);
  std::abort();
}
}  // namespace detail

}  // namespace tofsmith

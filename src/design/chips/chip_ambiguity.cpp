// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "design/chips/chip_metric.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

/// Direction at one depth without the ambient component; unused entries are 0.
using Direction = std::array<std::int64_t, 16>;

/// Directions at the corners of the correlation functions. For a reference tap r that is not always
/// closed, the null space of the map
///   q_i = kappa_r C_i - C_r kappa_i,  i != r,
/// is the ambient vector kappa. Two depths can have equal measurements exactly if their q have the
/// same direction.
std::vector<Direction> corner_directions(const ChipCode& code) {
  std::vector<std::int64_t> open;
  for (const ChipWord word : code.demodulation) open.push_back(std::popcount(word));
  const auto reference =
      static_cast<int>(std::max_element(open.begin(), open.end()) - open.begin());
  std::vector<Direction> corners(static_cast<std::size_t>(code.chips), Direction{});
  for (int s = 0; s < code.chips; ++s)
    for (int i = 0; i < code.measurements(); ++i)
      corners[static_cast<std::size_t>(s)][static_cast<std::size_t>(i)] =
          open[static_cast<std::size_t>(reference)] * code.correlation(i, s) -
          code.correlation(reference, s) * open[static_cast<std::size_t>(i)];
  return corners;
}

/// Returns the unique relation sum_j x_j columns_j = 0, if any, by fraction-free elimination
/// (Bareiss).
std::optional<std::array<std::int64_t, 4>> only_relation(std::span<const Direction> columns) {
  const std::size_t width = columns.size(), height = Direction().size();
  std::array<Direction, 4> rows{};
  std::array<std::array<std::int64_t, 4>, 4> combination{};
  for (std::size_t j = 0; j < width; ++j) {
    rows[j] = columns[j];
    combination[j][j] = 1;
  }
  std::size_t rank = 0;
  std::int64_t previous = 1;
  for (std::size_t column = 0; column < height && rank < width; ++column) {
    std::size_t pivot = rank;
    while (pivot < width && rows[pivot][column] == 0) ++pivot;
    if (pivot == width) continue;
    std::swap(rows[rank], rows[pivot]);
    std::swap(combination[rank], combination[pivot]);
    const std::int64_t head = rows[rank][column];
    for (std::size_t j = rank + 1; j < width; ++j) {
      const std::int64_t factor = rows[j][column];
      for (std::size_t i = 0; i < height; ++i)
        rows[j][i] = (head * rows[j][i] - factor * rows[rank][i]) / previous;
      for (std::size_t i = 0; i < width; ++i)
        combination[j][i] = (head * combination[j][i] - factor * combination[rank][i]) / previous;
    }
    previous = head;
    ++rank;
  }
  if (rank + 1 != width) return std::nullopt;
  return combination[width - 1];
}

/// Returns true if sum_j x_j columns_j = 0 for some x >= 0, x != 0. Some such x has a support with
/// a unique relation, so testing all supports is sufficient.
bool have_positive_relation(std::span<const Direction> columns) {
  for (unsigned support = 1; support < 1U << columns.size(); ++support) {
    std::array<Direction, 4> chosen{};
    std::size_t count = 0;
    for (std::size_t j = 0; j < columns.size(); ++j)
      if ((support >> j & 1U) != 0) chosen[count++] = columns[j];
    const auto relation = only_relation(std::span(chosen).first(count));
    if (!relation) continue;
    const std::span<const std::int64_t> x(relation->data(), count);
    if (std::all_of(x.begin(), x.end(), [](std::int64_t value) { return value > 0; }) ||
        std::all_of(x.begin(), x.end(), [](std::int64_t value) { return value < 0; }))
      return true;
  }
  return false;
}

Direction negative(Direction vector) {
  for (std::int64_t& value : vector) value = -value;
  return vector;
}

bool stands_still(const Direction& here, const Direction& next) {
  return have_positive_relation(std::array{here, next}) ||
         have_positive_relation(std::array{here, negative(next)});
}

bool turns_back(const Direction& before, const Direction& here, const Direction& next) {
  return have_positive_relation(std::array{before, negative(next), here}) ||
         have_positive_relation(std::array{before, negative(next), negative(here)});
}

}  // namespace

bool is_ambiguous(const ChipCode& code) {
  code.validate();
  require(code.measurements() <= 16, "measurements of ChipCode", code.measurements(),
          "must be <= 16");
  if (std::all_of(code.demodulation.begin(), code.demodulation.end(),
                  [](ChipWord word) { return word == 0; }))
    return true;
  if (code.measurements() < 3) return true;  // at least as many unknowns
  const std::vector<Direction> corners = corner_directions(code);
  const std::size_t n = corners.size();
  const auto corner = [&](std::size_t s) -> const Direction& { return corners[s % n]; };
  for (std::size_t s = 0; s < n; ++s)
    if (stands_still(corner(s), corner(s + 1))) return true;
  for (std::size_t s = 0; s < n; ++s)
    if (turns_back(corner(s), corner(s + 1), corner(s + 2))) return true;
  for (std::size_t s = 0; s < n; ++s)
    for (std::size_t u = s + 2; u < n; ++u) {
      if (u + 1 - s == n) continue;
      if (have_positive_relation(
              std::array{corner(s), corner(s + 1), negative(corner(u)), negative(corner(u + 1))}))
        return true;
    }
  return false;
}

}  // namespace tofsmith

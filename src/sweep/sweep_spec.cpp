// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/sweep/run_sweep.hpp"

#include <algorithm>

namespace tofsmith {

namespace {

/// A digit of an item's index: one axis, or all that are zipped.
struct Digit {
  std::vector<std::size_t> axes;
  std::size_t base;
};

std::vector<Digit> digits_of(const SweepSpec& spec) {
  std::vector<Digit> digits;
  std::ptrdiff_t zipped = -1;
  for (std::size_t i = 0; i < spec.axes.size(); ++i) {
    const SweepAxis& axis = spec.axes[i];
    const bool is_zipped = spec.combine == SweepCombination::zip && !axis.crossed;
    if (is_zipped && zipped >= 0) {
      digits[static_cast<std::size_t>(zipped)].axes.push_back(i);
      continue;
    }
    if (is_zipped) zipped = static_cast<std::ptrdiff_t>(digits.size());
    digits.push_back({{i}, axis.values.size()});
  }
  return digits;
}

}  // namespace

std::int64_t SweepSpec::items() const {
  constexpr std::int64_t most = std::int64_t{1} << 62;
  std::int64_t count = 1;
  for (const Digit& digit : digits_of(*this)) {
    const auto base = static_cast<std::int64_t>(digit.base);
    if (base == 0) return 0;
    count = count > most / base ? most : count * base;
  }
  return count;
}

std::vector<std::size_t> SweepSpec::value_indices(std::int64_t item) const {
  std::vector<std::size_t> indices(axes.size());
  const std::vector<Digit> digits = digits_of(*this);
  for (auto digit = digits.rbegin(); digit != digits.rend(); ++digit) {
    const auto base = static_cast<std::int64_t>(digit->base);
    for (const std::size_t axis : digit->axes)
      indices[axis] = static_cast<std::size_t>(item % base);
    item /= base;
  }
  return indices;
}

}  // namespace tofsmith

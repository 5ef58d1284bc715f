// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/camera/square_light.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "camera/frequency_lists.hpp"
#include "core/shared/text_numbers.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

std::optional<double> common_frequency_hz(std::span<const double> frequencies_hz) {
  // Remainders of Euclid's algorithm multiply the rounding errors of quotients of a clock.
  constexpr double rounding_hz = 0.1;
  double common_hz = 0.0;
  for (double other_hz : frequencies_hz) {
    while (other_hz > rounding_hz) {
      const double remainder_hz = std::abs(std::remainder(common_hz, other_hz));
      common_hz = other_hz;
      other_hz = remainder_hz;
    }
    if (common_hz < common_frequency_resolution_hz) return std::nullopt;
  }
  return common_hz;
}

std::vector<double> SquareLight::modulation_frequencies_hz() const {
  std::vector<double> all_hz = frequencies_hz.value_or(std::vector<double>());
  if (dividers)
    for (const int divider : *dividers) all_hz.push_back(*clock_hz / divider);
  std::sort(all_hz.begin(), all_hz.end());
  return all_hz;
}

namespace {

void validate_duties(const SquareLight& square) {
  if (!square.duties.empty()) require_distinct("light.duty", square.duties);
  if (!square.duty_range) return;
  const auto [low, high] = *square.duty_range;
  require(low < high, "light.duty_range", fmt::format("[{}, {}]", low, high),
          "must be [smallest, largest] with smallest < largest");
  require(square.duties.empty(), "light.duty_range", fmt::format("[{}, {}]", low, high),
          "must not be given together with a list in light.duty");
}

}  // namespace

void SquareLight::validate() const {
  check_ranges(*this, "light.");
  validate_duties(*this);
  require(frequencies_hz || dividers, "light.frequencies_hz", "none",
          "must list the modulation frequencies; or give light.clock_hz and light.dividers");
  if (frequencies_hz) require_distinct("light.frequencies_hz", *frequencies_hz);
  if (dividers) {
    require_distinct("light.dividers", *dividers);
    require(!frequencies_hz, "light.dividers", list_text(*dividers),
            "must not be given together with light.frequencies_hz");
    require(clock_hz.has_value(), "light.dividers", list_text(*dividers),
            "requires light.clock_hz, which they divide");
  }
  const std::vector<double> all_hz = modulation_frequencies_hz();
  if (clock_hz)
    require(all_hz.back() <= *clock_hz, "light.frequencies_hz", all_hz.back(),
            fmt::format("must be at most light.clock_hz = {:.9g}", *clock_hz));
  require(common_frequency_hz(all_hz).has_value(), "light.frequencies_hz", list_text(all_hz),
          fmt::format("must have a common divisor of at least {} Hz; quotients of a clock are "
                      "given exactly by light.clock_hz and light.dividers",
                      common_frequency_resolution_hz));
}

}  // namespace tofsmith

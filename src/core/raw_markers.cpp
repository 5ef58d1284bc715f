// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/raw_markers.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

/// NaN equals NaN.
bool is_same_number(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

bool is_same_list(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), is_same_number);
}

bool names(const std::vector<double>& list, double number) {
  return std::any_of(list.begin(), list.end(),
                     [number](double named) { return is_same_number(named, number); });
}

void validate_markers(const std::vector<double>& list, const std::string& field) {
  constexpr double largest = 9007199254740992.0;  // 2^53
  std::vector<double> before;
  for (const double number : list) {
    require(!std::isfinite(number) || std::abs(number) <= largest, field, number,
            "each must be in [-2^53, 2^53], NaN or infinite");
    require(!names(before, number), field, number, "must be listed once");
    before.push_back(number);
  }
}

}  // namespace

bool RawMarkers::mean_saturated(double number) const { return names(saturated, number); }
bool RawMarkers::mean_invalid(double number) const { return names(invalid, number); }

void RawMarkers::validate() const {
  validate_markers(saturated, "raw.saturated");
  validate_markers(invalid, "raw.invalid");
  for (const double number : invalid)
    require(!mean_saturated(number), "raw.invalid", number, "must not be in raw.saturated as well");
}

bool operator==(const RawMarkers& a, const RawMarkers& b) {
  return is_same_list(a.saturated, b.saturated) && is_same_list(a.invalid, b.invalid);
}

}  // namespace tofsmith

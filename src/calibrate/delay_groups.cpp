// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "calibrate/delay_groups.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tofsmith/core/error.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {
namespace {

constexpr double same = 0.02;  // relative to a step

/// Median step between distinct delays.
double usual_step(std::vector<double> sorted) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (sorted[i] - sorted[i - 1] > 1e-9) steps.push_back(sorted[i] - sorted[i - 1]);
  return steps.empty() ? 0.0 : median_of(std::move(steps));
}

}  // namespace

DelayGroups delay_groups(const std::vector<double>& delay_periods) {
  DelayGroups groups;
  if (delay_periods.empty()) return groups;
  std::vector<double> sorted = delay_periods;
  std::ranges::sort(sorted);
  groups.first_periods = sorted.front();
  groups.span_periods = sorted.back() - sorted.front();
  const double tolerance = same * usual_step(sorted);

  std::vector<std::size_t> order(delay_periods.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  // Positions just below 1 are equivalent to 0.
  const auto place_of = [&](std::size_t i) {
    const double place = wrap(delay_periods[i], 1.0);
    return place > 1.0 - tolerance ? place - 1.0 : place;
  };
  std::ranges::sort(order, {}, place_of);
  groups.group_of_frame.resize(delay_periods.size());
  for (const std::size_t i : order) {
    if (groups.place.empty() || place_of(i) - groups.place.back() > tolerance) {
      groups.place.push_back(place_of(i));
      groups.repeats.push_back(0);
    }
    groups.group_of_frame[i] = groups.count() - 1;
    ++groups.repeats.back();
  }
  for (double& place : groups.place) place = std::max(0.0, place);

  const double step = 1.0 / groups.count();
  double strayed = 0.0;
  for (int g = 0; g < groups.count(); ++g)
    strayed = std::max(
        strayed, std::abs(groups.place[static_cast<std::size_t>(g)] - groups.place[0] - g * step));
  groups.equal_steps = strayed <= same * step;
  groups.from_zero = groups.equal_steps && groups.place[0] <= same * step;
  return groups;
}

void require_whole_period(const DelayGroups& groups) {
  constexpr int min_groups = 8;
  require(groups.count() >= min_groups, "delays", groups.count(),
          fmt::format("must be at least {} different delays within the period", min_groups));
  std::vector<double> gaps;
  for (int g = 0; g < groups.count(); ++g) {
    const auto i = static_cast<std::size_t>(g);
    const double next = g + 1 < groups.count() ? groups.place[i + 1] : 1.0 + groups.place[0];
    gaps.push_back(next - groups.place[i]);
  }
  const double usual = median_of(gaps);
  const auto widest = std::ranges::max_element(gaps) - gaps.begin();
  const double gap = gaps[static_cast<std::size_t>(widest)];
  if (gap <= 2.5 * usual) return;
  const double begin = groups.place[static_cast<std::size_t>(widest)] + usual;
  const double end = groups.place[static_cast<std::size_t>(widest)] + gap - usual;
  require(false, "delays",
          fmt::format("{:.4g} periods long in steps of {:.4g}", groups.span_periods, usual),
          fmt::format("must cover a whole period without a gap: delays from {:.4g} to {:.4g} "
                      "periods are missing, {:.0f} more steps",
                      begin, end, std::max(1.0, std::round(gap / usual) - 1)));
}

}  // namespace tofsmith

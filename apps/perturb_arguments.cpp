// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "perturb_arguments.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>
#include <vector>

#include "session.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith::apps {

namespace {

struct Quantity {
  std::string_view name;
  double RobustnessOptions::*field;
  bool is_time;
};

constexpr std::array quantities = {
    Quantity{"jitter", &RobustnessOptions::edge_jitter_s, true},
    Quantity{"clock", &RobustnessOptions::clock_s, true},
    Quantity{"droop", &RobustnessOptions::droop, false},
    Quantity{"bandwidth", &RobustnessOptions::bandwidth, false},
    Quantity{"peak", &RobustnessOptions::peak, false},
    Quantity{"mismatch", &RobustnessOptions::tap_mismatch, false},
};

/// "50ps", "5 ns", "3%", "0.03" in SI units; NaN for anything else.
double value_of(std::string_view text, bool is_time) {
  using Unit = std::pair<std::string_view, double>;
  constexpr std::array<Unit, 5> times = {
      {{"ps", 1e-12}, {"ns", 1e-9}, {"us", 1e-6}, {"ms", 1e-3}, {"s", 1.0}}};
  constexpr std::array<Unit, 2> shares = {{{"%", 0.01}, {"", 1.0}}};
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc()) return NAN;
  std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
  while (unit.starts_with(' ')) unit.remove_prefix(1);
  const auto scaled = [&](const auto& units) {
    for (const auto& [name, factor] : units)
      if (unit == name) return number * factor;
    return static_cast<double>(NAN);
  };
  return is_time ? scaled(times) : scaled(shares);
}

}  // namespace

RobustnessOptions parse_perturbations(std::string_view text) {
  RobustnessOptions options{
      .bandwidth = 0.0, .peak = 0.0, .edge_jitter_s = 0.0, .tap_mismatch = 0.0, .together = true};
  std::vector<std::string_view> names;
  for (const Quantity& q : quantities) names.push_back(q.name);
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const std::string_view word = text.substr(at, end - at);
    at = end + 1;
    const std::size_t equals = std::min(word.find('='), word.size());
    const std::string_view name = word.substr(0, equals);
    const auto quantity = std::ranges::find(quantities, name, &Quantity::name);
    if (quantity == quantities.end() || equals == word.size()) {
      const std::string near = nearest_word(name, names);
      throw UsageError(
          fmt::format("--perturb: found '{}'; expected {}=VALUE{}", word,
                      near.empty() ? fmt::format("one of {}", fmt::join(names, ", ")) : near,
                      near.empty() ? " such as jitter=50ps,clock=5ns,droop=3%" : ""));
    }
    const double value = value_of(word.substr(equals + 1), quantity->is_time);
    if (!(value > 0.0 && value < 1.0))
      throw UsageError(fmt::format("--perturb {}: found '{}'; expected {}", name,
                                   word.substr(equals + 1),
                                   quantity->is_time ? "a time > 0 with its unit, such as 50ps"
                                                     : "a share in (0, 1), such as 3%"));
    options.*(quantity->field) = value;
  }
  return options;
}

}  // namespace tofsmith::apps

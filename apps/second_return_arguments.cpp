// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "second_return_arguments.hpp"

#include <fmt/format.h>

#include <vector>

#include "number_checks.hpp"

namespace tofsmith::apps {

namespace {

/// One number, or two with a colon between: least and largest.
bool read_limits(const std::string& text, double& least, double& largest) {
  const std::vector<std::string> ends = CLI::detail::split(text, ':');
  return !ends.empty() && ends.size() <= 2 && CLI::detail::lexical_cast(ends.front(), least) &&
         CLI::detail::lexical_cast(ends.back(), largest);
}

}  // namespace

void SecondReturnArguments::add_to(CLI::App& command) {
  CLI::Option* returns =
      command.add_option("--second-returns", returns_,
                         "optimize also for pixels with a second return, decoded as single-path: "
                         "ratio=.1:.5,delta=.5:3 (metres), each uniform between its limits");
  command
      .add_option("--second-return-weight", weight_,
                  "w of E1^(1-w) E2^w, the error without and with second returns, in (0, 1)")
      ->check(number_that("in (0, 1)", [](double w) { return w > 0.0 && w < 1.0; }))
      ->capture_default_str()
      ->needs(returns);
}

std::optional<SecondReturnGoal> SecondReturnArguments::goal(const Camera& camera) const {
  if (returns_.empty()) return std::nullopt;
  SecondReturnGoal goal{.weight = weight_};
  for (const std::string& part : CLI::detail::split(returns_, ',')) {
    const std::size_t equals = part.find('=');
    const std::string key = part.substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : part.substr(equals + 1);
    SecondReturns& its = goal.returns;
    const bool is_read =
        (key == "ratio" && read_limits(value, its.least_ratio, its.largest_ratio)) ||
        (key == "delta" && read_limits(value, its.shortest_delay_m, its.longest_delay_m));
    if (!is_read)
      throw UsageError(
          fmt::format("--second-returns {}: found '{}'; expected ratio=a:b,delta=a:b (metres)",
                      returns_, part));
  }
  goal.validate(camera.range_m());
  return goal;
}

}  // namespace tofsmith::apps

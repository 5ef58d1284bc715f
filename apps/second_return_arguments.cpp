// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "second_return_arguments.hpp"

#include <fmt/format.h>

#include <array>

#include "number_checks.hpp"
#include "number_pair.hpp"

namespace tofsmith::apps {

namespace {

/// One number, or two with a colon between: least and largest. Whether it is either.
bool read_limits(const std::string& text, std::array<double, 2>& limits) {
  if (text.find(':') != std::string::npos) return read_number_pair(text, ':', limits[0], limits[1]);
  if (!CLI::detail::lexical_cast(text, limits[0])) return false;
  limits[1] = limits[0];
  return true;
}

void read_returns(const std::string& text, SecondReturns& returns) {
  for (const std::string& part : CLI::detail::split(text, ',')) {
    const std::size_t equals = part.find('=');
    const std::string key = part.substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : part.substr(equals + 1);
    const bool is_known = key == "ratio" || key == "delta";
    if (!is_known || !read_limits(value, key == "ratio" ? returns.ratio : returns.delay_m))
      throw UsageError(fmt::format(
          "--second-returns {}: found '{}'; expected ratio=a:b,delta=a:b (metres)", text, part));
  }
}

void require_second_returns(const Camera& camera, const char* option) {
  if (!camera.operating.multipath)
    throw UsageError(
        fmt::format("{}: found no second returns; expected --second-returns or a camera with "
                    "[operating.multipath]",
                    option));
}

}  // namespace

void SecondReturnArguments::add_to(CLI::App& command) {
  command.add_option("--second-returns", returns_,
                     "reckon with pixels that have a second return: ratio=.1:.5,delta=.5:3 "
                     "(metres), each uniform between its limits; over [operating.multipath]");
  command
      .add_option("--second-return-weight", weight_,
                  "w of E1^(1-w) E2^w, the errors without and with second returns, in (0, 1)")
      ->check(number_that("in (0, 1)", [](double w) { return w > 0.0 && w < 1.0; }));
  command
      .add_option("--two-return-weight", two_return_weight_,
                  fmt::format("weight of the error decoded as two returns in the search, so that "
                              "codes can be decoded so; 0: none (default: {})",
                              OptimizeOptions{}.two_return_weight))
      ->check(number_from_0_on());
}

void SecondReturnArguments::apply_to(Camera& camera) const {
  std::optional<SecondReturns>& multipath = camera.operating.multipath;
  if (!returns_.empty()) {
    if (!multipath) multipath.emplace();
    read_returns(returns_, *multipath);
    try {
      multipath->validate(camera.range_m());
    } catch (const std::invalid_argument& error) {
      throw UsageError(fmt::format("--second-returns {}: {}", returns_, error.what()));
    }
  }
  if (!weight_) return;
  require_second_returns(camera, "--second-return-weight");
  multipath->weight = *weight_;
}

void SecondReturnArguments::apply_to(OptimizeOptions& options, const Camera& camera) const {
  if (!two_return_weight_) return;
  require_second_returns(camera, "--two-return-weight");
  options.two_return_weight = *two_return_weight_;
}

}  // namespace tofsmith::apps

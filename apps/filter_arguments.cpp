// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "filter_arguments.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "described_options.hpp"
#include "help_pages.hpp"
#include "session.hpp"
#include "tap_arguments.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith::apps {

namespace {

template <typename Options>
std::vector<std::string> keys_of(Options options = {}) {
  std::vector<std::string> names;
  for_each_field(options, [&](const auto& field) { names.emplace_back(field.name); });
  return names;
}

/// Sets the field named by "key=value" in `argument`.
/// @throws UsageError
template <typename Options>
void set_field(const char* argument, const std::string& setting, Options& options) {
  const std::size_t at = setting.find('=');
  if (at == std::string::npos)
    throw UsageError(fmt::format("{}: found {}; expected KEY=VALUE", argument, setting));
  const std::string key = setting.substr(0, at), value = setting.substr(at + 1);
  bool is_known = false;
  for_each_field(options, [&](const auto& field) {
    if (field.name != key) return;
    is_known = true;
    if (!CLI::detail::lexical_cast(value, field.value) ||
        !field.range.contains(static_cast<double>(field.value)))
      throw UsageError(fmt::format(
          "{} {}: found {}; must be {}", argument, key, value,
          field.range.text(std::is_integral_v<std::remove_cvref_t<decltype(field.value)>>)));
  });
  if (is_known) return;
  const std::vector<std::string> keys = keys_of<Options>();
  const std::string near = nearest_word(key, keys);
  throw UsageError(fmt::format("{}: unknown key {}; expected one of {}{}", argument, key,
                               fmt::join(keys, ", "),
                               near.empty() ? "" : "; did you mean " + near + "?"));
}

/// Adds an option that sets fields of Options and requires another option.
template <typename Options>
void add_settings(CLI::App& command, const char* argument, const char* whose, CLI::Option* with,
                  std::vector<std::string>& settings) {
  command
      .add_option(argument, settings,
                  fmt::format("KEY=VALUE of {} (repeatable); keys: {}", whose,
                              fmt::join(keys_of<Options>(), ", ")))
      ->allow_extra_args(false)
      ->needs(with)
      ->group(for_experts);
}

}  // namespace

void FilterArguments::add_to(CLI::App& command) {
  std::vector<std::string> strengths;
  for (const FilterStrength strength : all_filter_strengths)
    strengths.emplace_back(name_of(strength));
  CLI::Option* const filter =
      command
          .add_option("--filter", strength_,
                      "spatial filter, which averages measurements of neighbouring pixels at "
                      "the same depth before decoding: light, normal or strong (default: off)")
          ->check(one_of(strengths));
  add_settings<FilterOptions>(command, "--filter-set", "the spatial filter", filter, settings_);
  CLI::Option* const time_filter =
      command
          .add_option("--time-filter", max_frames_,
                      "temporal filter, which averages each pixel over about this many frames "
                      "while the pixel does not change (default: off)")
          ->check(number_that(">= 1", [](double value) { return value >= 1.0; }));
  add_field_option(command, time_options_, "look_ahead", "--look-ahead")
      ->needs(time_filter)
      ->group(for_experts);
  add_settings<TimeFilterOptions>(command, "--time-filter-set", "the temporal filter", time_filter,
                                  time_settings_);
}

std::optional<FilterOptions> FilterArguments::options() const {
  if (strength_.empty()) return std::nullopt;
  FilterOptions options = FilterOptions::of(parse_filter_strength(strength_));
  for (const std::string& setting : settings_) set_field("--filter-set", setting, options);
  return options;
}

std::optional<TimeFilterOptions> FilterArguments::time_options() const {
  if (max_frames_ == 0) return std::nullopt;
  TimeFilterOptions options = time_options_;
  options.max_frames = max_frames_;
  for (const std::string& setting : time_settings_)
    set_field("--time-filter-set", setting, options);
  return options;
}

}  // namespace tofsmith::apps
